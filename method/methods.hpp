#pragma once

#include <algorithm>
#include <array>
#include <map>
#include <span>
#include <string>
#include <string_view>

#include "core/choices.hpp"
#include "core/options.hpp"
#include "method/problem.hpp"
#include "method/solution.hpp"

namespace fluxel {

// A method answers what light there is at the sensors of a problem. All are collective, and throw AgreedError
// where memory does not suffice, StopRequest where a signal has ended them.

/// All pairs of elements: one bit of visibility a pair, form factors on the fly (the source papers' method).
[[nodiscard]] Solution solve_matrix(const Problem& problem);
/// What solve_matrix would take: elements, pairs, memory and time.
[[nodiscard]] Solution forecast_matrix(const Problem& problem);
/// After the picture and the solution are written: solves two coarser meshes and estimates how far the
/// solution is from the true radiosity; into the root's solution, and said. A signal ends the estimate alone.
void estimate_matrix_error(const Problem& problem, Solution& solution);

/// Links between nodes of a hierarchy, refined until the error asked for is expected.
[[nodiscard]] Solution solve_hierarchical(const Problem& problem);
/// Its first rounds, and what the others would take: links, memory and time.
[[nodiscard]] Solution forecast_hierarchical(const Problem& problem);

/// Paths of light from the sensors to the emitters: unbiased, with standard errors.
[[nodiscard]] Solution trace_paths(const Problem& problem);

/// Photons from the emitters, which count where they come to: halves of them tell how exactly.
[[nodiscard]] Solution solve_by_photons(const Problem& problem);

/// The light of an earlier run's elements (ProblemHooks::finished), seen from where the problem asks:
/// gathered by rays for pictures and receivers, and audited.
[[nodiscard]] Solution view_solution(const Problem& problem);

/// A value that a method does not take of an option that it knows.
struct RefusedValue {
  std::string_view option;  ///< one that has a value wherever it is in force
  std::string_view value;
  std::string_view sentence;  ///< what to do instead
};

/// What the user may do where a method's form factors are not what they should be: options that it knows.
struct Remedies {
  std::string_view against_defect;  ///< of the energy balance
  std::string_view against_growth;  ///< of an iteration that row sums amplify
};

/// What is known of a method before it runs.
struct MethodRow {
  Method method;
  std::string_view name;
  std::string_view command;   ///< that calls it, with --method where there are several
  std::string_view sentence;  ///< what it does
  /// Options of the command, beside those that all of its methods know.
  std::span<const std::string_view> options;
  std::span<const RefusedValue> refused;
  Subdivision subdivision;      ///< where none is asked for
  bool has_tolerance_of_share;  ///< knows --tolerance auto:SHARE
  Remedies remedies;
  Solution (*solve)(const Problem&);
  Solution (*forecast)(const Problem&);               ///< null: it makes none
  void (*estimate_error)(const Problem&, Solution&);  ///< null: its solutions say so themselves

