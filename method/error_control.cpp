#include "method/error_control.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/options.hpp"
#include "method/handle_signals.hpp"
#include "method/hierarchy_audit.hpp"
#include "method/methods.hpp"
#include "method/round_samples.hpp"
#include "method/stopwatch.hpp"
#include "mpi_master/steps/side_view_job.hpp"

namespace fluxel {

namespace {

/// The finest links that single precision is good for.
constexpr double kFinestBlockError = 1e-9;
constexpr std::size_t kMaxRounds = 16;

/// The power of the block error by which the error usually falls.
constexpr double kUsualOrder = 0.4;

/// Of the target: what the first round is for.
constexpr double kFirstError = 4;

/// Row sums of closed scenes are made 1 where what they miss costs more than this of the target.
constexpr double kClosureShare = 0.1;

/// Of the target: a bias of the whole that is certainly larger is not left, as errors of single places are.
constexpr double kBiasShare = 0.25;

/// Of what the noise of rays may be: what is aimed at.
constexpr double kMargin = 0.95;

/// So many rounds more are tried where what is measured does not keep the target.
constexpr std::size_t kMaxContradicted = 3;

/// Whether anything sends on what it receives.
bool reflects(const Problem& problem) {
  return problem.options.thermal || std::ranges::any_of(problem.scene.patches, [&](const Patch& patch) {
           return problem.scene.material(patch).rho != Rgb(0);
         });
}

class ErrorControl {
 public:
  ErrorControl(const Problem& problem, Hierarchy& hierarchy, std::span<const GatherPoint> probes,
               const AuditSubject& subject, const ErrorGoal& goal, const RoundCare& care)
      : problem_(problem),
        options_(problem.options),
        hierarchy_(hierarchy),
        care_(care),
        samples_(hierarchy, probes, problem.options.thermal, care.limit),
        paths_(problem, hierarchy, subject),
        reflects_(reflects(problem)),
        goal_(goal),
        target_(goal.target > 0 ? goal.target : std::sqrt(goal.block_error)) {
    found_.ray_error = first_ray_error();
    found_.tolerance = options_.tolerance.value_or(std::clamp(0.1 * target_, kFinestTolerance, 1e-2));
  }

  ControlledError run() && {
    take_up();
    do {
      while (const std::optional<double> error = next()) work(*error);
      settle_rays();
      keep_time();
      measure();
    } while (goes_on());
    found_.errors.discretisation = found_.rounds.back().discretisation;
    const Rgb bound = hierarchy_.radiosity().mean_square_bound;
    found_.errors.iteration = std::max({bound.r, bound.g, bound.b});
    found_.stated = stated();
    if (goal_.target > 0) found_.reached = reached();
    warn();
    if (audit_ && audit_->scale != Rgb(1)) samples_.scale_reflected(audit_->scale);
    use_rest();
    return {std::move(found_), std::move(audit_), samples_.probed()};
  }

  TriedRounds try_rounds(std::size_t most) && {
    while (found_.rounds.size() < most) {
      const std::optional<double> error = next();
      if (!error) break;
      work(*error);
    }
    settle_rays();
    std::vector<double> block_errors = block_errors_to_come();
    return {std::move(found_), std::move(block_errors)};
  }

 private:
  /// If each round left what its block error lets expect.
  [[nodiscard]] std::vector<double> block_errors_to_come() {
    std::vector<double> errors;
    const std::size_t made = found_.rounds.size();
    while (const std::optional<double> error = wanted_block_error()) {
      HierarchyRound expected = found_.rounds.back();
      if (expected.discretisation)
        *expected.discretisation *= std::pow(*error / expected.block_error, kUsualOrder);
      expected.block_error = *error;
      found_.rounds.push_back(expected);
      errors.push_back(*error);
    }
    found_.rounds.resize(made);
    return errors;
  }

