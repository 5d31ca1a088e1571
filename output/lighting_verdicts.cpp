#include "output/lighting_verdicts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>

#include "core/file.hpp"
#include "core/options.hpp"
#include "output/csv.hpp"

namespace fluxel {

namespace {

constexpr double kSurroundingU0 = 0.40, kBackgroundU0 = 0.10, kBackgroundShare = 1.0 / 3;

/// Of the immediate surrounding of a task area (EN 12464-1:2021, table 1) [lx].
double surrounding_illuminance(double of_task) {
  if (of_task >= 750) return 500;
  if (of_task >= 500) return 300;
  if (of_task >= 300) return 200;
  return std::min(of_task, 150.0);
}

Verdict judge(const Stated& found, double required, bool at_most) {
  const double above = at_most ? required - found.value : found.value - required;
  if (!(std::abs(above) > kCertain * found.error))
    return above == 0 && found.error == 0 ? Verdict::pass : Verdict::not_decided;
  return above > 0 ? Verdict::pass : Verdict::fail;
}

Verdict of_all(std::span<const Criterion> criteria) {
  const auto any = [&](Verdict verdict) {
    return std::ranges::find(criteria, verdict, &Criterion::verdict) != criteria.end();
  };
  if (any(Verdict::fail)) return Verdict::fail;
  return any(Verdict::not_decided) ? Verdict::not_decided : Verdict::pass;
}

/// The criteria of one task.
class TaskJudge {
 public:
  TaskJudge(std::span<const StatedReceiver> receivers, double maintenance_factor)
      : receivers_(receivers), factor_(maintenance_factor) {}

  void add_zone(std::string_view zone, const std::string& name, double illuminance,
                std::optional<double> U0) {
    const auto of = std::ranges::find(
        receivers_, name, [](const StatedReceiver& one) -> const std::string& { return one.receiver.name; });
    // A signal may have ended the run before.
    const bool is_known = of != receivers_.end();
    const bool is_reached = is_known && of->unreached.empty();
    std::optional<Stated> mean, uniformity;
    if (is_known) mean = Stated{factor_ * of->figures.mean.value, factor_ * of->figures.mean.error};
    if (is_known) uniformity = of->figures.U0.value_or(Stated{});
    add(zone, name, "Em", mean, illuminance, is_reached);
    if (U0) add(zone, name, "U0", uniformity, *U0, is_reached);
  }

  void add_observer(std::span<const ObserverRating> ratings, const std::string& name, double UGR) {
    Criterion criterion{"observer", name, "UGR", {}, UGR, Verdict::not_decided};
    const auto of = std::ranges::find(
        ratings, name, [](const ObserverRating& one) -> const std::string& { return one.glare.observer; });
    if (of != ratings.end() && of->rating) {
      criterion.found = Stated{of->rating->UGR, of->rating->error};
      if (of->glare.reached) criterion.verdict = judge(*criterion.found, UGR, true);
    } else if (of != ratings.end() && !(of->glare.sources.weighted > 0) && of->glare.indirect > 0) {
      criterion.verdict = Verdict::pass;  // nothing glares, and the eye is not inside a body
    }
    criteria_.push_back(std::move(criterion));
  }

  [[nodiscard]] TaskVerdict verdict(const std::string& name) && {
    const Verdict of_task = of_all(criteria_);
    return {name, std::move(criteria_), of_task};
  }

 private:
  void add(std::string_view zone, const std::string& name, std::string_view quantity,
           const std::optional<Stated>& found, double required, bool is_reached) {
    criteria_.push_back({zone, name, quantity, found, required,
                         is_reached ? judge(*found, required, false) : Verdict::not_decided});
  }

  std::span<const StatedReceiver> receivers_;
  double factor_;
  std::vector<Criterion> criteria_;
};

}  // namespace

std::string_view verdict_text(Verdict verdict) {
  switch (verdict) {
    case Verdict::pass:
      return "pass";
    case Verdict::fail:
      return "fail";
    case Verdict::not_decided:
      break;
  }
  return "not decided by the error";
}

std::vector<ObserverRating> observer_ratings(std::span<const ObserverGlare> glare) {
  std::vector<ObserverRating> ratings;
  for (const ObserverGlare& of : glare) {
    const Stated background{of.indirect / std::numbers::pi, of.indirect_error / std::numbers::pi};
    ratings.push_back({of, background, glare_rating(of.sources, background.value, background.error)});
  }
  return ratings;
}

std::vector<TaskVerdict> judge_tasks(const Scene& scene, std::span<const StatedReceiver> receivers,
                                     std::span<const ObserverRating> observers, double maintenance_factor) {
  std::vector<TaskVerdict> verdicts;
  for (const LightingTask& task : scene.tasks) {
    TaskJudge judge(receivers, maintenance_factor);
    const double surrounding = surrounding_illuminance(task.illuminance);
    judge.add_zone("task area", task.area, task.illuminance, task.U0);
    if (!task.surrounding.empty())
      judge.add_zone("surrounding", task.surrounding, surrounding, kSurroundingU0);
    if (!task.background.empty())
      judge.add_zone("background", task.background, kBackgroundShare * surrounding, kBackgroundU0);
    for (const std::string& observer : task.observers) judge.add_observer(observers, observer, *task.UGR);
    verdicts.push_back(std::move(judge).verdict(task.name));
  }
  return verdicts;
}

std::vector<ObserverRating> observer_ratings(const RunRecord& record) {
  return observer_ratings(record.solution.glare);
}

std::vector<TaskVerdict> task_verdicts(const RunRecord& record) {
  return judge_tasks(record.scene, stated_receivers(record), observer_ratings(record),
                     record.options.maintenance_factor);
}

void write_task_table(const std::filesystem::path& file, std::span<const TaskVerdict> tasks, bool reached) {
  std::string text = "task,zone,of,quantity,required,found,error,verdict,reached\n";
  for (const TaskVerdict& task : tasks)
    for (const Criterion& of : task.criteria) {
      const std::string found =
          of.found ? fmt::format("{:.5g},{:.2g}", of.found->value, of.found->error) : std::string(",");
      fmt::format_to(std::back_inserter(text), "{},{},{},{},{:.5g},{},{},{}\n", csv_field(task.name), of.zone,
                     csv_field(of.of), of.quantity, of.required, found, verdict_text(of.verdict), reached);
    }
  write_bytes_atomically(file, text);
}

Json tasks_json(std::span<const TaskVerdict> tasks) {
  Json json = Json::array();
  for (const TaskVerdict& task : tasks) {
    Json criteria = Json::array();
    for (const Criterion& of : task.criteria)
      criteria.push_back({{"zone", of.zone},
                          {"of", of.of},
                          {"quantity", of.quantity},
                          {"required", of.required},
                          {"found", of.found ? stated_json(*of.found) : Json(nullptr)},
                          {"verdict", verdict_text(of.verdict)}});
    json.push_back({{"name", task.name}, {"verdict", verdict_text(task.verdict)}, {"criteria", criteria}});
  }
  return json;
}

Json observers_json(std::span<const ObserverRating> observers) {
  Json json = Json::object();
  for (const ObserverRating& of : observers)
    json[of.glare.observer] = {
        {"ugr", of.rating ? stated_json({of.rating->UGR, of.rating->error}) : Json(nullptr)},
        {"background_luminance", stated_json(of.background)},
        {"indirect_illuminance", stated_json({of.glare.indirect, of.glare.indirect_error})},
        {"solid_angle", number(of.glare.sources.solid_angle)},
        {"largest_solid_angle", number(of.glare.sources.largest)}};
  return json;
}

}  // namespace fluxel
