#include "bench/simulate/scenarios.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "bench/simulate/pair_work.hpp"
#include "bench/simulate/solve_model.hpp"
#include "bench/simulate/strip_work.hpp"
#include "bench/visibility/csv_file.hpp"
#include "visibility/tile_store.hpp"

namespace fluxel::bench {

namespace {

constexpr int kIterations = 10;  // of conjugate gradients in a solve

/// Mean time of the scheduler's decisions where ranks ask in turn [s].
double decision_seconds(const TracedScene& scene, int ranks) {
  StripWork work(scene, ranks);
  const auto start = std::chrono::steady_clock::now();
  std::size_t decisions = 1;
  while (work.next(static_cast<int>(decisions % static_cast<std::size_t>(ranks)))) ++decisions;
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count() /
         static_cast<double>(decisions);
}

double sum(const std::vector<double>& values) {
  double all = 0;
  for (const double value : values) all += value;
  return all;
}

JobResult deal_strips(const TracedScene& scene, JobSettings& settings) {
  const int ranks = static_cast<int>(settings.speed.size());
  settings.costs.decision = decision_seconds(scene, ranks);
  StripWork work(scene, ranks);
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

}  // namespace

void run_scaling(const std::vector<TracedScene>& scenes, const MachineFacts& facts,
                 const std::vector<int>& ranks, double vector_bytes, const std::string& csv) {
  CsvFile table(csv);
  for (const TracedScene& scene : scenes) {
    JobSettings alone = on_infiniband(facts, 1);
    const double one_rank = deal_strips(scene, alone).seconds;
    const RowOwners one_owner(scene.costs.solve, 1);
    const double one_iteration =
        model_iteration(scene, one_owner, facts.solve, alone, GatherKind::hosts).seconds;
    for (const int count : ranks) {
      const RowOwners owners(scene.costs.solve, count);
      for (JobSettings settings : {on_infiniband(facts, count), on_ethernet(facts, count)}) {
        const JobResult job = deal_strips(scene, settings);
        NumberColumns columns{{"elements", static_cast<double>(scene.elements)},
                              {"ranks", static_cast<double>(count)}};
        append(columns, job_columns(job, one_rank, settings));
        for (const GatherKind kind : {GatherKind::linear, GatherKind::hosts}) {
          const bool linear = kind == GatherKind::linear;
          const IterationTimes times = model_iteration(scene, owners, facts.solve, settings, kind);
          if (linear)
            append(columns, {{"rows_mean_s", times.rows_mean},
                             {"rows_largest_s", times.rows_largest},
                             {"vectors_s", times.vectors}});
          append(columns, {{linear ? "gather_s" : "gather_by_hosts_s", times.gather},
                           {linear ? "iteration_s" : "iteration_by_hosts_s", times.seconds},
                           {linear ? "solve_efficiency" : "solve_efficiency_by_hosts",
                            one_iteration / (count * times.seconds)},
                           {linear ? "efficiency" : "efficiency_by_hosts",
                            (one_rank + kIterations * one_iteration) /
                                (count * (job.seconds + kIterations * times.seconds))}});
        }
        append(columns, {{"rank_bytes", largest_store(scene, owners) +
                                            vector_bytes * static_cast<double>(scene.elements)}});
        table.add({{"scene", scene.name}, {"network", settings.network.name}}, columns);
        fmt::print("{} N {} np {} {}: visibility {:.3f} s, efficiency {:.3f}\n", scene.name, scene.elements,
                   count, settings.network.name, job.seconds, one_rank / (count * job.seconds));
        std::fflush(stdout);
      }
    }
  }
}

void run_tasks(const std::vector<TracedScene>& scenes, const MachineFacts& facts,
               const std::vector<int>& ranks, const std::string& csv) {
  CsvFile table(csv);
  for (const TracedScene& scene : scenes) {
    JobSettings alone = on_infiniband(facts, 1);
    const double one_rank = deal_strips(scene, alone).seconds;
    for (const int count : ranks) {
      JobSettings settings = on_infiniband(facts, count);
      const auto add = [&](const char* task, const JobResult& job) {
        NumberColumns columns{{"elements", static_cast<double>(scene.elements)},
                              {"ranks", static_cast<double>(count)}};
        append(columns, job_columns(job, one_rank, settings));
        table.add({{"scene", scene.name}, {"task", task}}, columns);
      };
      add("strip", deal_strips(scene, settings));
      settings.costs.decision = 0;  // the next of a list
      PairWork pairs(scene, count);
      add("pair of patches", simulate_job(pairs, settings));
    }
  }
}

void run_prediction(const std::vector<TracedScene>& scenes, const MachineFacts& facts,
                    const std::vector<int>& ranks, int cores, const std::string& csv) {
  CsvFile table(csv);
  for (const TracedScene& scene : scenes) {
    for (const int count : ranks) {
      JobSettings settings = on_this_machine(facts, count, cores);
      const JobResult job = deal_strips(scene, settings);
      const RankTimes total = job.total();
      // Messages, too, take the time that cores are shared by.
      const double speed = settings.speed[0];
      table.add({{"scene", scene.name}}, {{"elements", static_cast<double>(scene.elements)},
                                          {"ranks", static_cast<double>(count)},
                                          {"visibility_s", job.seconds},
                                          {"cpu_s", speed * total.busy + total.messages},
                                          {"idle", job.idle_share()},
                                          {"bytes", total.bytes_sent},
                                          {"messages", static_cast<double>(total.messages_sent)},
                                          {"strips", static_cast<double>(total.strips)}});
    }
  }
}

}  // namespace fluxel::bench