  [[nodiscard]] constexpr bool knows(std::string_view option) const {
    return std::ranges::find(options, option) != options.end();
  }
  [[nodiscard]] constexpr bool refuses(std::string_view option, std::string_view value) const {
    return std::ranges::any_of(
        refused, [&](const RefusedValue& one) { return one.option == option && one.value == value; });
  }
};

inline constexpr std::array<std::string_view, 20> kHierarchicalOptions{
    "preview",   "exchange",       "picture",    "target-error", "error-of", "block-error", "audit",
    "oracle",    "memory",         "time",       "subdivision",  "max-edge", "subscenes",   "solver",
    "tolerance", "max-iterations", "checkpoint", "resume",       "dry-run",  "keep-links"};
inline constexpr std::array<std::string_view, 26> kMatrixOptions{"subdivision",
                                                                 "picture",
                                                                 "max-edge",
                                                                 "subscenes",
                                                                 "form-factor",
                                                                 "form-factor-tolerance",
                                                                 "closure",
                                                                 "solver",
                                                                 "tolerance",
                                                                 "max-iterations",
                                                                 "no-partial-visibility",
                                                                 "preview",
                                                                 "warm-start",
                                                                 "no-error-estimate",
                                                                 "audit",
                                                                 "error-of",
                                                                 "checkpoint",
                                                                 "checkpoint-every",
                                                                 "resume",
                                                                 "visibility-only",
                                                                 "reuse-visibility",
                                                                 "device",
                                                                 "verify-device",
                                                                 "trace-every-pair",
                                                                 "timeline",
                                                                 "dry-run"};

inline constexpr std::array<std::string_view, 6> kViewOptions{"solution", "picture", "target-error",
                                                              "audit",    "device",  "verify-device"};

inline constexpr std::array kRefusedByHierarchical{
    RefusedValue{"solver", "gauss-seidel",
                 "--method hierarchical knows no --solver gauss-seidel; use --method matrix for it"}};
inline constexpr std::array kRefusedByMatrix{
    RefusedValue{"subdivision", "transport",
                 "--subdivision transport takes the elements that --method hierarchical has made"}};

inline constexpr Remedies kHierarchicalRemedies{
    "ask for a smaller error (--target-error, --block-error), with enough --memory",
    "ask for a smaller error (--target-error, --block-error), with enough --memory, or use lower "
    "reflectances"};
inline constexpr Remedies kMatrixRemedies{
    "use a smaller --max-edge or --closure",
    "use --form-factor adaptive or --closure, smaller elements (--max-edge) or lower reflectances"};

/// One row a method: a new one is a function and a row.
inline constexpr std::array kMethods{
    MethodRow{Method::hierarchical, "hierarchical", "solve",
              "links between parts of the scene, as coarse as the target error allows", kHierarchicalOptions,
              kRefusedByHierarchical, Subdivision::transport, false, kHierarchicalRemedies,
              solve_hierarchical, forecast_hierarchical, nullptr},
    MethodRow{Method::matrix, "matrix", "solve",
              "all pairs of elements: a bit of visibility a pair, form factors on the fly", kMatrixOptions,
              kRefusedByMatrix, Subdivision::camera, true, kMatrixRemedies, solve_matrix, forecast_matrix,
              estimate_matrix_error},
    MethodRow{Method::paths,
              "paths",
              "reference",
              "paths of light: the truth within a standard error, to judge solutions by",
              std::span<const std::string_view>{},
              std::span<const RefusedValue>{},
              Subdivision::transport,
              false,
              {},
              trace_paths,
              nullptr,
              nullptr},
    MethodRow{Method::view,
              "view",
              "view",
              "light of an earlier run, gathered where it is looked at",
              kViewOptions,
              std::span<const RefusedValue>{},
              Subdivision::transport,
              false,
              {},
              view_solution,
              nullptr,
              nullptr},
    MethodRow{Method::photons,
              "photons",
              "photons",
              "photons from the emitters: mirrors and glass too, with an error by two halves of them",
              std::span<const std::string_view>{},
              std::span<const RefusedValue>{},
              Subdivision::none,
              false,
              {},
              solve_by_photons,
              nullptr,
              nullptr}};

static_assert(std::ranges::all_of(kMethods,
                                  [](const MethodRow& row) {
                                    return row.knows("dry-run") == (row.forecast != nullptr);
                                  }),
              "a method that can be asked for a forecast makes one");

[[nodiscard]] constexpr const MethodRow& row_of(Method method) {
  return *std::ranges::find(kMethods, method, &MethodRow::method);
}

/// The first method that knows an option, which is_own_option has to be.
[[nodiscard]] constexpr Method method_knowing(std::string_view option) {
  return std::ranges::find_if(kMethods, [&](const MethodRow& row) { return row.knows(option); })->method;
}

/// The methods of a command, as its --method names them.
[[nodiscard]] inline std::map<std::string, Method> methods_of(std::string_view command) {
  std::map<std::string, Method> methods;
  for (const MethodRow& row : kMethods)
    if (row.command == command) methods.emplace(row.name, row.method);
  return methods;
}

/// Whether an option belongs to methods that know it alone.
[[nodiscard]] constexpr bool is_own_option(std::string_view option) {
  return std::ranges::any_of(kMethods, [&](const MethodRow& row) { return row.knows(option); });
}

}  // namespace fluxel
