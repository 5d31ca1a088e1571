#include "bench/simulate/scenarios.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "bench/simulate/pair_work.hpp"
#include "bench/simulate/solve_model.hpp"
#include "bench/simulate/strip_work.hpp"
#include "bench/visibility/csv_file.hpp"
#include "bench/visibility/stopwatch.hpp"
#include "visibility/tile_points.hpp"
#include "visibility/tile_store.hpp"

namespace fluxel::bench {

namespace {

constexpr int kIterations = 10;  // of conjugate gradients in a solve

/// Mean time of the scheduler's decisions where ranks ask in turn [s].
double decision_seconds(const TracedScene& scene, const RowOwners& owners) {
  StripWork work(scene, owners);
  const auto ranks = static_cast<std::size_t>(owners.ranks());
  std::size_t decisions = 1;
  const double seconds = thread_seconds_of([&] {
    while (work.next(static_cast<int>(decisions % ranks))) ++decisions;
  });
  return seconds / static_cast<double>(decisions);
}

double sum(const std::vector<double>& values) {
  double all = 0;
  for (const double value : values) all += value;
  return all;
}

JobResult schedule_strips(const TracedScene& scene, const RowOwners& owners, JobSettings& settings) {
  settings.costs.decision = decision_seconds(scene, owners);
  StripWork work(scene, owners);
  return simulate_job(work, settings);
}

/// Of the rank that has most [bytes].
double largest_store(const TracedScene& scene, const RowOwners& owners) {
  std::size_t largest = 0;
  for (int rank = 0; rank < owners.ranks(); ++rank) {
    const TileRows rows = owners.rows(rank);
    double bytes = 0;
    for (std::size_t row = rows.first; row < rows.last; ++row)
      bytes += scene.costs.bytes[row] / static_cast<double>(rows.size());
    const auto held = static_cast<double>(TileStore::expected_for(owners.tile_rows(), rows));
    largest = std::max(
        largest, TileStore::bytes_for(owners.tile_rows(), rows, static_cast<std::size_t>(held * bytes)));
  }
  return static_cast<double>(largest);
}

/// Rows dealt anew [s], by the rank that holds most: every tile comes into another store, those of rows that
/// it did not own through messages.
double deal_seconds(const TracedScene& scene, const RowOwners& before, const RowOwners& dealt,
                    const JobSettings& settings) {
  const Network& network = settings.network;
  const bool several = dealt.ranks() > network.ranks_per_host;
  const double bandwidth = (several ? network.between_hosts : network.within_host).bytes_per_second;
  const int on_host = std::min(dealt.ranks(), network.ranks_per_host);
  double most = 0;
  for (int rank = 0; rank < dealt.ranks(); ++rank) {
    const TileRows had = before.rows(rank), has = dealt.rows(rank);
    if (has.size() == 0) continue;
    const std::size_t first = std::max(had.first, has.first), last = std::min(had.last, has.last);
    const double moved =
        1 - static_cast<double>(last > first ? last - first : 0) / static_cast<double>(has.size());
    const auto tiles = static_cast<double>(TileStore::expected_for(dealt.tile_rows(), has));
    double bytes = 0;  // of a tile's code
    for (std::size_t row = has.first; row < has.last; ++row)
      bytes += scene.costs.bytes[row] / static_cast<double>(has.size());
    most = std::max(most, tiles * (settings.costs.tile_in + moved * settings.costs.tile_out +
                                   moved * on_host * bytes / bandwidth));
  }
  return most;
}

NumberColumns job_columns(const JobResult& job, double one_rank, const JobSettings& settings) {
  const RankTimes total = job.total();
  const auto ranks = static_cast<double>(job.ranks.size());
  const double all = job.seconds * ranks;
  return {{"visibility_s", job.seconds},
          {"visibility_efficiency", one_rank / (job.seconds * sum(settings.speed))},
          {"idle", total.waiting / all},
          {"messages_share", total.messages / all},
          {"master_messages_share", job.ranks[0].messages / job.seconds},
          {"strips", static_cast<double>(total.strips)},
          {"messages", static_cast<double>(total.messages_sent)},
          {"bytes", total.bytes_sent},
          {"decision_us", 1e6 * settings.costs.decision}};
}

void append(NumberColumns& columns, const NumberColumns& more) {
  columns.insert(columns.end(), more.begin(), more.end());
}

/// Of vector_bytes, what each rank of a host has for itself: points of the tracer and areas.
constexpr double kOwnBytes = sizeof(TilePoints) / static_cast<double>(kTileSize) + 4;

/// What the program does, and without what it does for the solve.
std::vector<Design> designs() { return {{.name = "rows by the forecast", .dealt_anew = false}, {}}; }

/// The scene on one rank, and what it is compared with.
class ScaledScene {
 public:
  ScaledScene(const TracedScene& scene, const MachineFigures& figures, double vector_bytes)
      : scene_(scene), figures_(figures), vector_bytes_(vector_bytes), work_(product_work(scene.map)) {
    JobSettings alone = on_infiniband(figures, 1);
    const RowOwners owner(scene.costs.solve, 1);
    one_rank_ = schedule_strips(scene, owner, alone).seconds;
    one_iteration_ = model_iteration(scene.elements, work_, owner, figures.solve, alone).seconds;
  }