  /// The rounds that an earlier run has finished.
  void take_up() {
    if (!options_.resume) return;
    found_.rounds = care_.folder->restore(hierarchy_, paths_.paths());
    found_.rounds_resumed = found_.rounds.size();
    problem_.log.say(fmt::format("checkpoint: {} rounds of an earlier run", found_.rounds_resumed));
    for (const HierarchyRound& round : found_.rounds)
      care_.limit.add({round.block_error, static_cast<double>(round.links + round.rows), 0,
                       round.refine_seconds + round.solve_seconds},
                      round.refine_seconds);
    if (found_.rounds.empty()) return;
    close_where_closed();
    // The first round's rows are as they are.
    if (found_.rounds.size() > 1) hierarchy_.look_again();
    sample(found_.rounds.size());
  }

  void work(double error) {
    handle_signals(problem_.world, options_, problem_.log);
    const double start = care_.limit.seconds();
    Stopwatch watch;
    HierarchyRound round;
    round.block_error = error;
    problem_.progress.begin("refinement");
    last_is_whole_ = hierarchy_.refine(error, goal_.bytes, problem_.progress);
    if (!last_is_whole_) found_.ended_by = care_.limit.reason();
    problem_.progress.end();
    round.refine_seconds = watch.lap().wall;
    problem_.progress.begin("solve");
    StopRule stop{found_.tolerance, options_.max_iterations};
    stop.against_growth = row_of(options_.method).remedies.against_growth;
    hierarchy_.solve(options_.solver, stop, [this](const IterationState& state) {
      handle_signals(problem_.world, options_, problem_.log);
      problem_.progress.update_error(
          {static_cast<double>(state.iteration), state.error, state.target, ErrorLaw::geometric, 0});
    });
    problem_.progress.end();
    if (found_.rounds.empty()) close_where_closed();
    round.solve_seconds = watch.lap().wall;
    round.links = hierarchy_.links();
    round.rows = hierarchy_.cut().size();
    round.nodes = hierarchy_.tree().size();
    round.leaves = hierarchy_.tree().leaves();
    round.iterations = hierarchy_.radiosity().iterations;
    sample(found_.rounds.size() + 1);
    expect(round);
    found_.rounds.push_back(round);
    show();
    care_.limit.add({error, static_cast<double>(round.links + round.rows),
                     static_cast<double>(hierarchy_.bytes()), care_.limit.seconds() - start},
                    round.refine_seconds);
    // What had to end for want of memory or time may go on where there is more.
    if (!last_is_whole_ || care_.folder == nullptr) return;
    care_.folder->keep(hierarchy_, found_.rounds, paths_.paths());
    if (!options_.checkpoint.empty())
      problem_.log.say(fmt::format("round {}: {}, {} leaves, kept", found_.rounds.size(),
                                   exchange_text(round), round.leaves));
  }

  void show() {
    if (const auto& error = found_.rounds.back().discretisation) problem_.progress.reached(*error);
    if (care_.preview != nullptr)
      care_.preview->show(found_.rounds.size(), target_, found_.rounds.back().discretisation);
  }

  /// Collective.
  void close_where_closed() {
    if (!hierarchy_.by_rays() && lets_no_light_out()) hierarchy_.close_rows(kClosureShare * target_);
  }

  /// Collective: in a mesh without holes, from sides that light reaches every ray ends on another one.
  [[nodiscard]] bool lets_no_light_out() const {
    if (!problem_.scene.statistics.closed) return false;
    const ElementMesh mesh = hierarchy_.tree().elements();
    const SharedArray<SideView> views =
        gather_side_views(problem_.world, problem_.ray_scene, problem_.scene, mesh,
                          count_unknowns(mesh.elements).two_sided, problem_.threads);
    const std::vector<Rgb>& H = hierarchy_.radiosity().H;
    for (std::size_t k = 0; k < H.size(); ++k)
      if (H[k] != Rgb(0) && (views.items()[k].escape > 0 || views.items()[k].dark > 0)) return false;
    return true;
  }

  /// Samples the radiosity of a round, counted from 1.
  void sample(std::size_t round) {
    // Changes become smaller, and what rays make of them has to; where rays take most of the time, what they
    // make of them is measured with rays that are new in each round, and taken off, so that fewer do.
    constexpr double kTakenOff = 2;
    const bool by_rays = hierarchy_.by_rays();
    const double ray_error =
        by_rays ? kTakenOff * first_ray_error() : std::ldexp(first_ray_error(), -static_cast<int>(round) / 2);
    samples_.take(ray_error, by_rays ? 2 * round : 0);
  }

