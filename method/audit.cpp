#include "method/audit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <numeric>

#include "core/options.hpp"
#include "method/handle_signals.hpp"
#include "metrics/audit_statistics.hpp"
#include "mpi_master/communication/root_clock.hpp"
#include "mpi_master/steps/wave_job.hpp"

namespace fluxel {

namespace {

/// Whose spread tells the errors.
constexpr std::size_t kAuditRandomisations = 16;

/// Of a single interval, and of all together where they contradict.
constexpr double kChance = 0.95;

/// Paths that a wave can tell apart.
constexpr std::uint64_t kMostOfWave = std::uint64_t{1} << 32;

/// A colour that is darker counts as if it had this much of the mean of all.
constexpr double kFaintColour = 0.1;

constexpr std::array kColourNames{"the whole, red", "the whole, green", "the whole, blue"};

double standard_error(const AuditedValue& value) { return std::hypot(value.of_paths, value.of_places); }

/// What is certain of the size of a bias; below 0 where it may be nothing.
double certain_bias(const AuditedMean& mean, double width) {
  return std::abs(mean.bias) - width * mean.error;
}

class Auditor {
 public:
  Auditor(const AuditSubject& subject, const StatedLight& stated, const AuditGoal& goal, AuditPaths& paths)
      : subject_(subject),
        before_(stated),
        stated_(stated.B),
        goal_(goal),
        all_(stated_.size()),
        paths_(paths) {
    // Others would be of other places.
    if (paths_.sums.size() != stated_.size() * kAuditRandomisations) paths_ = {};
    paths_.sums.resize(stated_.size() * kAuditRandomisations);
    std::iota(all_.begin(), all_.end(), 0u);
    found_.places = stated_.size();
    found_.width = interval_width(kChance, 1, kAuditRandomisations);
  }

  Audit run(const Problem& problem, const LightPaths& light) && {
    const RootClock clock(problem.world);
    const double before = paths_.seconds;
    double seconds = 0;  // the root's
    const std::unique_ptr<Sensors> sensors = place_sensors(light, subject_.places);
    if (paths_.of_each > 0) look();
    while (paths_.of_each == 0 || goes_on(seconds)) {
      double_paths(problem, *sensors);
      seconds = clock.seconds();
      paths_.seconds = before + seconds;
      look();
    }
    found_.seconds = before + clock.own_seconds();
    return std::move(found_);
  }

 private:
  /// Twice as many each time.
  void double_paths(const Problem& problem, const Sensors& sensors) {
    AuditPaths all = paths_;
    const std::uint32_t more = std::max(all.of_each, 1U);
    for (std::size_t r = 0; r < kAuditRandomisations; ++r) {
      const MeasuredWave measured = trace_wave(problem.world, sensors, {all.seed++, more}, problem.threads);
      for (std::size_t k = 0; k < stated_.size(); ++k)
        all.sums[k * kAuditRandomisations + r] += static_cast<double>(more) * measured.means[k];
      all.rays += measured.rays;
      handle_signals(problem.world, problem.options, problem.log);
    }
    all.of_each += more;
    // A signal must not leave some randomisations with more paths than others.
    paths_ = std::move(all);
  }

  void look() {
    found_.paths = paths_.of_each * paths_.sums.size();
    found_.rays = paths_.rays;
    scale(paths_.of_each);
    compare(paths_.of_each);
    if (goal_.target > 0) judge();
  }

  /// Whether there are to be as many paths again, after so many seconds of this audit.
  [[nodiscard]] bool goes_on(double seconds) const {
    const bool is_wanted = found_.verdict == AuditVerdict::undecided || (!is_known() && can_tell()) ||
                           (found_.verdict == AuditVerdict::confirmed && pays());
    return 2 * static_cast<double>(found_.rays) <= (is_wanted ? goal_.limit : goal_.rays) &&
           seconds + paths_.seconds <= goal_.seconds &&
           2 * std::uint64_t{paths_.of_each} * stated_.size() <= kMostOfWave;
  }