  void run(JobSettings settings, CsvFile& table) const {
    const int ranks = static_cast<int>(settings.speed.size());
    const RowOwners by_forecast(scene_.costs.solve, ranks);
    const JobResult job = schedule_strips(scene_, by_forecast, settings);
    for (const Design& design : designs()) {
      const RowOwners owners = design.dealt_anew ? RowOwners(work_, ranks) : by_forecast;
      const IterationTimes times = model_iteration(scene_.elements, work_, owners, figures_.solve, settings);
      const double dealing =
          design.dealt_anew && ranks > 1 ? deal_seconds(scene_, by_forecast, owners, settings) : 0;
      add_line(settings, design, owners, job, times, dealing, table);
    }
  }

 private:
  /// With an even part of what its host holds once.
  [[nodiscard]] double rank_bytes(const JobSettings& settings, const RowOwners& owners) const {
    const int on_host = std::min(owners.ranks(), settings.network.ranks_per_host);
    const double an_element = kOwnBytes + (vector_bytes_ - kOwnBytes) / on_host;
    return largest_store(scene_, owners) + an_element * static_cast<double>(scene_.elements);
  }

  void add_line(const JobSettings& settings, const Design& design, const RowOwners& owners,
                const JobResult& job, const IterationTimes& times, double dealing, CsvFile& table) const {
    const double speed = sum(settings.speed);
    const double work = one_rank_ + kIterations * one_iteration_;
    NumberColumns columns{{"elements", static_cast<double>(scene_.elements)},
                          {"ranks", static_cast<double>(owners.ranks())}};
    append(columns, job_columns(job, one_rank_, settings));
    append(columns, {{"rows_mean_s", times.rows_mean},
                     {"rows_largest_s", times.rows_largest},
                     {"vectors_s", times.vectors},
                     {"exchange_s", times.exchange},
                     {"sums_s", times.sums},
                     {"iteration_s", times.seconds},
                     {"dealing_s", dealing},
                     {"solve_efficiency", one_iteration_ / (speed * times.seconds)},
                     {"efficiency", work / (speed * (job.seconds + dealing + kIterations * times.seconds))},
                     {"rank_bytes", rank_bytes(settings, owners)}});
    table.add({{"scene", scene_.name}, {"network", settings.network.name}, {"design", design.name}}, columns);
    fmt::print("{}, N {}, np {}, {}, {}: visibility {:.3f}, solve {:.3f}\n", scene_.name, scene_.elements,
               owners.ranks(), settings.network.name, design.name, one_rank_ / (speed * job.seconds),
               one_iteration_ / (speed * times.seconds));
    std::fflush(stdout);
  }