  [[nodiscard]] double first_ray_error() const {
    if (hierarchy_.by_rays()) return hierarchy_.share_of_rays() * target_;
    return (goal_.target > 0 ? 0.5 : 0.3) * target_;
  }

  /// How far the solution has moved, and what that lets expect of the error that is left.
  void expect(HierarchyRound& round) const {
    round.change = samples_.change();
    if (!round.change) return;
    // Of an error that falls by a factor q, always in the same direction, q / (1 - q) of the change is left;
    // errors of links go in all directions, and less is left.
    constexpr double kAlignment = 0.8;
    const double q = std::pow(round.block_error / found_.rounds.back().block_error, kUsualOrder);
    round.discretisation = kAlignment * *round.change * q / (1 - q);
  }

  /// With this error of the rays; none after a single round.
  [[nodiscard]] std::optional<double> expected(double rays) const {
    const std::optional<double> discretisation = found_.rounds.back().discretisation;
    if (!discretisation) return std::nullopt;
    return std::hypot(*discretisation, rays, found_.errors.iteration);
  }

  /// What may be stated: below it the error is with a chance of nine in ten.
  [[nodiscard]] std::optional<double> stated() const {
    if (!reflects_) return 0;
    // Relative to what is all dark no error is a number.
    if (audit_) return std::isfinite(audit_->stated()) ? std::optional(audit_->stated()) : std::nullopt;
    const std::optional<KnownError> known =
        known_error(expected(found_.errors.rays.value_or(0)), std::nullopt);
    return known ? std::optional(known->most) : std::nullopt;
  }

  /// What is expected, but for the rays, has to be at most this for an audit. Of rows of rays it has their
  /// noise and the bias in it, which the audit takes off.
  [[nodiscard]] double worth_measuring() const {
    constexpr double kWorthByLinks = 0.8, kWorthByRays = 1.2;
    return (hierarchy_.by_rays() ? kWorthByRays : kWorthByLinks) * goal_.target;
  }

  [[nodiscard]] bool is_last(double error) const {
    if (!reflects_ || found_.ended_by || found_.rounds.size() == kMaxRounds || error < kFinestBlockError)
      return true;
    if (goal_.target == 0) return error <= goal_.block_error;
    const std::optional<double> left = found_.rounds.back().discretisation;
    if (found_.rounds.size() == contradicted_round_ || !left || is_noisy()) return false;
    if (options_.audit > 0) return *left <= worth_measuring() || rounds_beyond_estimate() > 0;
    return known_error(expected(hierarchy_.share_of_rays() * goal_.target), std::nullopt)->most <=
           goal_.target;
  }

  /// By links: whether pictures of what there is would take many more rays than usual, since leaves are large
  /// for the light on them. Where each of the points has rays to luminaires, another round costs less.
  [[nodiscard]] bool is_noisy() const {
    constexpr std::size_t kMostRounds = 5;
    constexpr double kFiner = 0.5;
    if (problem_.scene.luminaires.empty() || hierarchy_.by_rays() || samples_.probes().empty() ||
        found_.rounds.size() >= kMostRounds)
      return false;
    const std::optional<double> told =
        samples_.ray_error_for(kMargin * hierarchy_.share_of_rays() * goal_.target);
    return told && *told < kFiner * first_ray_error();
  }

  /// Measures the error by paths.
  void measure() {
    if (!reflects_ || !paths_.can_measure()) return;
    const double rays = found_.errors.rays.value_or(0);
    audit_ = paths_.measure({.rounds = found_.rounds,
                             .probes = samples_.probes().size(),
                             .target = goal_.target,
                             .ray_error = found_.ray_error,
                             .noise = rays,
                             .expected = expected(tells_noise() ? 0 : rays),
                             .tells_noise = tells_noise(),
                             .may_go_on = may_go_on(),
                             .points = goal_.points,
                             .seconds = care_.limit.seconds_before_picture(found_.ray_error),
                             .allowed_noise = [this](double others) { return allowed_noise(others); }});
    problem_.log.say(audit_sentence(*audit_));
  }

