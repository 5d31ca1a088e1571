#pragma once

#include <fmt/format.h>

#include <cstdio>
#include <span>
#include <string>
#include <utility>

#include "app/report.hpp"
#include "core/element.hpp"
#include "mpi_master/communicator.hpp"
#include "scene/scene.hpp"

namespace fluxel {

/// What a run tells the user on standard output: the root alone, nothing with --quiet.
class Teller {
 public:
  Teller(const Communicator& world, const Options& options)
      : root_(world.is_root()), talks_(root_ && !options.quiet) {}

  template <class... Arguments>
  void say(fmt::format_string<Arguments...> format, Arguments&&... arguments) const {
    if (talks_) fmt::print("{}\n", fmt::format(format, std::forward<Arguments>(arguments)...));
    if (talks_) std::fflush(stdout);
  }
  void warn(RunReport& report, const std::string& sentence) const {
    report.warnings.push_back(sentence);
    if (root_) fmt::print(stderr, "warning: {}\n", sentence);
  }

 private:
  bool root_, talks_;
};

/// What was read: facts go into the report and to the user.
void describe_scene(const Scene& scene, const Teller& teller, RunReport& report);

/// Where the ranks run, with warnings of launches that waste the machine.
void describe_ranks(const Teller& teller, RunReport& report);

/// What has been kept on disk.
void describe_checkpoint(const Teller& teller, const RunReport& report);

/// The GPUs that have failed in a phase: one warning, if there are any.
void warn_of_device_failures(const char* phase, std::span<const DeviceFailure> failures, const Teller& teller,
                             RunReport& report);

/// Corrections, row sums, closure; warns where the closure is not to be trusted.
void describe_form_factors(const Teller& teller, RunReport& report);

/// Names the groups with rows where reflectance times row sum reaches 1.
void warn_of_amplifying_rows(const Scene& scene, const ElementView& mesh, const Teller& teller,
                             RunReport& report);

/// Name of the solver that was used, as the command line takes it; across ranks Gauss-Seidel's method is
/// another.
[[nodiscard]] std::string solver_text(const RunReport& report);

/// Iterations, error and energy of the finished solve; warns where much of the energy is unaccounted for.
void describe_solution(const Scene& scene, const Teller& teller, RunReport& report);

/// The estimated error, or why there is none. On the root.
void describe_estimate(const Teller& teller, const RunReport& report);

/// The picture and the solution, or a warning that they are not written. On the root.
void describe_outputs(bool written, const Teller& teller, RunReport& report);

}  // namespace fluxel