  /// Differences in a colour, or in the mean of them.
  template <class Colour>
  [[nodiscard]] std::vector<double> differences(std::uint32_t paths, const Colour& colour) const {
    std::vector<double> differences(paths_.sums.size());
    for (std::size_t k = 0; k < paths_.sums.size(); ++k)
      differences[k] = colour(stated_[k / kAuditRandomisations]) - colour(paths_.sums[k]) / paths;
    return differences;
  }

  /// What was measured in the mean.
  template <class Colour>
  [[nodiscard]] double mean(std::span<const std::uint32_t> places, std::uint32_t paths,
                            const Colour& colour) const {
    double sum = 0;
    for (const std::uint32_t place : places)
      for (std::size_t r = 0; r < kAuditRandomisations; ++r)
        sum += colour(paths_.sums[place * kAuditRandomisations + r]);
    return sum / (static_cast<double>(places.size()) * kAuditRandomisations * paths);
  }

  /// Sets the scale of what is taken from the solution, and what is stated with it.
  void scale(std::uint32_t paths) {
    if (before_.of_solution.empty()) return;
    stated_ = before_.B;
    for (int c = 0; c < kChannels; ++c) {
      const auto colour = [c](const Rgb& of) { return of[c]; };
      const AuditedMean bias = mean_of({{}, all_}, differences(paths, colour), 0, 1);
      double of_solution = 0;
      for (const Rgb& light : before_.of_solution) of_solution += light[c];
      of_solution /= static_cast<double>(stated_.size());
      found_.scale[c] = certain_bias(bias, found_.width) > 0 && of_solution > std::abs(bias.bias)
                            ? 1 - bias.bias / of_solution
                            : 1;
    }
    for (std::size_t k = 0; k < stated_.size(); ++k)
      stated_[k] += (found_.scale - 1.0) * before_.of_solution[k];
  }

  void compare(std::uint32_t paths) {
    const auto grey = [](const Rgb& of) { return mean_of_colours(of); };
    const double whole = mean(all_, paths, grey);
    const double least = std::max(kFaintColour * whole, std::numeric_limits<double>::min());
    found_.of_places = {};
    std::optional<KnownError> known;
    for (int c = 0; c < kChannels; ++c) {
      const auto colour = [c](const Rgb& of) { return of[c]; };
      const std::vector<double> off = differences(paths, colour);
      const double own = mean(all_, paths, colour);
      const double over = std::max(own, least);
      found_.whole[static_cast<std::size_t>(c)] =
          mean_of({kColourNames[static_cast<std::size_t>(c)], all_}, off, own, over);
      const AuditedValue square = audited_square({off, kAuditRandomisations});
      const AuditedMean& bias = found_.whole[static_cast<std::size_t>(c)];
      // Of which no more is taken off than there is for certain.
      const double noise = before_.noise[c] * std::min(1.0, found_.scale[c] * found_.scale[c]);
      // The scale that was set by these paths hides what they are off themselves.
      const double hidden = found_.scale[c] != 1 ? bias.error * bias.error : 0;
      const MeasuredSquare measured{(square.value - noise) / (over * over) + hidden,
                                    standard_error(square) / (over * over)};
      const AuditedRms rms = rms_of(square, over);
      known = larger(known, known_error(goal_.expected, measured));
      measured_[static_cast<std::size_t>(c)] = measured;
      found_.of_places = {std::max(found_.of_places.value, rms.value),
                          std::max(found_.of_places.low, rms.low), std::max(found_.of_places.high, rms.high)};
    }
    found_.of_solution = known.value_or(KnownError{});
    found_.known = {std::hypot(found_.of_solution.likely, goal_.noise),
                    std::hypot(found_.of_solution.least, goal_.noise),
                    std::hypot(found_.of_solution.most, goal_.noise)};
    const std::vector<double> off = differences(paths, grey);
    std::vector<double> of_parts;  // relative, of each randomisation
    found_.parts.clear();
    for (const AuditPart& part : subject_.parts) {
      const double own = mean(part.places, paths, grey);
      const double over = std::max({own, goal_.faint * whole, least});
      found_.parts.push_back(mean_of(part, off, own, over));
      for (std::size_t r = 0; r < kAuditRandomisations; ++r) {
        double sum = 0;
        for (const std::uint32_t place : part.places) sum += off[place * kAuditRandomisations + r];
        of_parts.push_back(sum / (over * static_cast<double>(part.places.size())));
      }
    }
    // These are all the parts there are, not some that stand for more.
    AuditedValue square =
        of_parts.empty() ? AuditedValue() : audited_square({of_parts, kAuditRandomisations});
    square.of_places = 0;
    found_.of_parts = rms_of(square, 1);
  }

