#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "output/stated_receivers.hpp"

namespace fluxel {

/// What can be said of a value whose error is known: it is certain where what is required is further away
/// than kCertain standard errors.
enum class Verdict { pass, fail, not_decided };
inline constexpr double kCertain = 2;

/// "pass", "fail", or "not decided by the error".
[[nodiscard]] std::string_view verdict_text(Verdict verdict);

/// One requirement of a task.
struct Criterion {
  std::string_view zone;        ///< task area, surrounding, background or observer
  std::string of;               ///< the receiver's name, or the observer's
  std::string_view quantity;    ///< Em [lx], U0 or UGR
  std::optional<Stated> found;  ///< none: there is none, as of the glare of what does not glare
  double required = 0;
  Verdict verdict = Verdict::not_decided;
};

/// A task and what became of it: it fails where one criterion does, and passes where all do.
struct TaskVerdict {
  std::string name;
  std::vector<Criterion> criteria;
  Verdict verdict = Verdict::not_decided;
};

/// A rating of each observer's glare.
struct ObserverRating {
  const ObserverGlare& glare;
  Stated background;  ///< luminance [cd/m2]
  std::optional<GlareRating> rating;
};
[[nodiscard]] std::vector<ObserverRating> observer_ratings(std::span<const ObserverGlare> glare);

/// Judges the scene's tasks by EN 12464-1:2021: the maintained illuminance and its uniformity over the task
/// area; over the immediate surrounding the illuminance of its table 1 (500, 300, 200 lx of tasks of at least
/// 750, 500, 300 lx, else the task's own up to 150 lx) and a uniformity of 0.40; over the background a third
/// of the surrounding's and a uniformity of 0.10; the glare of each of its observers, without maintenance
/// factor. What was not measured, as where a signal has ended the run, is not decided.
[[nodiscard]] std::vector<TaskVerdict> judge_tasks(const Scene& scene,
                                                   std::span<const StatedReceiver> receivers,
                                                   std::span<const ObserverRating> observers,
                                                   double maintenance_factor);

/// Of a run: the ratings of its observers, and its tasks.
[[nodiscard]] std::vector<ObserverRating> observer_ratings(const RunRecord& record);
[[nodiscard]] std::vector<TaskVerdict> task_verdicts(const RunRecord& record);

/// Writes a line a criterion, with whether the run has reached what it was asked for. Throws InputError where
/// it cannot.
void write_task_table(const std::filesystem::path& file, std::span<const TaskVerdict> tasks, bool reached);

[[nodiscard]] Json tasks_json(std::span<const TaskVerdict> tasks);
[[nodiscard]] Json observers_json(std::span<const ObserverRating> observers);

}  // namespace fluxel