  const TracedScene& scene_;
  const MachineFigures& figures_;
  double vector_bytes_;
  std::vector<double> work_;
  double one_rank_ = 0, one_iteration_ = 0;  // [s]
};

}  // namespace

void run_scaling(const std::vector<TracedScene>& scenes, const MachineFigures& figures,
                 const std::vector<int>& ranks, double vector_bytes, const std::string& csv) {
  CsvFile table(csv);
  for (const TracedScene& scene : scenes) {
    const ScaledScene scaled(scene, figures, vector_bytes);
    for (const int count : ranks) {
      scaled.run(on_infiniband(figures, count), table);
      scaled.run(on_ethernet(figures, count), table);
    }
  }
}

void run_weak_scaling(const std::vector<TracedScene>& scenes, const MachineFigures& figures,
                      double pairs_a_rank, double vector_bytes, const std::string& csv) {
  CsvFile table(csv);
  for (const TracedScene& scene : scenes) {
    const auto elements = static_cast<double>(scene.elements);
    const auto ranks = static_cast<int>(std::lround(0.5 * elements * elements / pairs_a_rank));
    ScaledScene(scene, figures, vector_bytes).run(on_infiniband(figures, std::max(1, ranks)), table);
  }
}

void run_slow_ranks(const std::vector<TracedScene>& scenes, const MachineFigures& figures,
                    const std::vector<int>& ranks, const std::string& csv) {
  CsvFile table(csv);
  for (const TracedScene& scene : scenes) {
    JobSettings alone = on_infiniband(figures, 1);
    const double one_rank = schedule_strips(scene, RowOwners(scene.costs.solve, 1), alone).seconds;
    for (const int count : ranks) {
      const RowOwners owners(scene.costs.solve, count);
      const auto add = [&](const char* speeds, const std::function<double(std::size_t)>& speed) {
        JobSettings settings = on_infiniband(figures, count);
        for (std::size_t rank = 0; rank < settings.speed.size(); ++rank) settings.speed[rank] = speed(rank);
        const JobResult job = schedule_strips(scene, owners, settings);
        NumberColumns columns{{"elements", static_cast<double>(scene.elements)},
                              {"ranks", static_cast<double>(count)}};
        append(columns, job_columns(job, one_rank, settings));
        table.add({{"scene", scene.name}, {"speeds", speeds}}, columns);
      };
      add("equal", [](std::size_t) { return 1.0; });
      add("the last at a fifth",
          [&](std::size_t rank) { return rank + 1 == static_cast<std::size_t>(count) ? 0.2 : 1.0; });
      add("every other at a half", [](std::size_t rank) { return rank % 2 == 1 ? 0.5 : 1.0; });
      add("rank 0 at a half", [](std::size_t rank) { return rank == 0 ? 0.5 : 1.0; });
    }
  }
}

void run_tasks(const std::vector<TracedScene>& scenes, const MachineFigures& figures,
               const std::vector<int>& ranks, const std::string& csv) {
  CsvFile table(csv);
  for (const TracedScene& scene : scenes) {
    JobSettings alone = on_infiniband(figures, 1);
    const double one_rank = schedule_strips(scene, RowOwners(scene.costs.solve, 1), alone).seconds;
    for (const int count : ranks) {
      const RowOwners owners(scene.costs.solve, count);
      JobSettings settings = on_infiniband(figures, count);
      settings.sleeps = false;  // small tasks would wait for nothing else
      const auto add = [&](const char* task, const JobResult& job) {
        NumberColumns columns{{"elements", static_cast<double>(scene.elements)},
                              {"ranks", static_cast<double>(count)}};
        append(columns, job_columns(job, one_rank, settings));
        table.add({{"scene", scene.name}, {"task", task}}, columns);
      };
      add("strip", schedule_strips(scene, owners, settings));
      settings.costs.decision = 0;  // the next of a list
      PairWork pairs(scene, owners);
      add("pair of patches", simulate_job(pairs, settings));
    }
  }
}

void run_prediction(const std::vector<TracedScene>& scenes, const MachineFigures& figures,
                    const std::vector<int>& ranks, int cores, const std::string& csv) {
  CsvFile table(csv);
  for (const TracedScene& scene : scenes) {
    for (const int count : ranks) {
      JobSettings settings = on_this_machine(figures, count, cores);
      const JobResult job = schedule_strips(scene, RowOwners(scene.costs.solve, count), settings);
      const RankTimes total = job.total();
      table.add({{"scene", scene.name}}, {{"elements", static_cast<double>(scene.elements)},
                                          {"ranks", static_cast<double>(count)},
                                          {"visibility_s", job.seconds},
                                          {"cpu_s", settings.speed[0] * total.busy + total.messages},
                                          {"idle", job.idle_share()},
                                          {"bytes", total.bytes_sent},
                                          {"messages", static_cast<double>(total.messages_sent)},
                                          {"strips", static_cast<double>(total.strips)}});
    }
  }
}

}  // namespace fluxel::bench