  [[nodiscard]] AuditedMean mean_of(const AuditPart& part, std::span<const double> off, double mean,
                                    double over) const {
    const AuditedValue bias = audited_bias({off, kAuditRandomisations}, part.places);
    return {part.name, static_cast<double>(part.places.size()) / static_cast<double>(found_.places), mean,
            bias.value / over, standard_error(bias) / over};
  }

  [[nodiscard]] AuditedRms rms_of(const AuditedValue& square, double over) const {
    const double error = found_.width * standard_error(square);
    const auto root = [&](double of) { return std::sqrt(std::max(0.0, of)) / over; };
    return {root(square.value), root(square.value - error), root(square.value + error)};
  }

  /// Whether it is at most the target, or above it, by what noise does not hide; without a target, whether it
  /// is known to a tenth.
  [[nodiscard]] bool is_known() const {
    constexpr double kTenth = 1.1, kClearly = 0.3;
    const KnownError& known = found_.known;
    if (goal_.target == 0) return known.most <= kTenth * known.likely;
    const bool is_decided = known.most <= goal_.target || known.least > goal_.target;
    return is_decided && std::ranges::max_element(measured_, {}, &MeasuredSquare::error)->error <=
                             std::max(goal_.target * goal_.target, kClearly * known.likely * known.likely);
  }

  /// Whether it is not above the target for certain, and paths that take no longer than another round let
  /// expect it to be known to be below, if they find what was found so far.
  [[nodiscard]] bool can_tell() const {
    if (!std::isfinite(goal_.round) || found_.known.most <= goal_.target) return true;
    std::optional<KnownError> then;
    const double now = static_cast<double>(found_.rays);
    for (const MeasuredSquare& of_colour : measured_) {
      const double error = of_colour.error * now / (now + goal_.round);
      then = larger(then, known_error(goal_.expected, MeasuredSquare{of_colour.value, error}));
    }
    return std::hypot(then->most, goal_.noise) <= goal_.target;
  }

  /// Whether as many paths again foreseeably save more than they take.
  [[nodiscard]] bool pays() const {
    if (!goal_.work_left) return false;
    const KnownError& now = found_.of_solution;
    return goal_.work_left(now.most) - goal_.work_left(most_after_as_many_again(now)) >
           static_cast<double>(found_.rays);
  }

  void judge() {
    double high = found_.of_parts.high;
    for (const AuditedMean& mean : found_.whole)
      high = std::max(high, std::abs(mean.bias) + found_.width * mean.error);
    if (!std::isfinite(high + found_.certain()))
      found_.verdict = AuditVerdict::undecided;
    else if (found_.certain() > goal_.target)
      found_.verdict = AuditVerdict::contradicted;
    else
      found_.verdict = high <= goal_.target ? AuditVerdict::confirmed : AuditVerdict::undecided;
  }

