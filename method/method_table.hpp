#pragma once

#include <algorithm>
#include <array>
#include <span>
#include <string_view>

#include "core/options.hpp"
#include "method/methods.hpp"

namespace fluxel {

/// What is known of a method before it runs.
struct MethodRow {
  Method method;
  std::string_view name;
  std::string_view command;   ///< that calls it, with --method where there are several
  std::string_view sentence;  ///< what it does
  /// Options of the command, beside those that all of its methods know.
  std::span<const std::string_view> options;
  Solution (*solve)(const Problem&);
  Solution (*forecast)(const Problem&);               ///< null: it makes none
  void (*estimate_error)(const Problem&, Solution&);  ///< null: its solutions say so themselves

  [[nodiscard]] constexpr bool knows(std::string_view option) const {
    return std::ranges::find(options, option) != options.end();
  }
};

inline constexpr std::array<std::string_view, 12> kHierarchicalOptions{
    "target-error", "block-error", "oracle",    "memory",         "subdivision", "max-edge",
    "subscenes",    "solver",      "tolerance", "max-iterations", "checkpoint",  "resume"};
inline constexpr std::array<std::string_view, 23> kMatrixOptions{"subdivision",
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

/// One row a method: a new one is a function and a row.
inline constexpr std::array kMethods{
    MethodRow{Method::hierarchical, "hierarchical", "solve",
              "links between parts of the scene, as coarse as the target error allows", kHierarchicalOptions,
              solve_hierarchical, nullptr, nullptr},
    MethodRow{Method::matrix, "matrix", "solve",
              "all pairs of elements: a bit of visibility a pair, form factors on the fly", kMatrixOptions,
              solve_matrix, forecast_matrix, estimate_matrix_error},
    MethodRow{Method::paths, "paths", "reference",
              "paths of light: the truth within a standard error, to judge solutions by",
              std::span<const std::string_view>{}, trace_paths, nullptr, nullptr}};

[[nodiscard]] constexpr const MethodRow& row_of(Method method) {
  return *std::ranges::find(kMethods, method, &MethodRow::method);
}

/// Whether an option belongs to methods that know it alone.
[[nodiscard]] constexpr bool is_own_option(std::string_view option) {
  return std::ranges::any_of(kMethods, [&](const MethodRow& row) { return row.knows(option); });
}

}  // namespace fluxel