  /// Whether what is measured may ask for another round.
  [[nodiscard]] bool may_go_on() const {
    return goal_.target > 0 && !found_.ended_by && found_.rounds.size() < kMaxRounds &&
           rounds_beyond_estimate() < kMaxContradicted;
  }

  /// Whether what was measured asks for another round, which then works at what is off.
  [[nodiscard]] bool goes_on() {
    if (!audit_ || !may_go_on()) return false;
    if (audit_->stated() <= goal_.target && audit_->certain_of_whole() <= kBiasShare * goal_.target)
      return false;
    contradicted_round_ = found_.rounds.size();
    if (!next()) return false;
    hierarchy_.scale_reflected(Rgb(1));
    hierarchy_.set_importance_points(paths_.points_of_importance(samples_.probes(), *audit_, goal_.target));
    hierarchy_.look_again();
    return true;
  }

  /// Rounds after the first whose estimate was at the target, in this run or in one that it goes on with.
  [[nodiscard]] std::size_t rounds_beyond_estimate() const {
    const auto met = std::ranges::find_if(found_.rounds, [&](const HierarchyRound& round) {
      return round.discretisation && *round.discretisation <= worth_measuring();
    });
    return met == found_.rounds.end() ? 0 : static_cast<std::size_t>(found_.rounds.end() - met) - 1;
  }

  /// Unset: nothing speaks against it, but what was measured is not enough.
  [[nodiscard]] std::optional<bool> reached() const {
    if (!audit_) return stated() && *stated() <= goal_.target;
    if (audit_->stated() <= goal_.target)
      return audit_->verdict == AuditVerdict::confirmed ? std::optional(true) : std::nullopt;
    if (is_missed()) return false;
    return std::nullopt;
  }

  [[nodiscard]] bool is_missed() const {
    return std::max({audit_->known.least, audit_->certain(), audit_->likely_bias()}) > goal_.target ||
           found_.ended_by;
  }

  void warn() const {
    if (found_.ended_by == RunLimit::memory)
      problem_.log.warn(fmt::format(
          "what nodes exchange light by at a block error of {:.2g} does not fit in {:.3g} MiB a rank: it "
          "is as fine as that allows; give more --memory or ask for less",
          found_.rounds.back().block_error, static_cast<double>(goal_.bytes) / 0x1p20));
    if (found_.reached == true) return;
    if (hurries())
      problem_.log.warn(fmt::format("{} has ended the refinement {} round {}: it is as fine as that allows",
                                    found_.ended_by == RunLimit::signal
                                        ? std::string("a signal")
                                        : fmt::format("--time of {:g} s", *options_.seconds),
                                    last_is_whole_ ? "after" : "within", found_.rounds.size()));
    if (goal_.target == 0) return;
    const std::string stated_text = stated() ? fmt::format("{:.2g} %", 100 * *stated()) : "not known";
    if (found_.reached == false)
      problem_.log.warn(fmt::format("the error stated is {}, {} the target of {:.2g} %", stated_text,
                                    stated() ? "above" : "which does not reach", 100 * goal_.target));
    else
      problem_.log.warn(fmt::format(
          "what was measured is not enough to tell whether the error is below the target of {:.2g} "
          "%: the error stated is {}; give more --audit{}",
          100 * goal_.target, stated_text,
          stated() ? "" : ", or see whether any light reaches what is shown"));
  }

  /// The block error of the next round; none after the last, for which a limit may be the reason.
  [[nodiscard]] std::optional<double> next() {
    const std::optional<double> error = wanted_block_error();
    if (error && !found_.rounds.empty()) found_.ended_by = care_.limit.before_round(*error, found_.ray_error);
    return found_.ended_by ? std::nullopt : error;
  }

  /// Likewise, without limits: as far as the last rounds let expect that it takes.
  [[nodiscard]] std::optional<double> wanted_block_error() const {
    if (found_.rounds.empty())
      return kFirstError * kFirstError * (goal_.target > 0 ? goal_.target * goal_.target : goal_.block_error);
    const double error = found_.rounds.back().block_error;
    if (is_last(error)) return std::nullopt;
    if (goal_.target == 0) return std::max(error / 4, goal_.block_error);
    std::optional<double> found = found_.rounds.back().discretisation;
    if (!found) return error / 4;
    if (found_.rounds.size() == contradicted_round_)
      found = std::max({*found, audit_->known.likely, audit_->certain(), audit_->likely_bias()});
    return next_block_error(error, *found, goal_.target);
  }