  const AuditSubject& subject_;
  const StatedLight& before_;  // it was scaled
  std::vector<Rgb> stated_;
  AuditGoal goal_;
  std::vector<std::uint32_t> all_;
  AuditPaths& paths_;
  std::array<MeasuredSquare, kChannels> measured_;  // of the colours, over the squared mean
  Audit found_;
};

}  // namespace

const AuditedMean& Audit::worst() const {
  const AuditedMean* found = whole.data();
  const auto look_at = [&](const AuditedMean& mean) {
    if (certain_bias(mean, width) > certain_bias(*found, width)) found = &mean;
  };
  std::ranges::for_each(whole, look_at);
  std::ranges::for_each(parts, look_at);
  return *found;
}

double Audit::certain_of_whole() const {
  double certain = -std::numeric_limits<double>::infinity();
  for (const AuditedMean& mean : whole) certain = std::max(certain, certain_bias(mean, width));
  return certain;
}

double Audit::certain() const {
  const double for_all = interval_width(kChance, whole.size() + parts.size() + 1, kAuditRandomisations);
  double certain = of_places.low;
  for (const AuditedMean& mean : whole) certain = std::max(certain, certain_bias(mean, for_all));
  for (const AuditedMean& mean : parts) certain = std::max(certain, certain_bias(mean, for_all));
  return certain;
}

double Audit::likely_bias() const {
  double likely = of_parts.low > 0.5 * of_parts.value ? of_parts.value : 0;
  for (const AuditedMean& mean : whole)
    if (certain_bias(mean, width) > 0)
      likely = std::max(likely, std::sqrt(mean.bias * mean.bias - mean.error * mean.error));
  return likely;
}

double Audit::resolution() const {
  double most = 0;
  for (const AuditedMean& mean : whole) most = std::max(most, width * mean.error);
  return most;
}

double Audit::stated() const { return std::max({known.most, certain(), likely_bias(), resolution()}); }

AuditGoal audit_goal(const Options& options, double work, double target, std::optional<double> expected) {
  // To decide, more may be spent, and a second of a processor on a short run.
  constexpr double kToDecide = 3, kLeastToDecide = 2e6;
  constexpr double kFaintPart = 0.1;
  const double rays = options.audit / (1 - options.audit) * work;
  AuditGoal goal;
  goal.target = target;
  goal.expected = expected;
  goal.faint = error_of(options) == ErrorOf::regions ? kFaintPart : 1;
  goal.rays = rays;
  goal.limit = std::max(kToDecide * rays, kLeastToDecide);
  return goal;
}

Audit audit(const Problem& problem, const AuditSubject& subject, const StatedLight& stated,
            const FinishedLight& solution, const AuditGoal& goal, AuditPaths& paths) {
  const LightPaths light(problem.ray_scene, &solution);
  problem.progress.begin("audit");
  Audit found = Auditor(subject, stated, goal, paths).run(problem, light);
  problem.progress.end();
  return found;
}

std::string audit_sentence(const Audit& found) {
  const auto bias = [&](const AuditedMean& mean) {
    const bool rounding = std::abs(mean.bias) < 1e-12;  // what a scaled solution has left
    return fmt::format("{:+.2g} +- {:.2g} %", rounding ? 0 : 100 * mean.bias, 100 * found.width * mean.error);
  };
  const auto rms = [](const AuditedRms& of) {
    return fmt::format("{:.2g} % ({:.2g} to {:.2g})", 100 * of.value, 100 * of.low, 100 * of.high);
  };
  const AuditedMean& whole =
      *std::ranges::max_element(found.whole, {}, [](const AuditedMean& mean) { return std::abs(mean.bias); });
  const AuditedMean& worst = found.worst();
  return fmt::format(
      "audit: error {}, bias {}{}{}; {:.2g} paths of light, {:.2f} s", rms(found.of_places), bias(whole),
      found.scale == Rgb(1)
          ? ""
          : fmt::format(" after what the solution adds was scaled by {:.4f}, {:.4f}, {:.4f}", found.scale.r,
                        found.scale.g, found.scale.b),
      found.parts.empty()
          ? ""
          : fmt::format(", of parts {}, most in {}: {}", rms(found.of_parts), worst.name, bias(worst)),
      static_cast<double>(found.paths), found.seconds);
}

}  // namespace fluxel