  /// Whether a limit of time leaves none for more than what there is.
  [[nodiscard]] bool hurries() const { return found_.ended_by && found_.ended_by != RunLimit::memory; }

  /// Rays that are as good as the rest.
  void settle_rays() {
    if (samples_.probes().empty()) return;
    if (hurries())
      target_ = std::max(target_, found_.rounds.back().discretisation.value_or(kFirstError * target_));
    const double allowed = hierarchy_.share_of_rays() * target_;
    // By links rays are shared among senders, and what one sequence tells of another's error is less.
    const std::optional<double> told =
        hierarchy_.by_rays() ? samples_.ray_error_for(kMargin * allowed) : std::nullopt;
    // Two sequences may agree by chance.
    constexpr double kMost = 4;
    settle_rays(std::min(told.value_or(first_ray_error()), kMost * first_ray_error()), allowed);
  }

  void settle_rays(double ray_error, double allowed) {
    const SettledRays rays =
        samples_.settle(ray_error, goal_.target > 0 ? std::optional(allowed) : std::nullopt);
    found_.ray_error = rays.error;
    if (rays.noise) found_.errors.rays = rays.noise;
  }

  /// Whether the noise of rays is told apart from the rest of the error. In rooms by links what was stated so
  /// was too little in more than one of ten.
  [[nodiscard]] bool tells_noise() const { return hierarchy_.by_rays() && !samples_.probes().empty(); }

  /// Of the rays of a picture, where so much is certain of all other errors.
  [[nodiscard]] double allowed_noise(double others) const {
    constexpr double kMostOfRays = 0.8;
    const double rest = std::sqrt(std::max(0.0, goal_.target * goal_.target - others * others));
    return std::min(kMostOfRays * goal_.target, kMargin * rest);
  }

  /// What the audit leaves of a target is for fewer rays of the picture.
  void use_rest() {
    if (!tells_noise() || found_.reached != true || !audit_ || !found_.errors.rays ||
        !(*found_.errors.rays > 0))
      return;
    const double rays = *found_.errors.rays, others = audit_->of_solution.most;
    const double allowed = allowed_noise(others);
    if (allowed <= rays) return;
    settle_rays(found_.ray_error * allowed / rays, allowed);
    found_.stated = std::max(*found_.stated, std::hypot(others, *found_.errors.rays));
  }

  /// Fewer rays where there is no time for the picture by as many.
  void keep_time() {
    const double affordable = care_.limit.affordable_ray_error(found_.ray_error);
    if (found_.errors.rays) *found_.errors.rays *= affordable / found_.ray_error;
    found_.ray_error = affordable;
  }

  const Problem& problem_;
  const Options& options_;
  Hierarchy& hierarchy_;
  RoundCare care_;
  RoundSamples samples_;
  HierarchyAudit paths_;
  std::optional<Audit> audit_;
  std::size_t contradicted_round_ = 0;  // the number of rounds there were
  bool last_is_whole_ = true;           // the last round
  const bool reflects_;                 // else the radiosity is what is emitted, without an error
  const ErrorGoal& goal_;
  HierarchyStatistics found_;
  double target_;  // or what the block error is for
};

}  // namespace

ControlledError control_error(const Problem& problem, Hierarchy& hierarchy,
                              std::span<const GatherPoint> probes, const AuditSubject& subject,
                              const ErrorGoal& goal, const RoundCare& care) {
  return ErrorControl(problem, hierarchy, probes, subject, goal, care).run();
}

TriedRounds try_rounds(const Problem& problem, Hierarchy& hierarchy, std::span<const GatherPoint> probes,
                       const ErrorGoal& goal, RoundLimit& limit, std::size_t rounds) {
  const AuditSubject nothing;
  return ErrorControl(problem, hierarchy, probes, nothing, goal, {nullptr, limit, nullptr})
      .try_rounds(rounds);
}

}  // namespace fluxel
