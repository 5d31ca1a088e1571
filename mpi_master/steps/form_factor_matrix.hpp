#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/choices.hpp"
#include "formfactor/escape_fraction.hpp"
#include "mpi_master/communication/shared_columns.hpp"
#include "mpi_master/steps/corrections_job.hpp"
#include "mpi_master/steps/host_power.hpp"
#include "mpi_master/steps/rank_device.hpp"
#include "mpi_master/steps/visibility_job.hpp"
#include "solver/closure.hpp"
#include "solver/row_device.hpp"
#include "solver/row_operator.hpp"
#include "solver/scaled_operator.hpp"
#include "solver/unknowns.hpp"

namespace fluxel {

/// About what the radiosity and the irradiance of all unknowns are [W/m2]; may be none.
struct AboutLight {
  std::span<const Rgb> B, H;

  [[nodiscard]] bool known() const { return !B.empty() && !H.empty(); }
};

/// What the matrix is made of.
struct FormFactorParts {
  const RayScene& ray_scene;
  const Scene& scene;
  ElementView mesh;
  const Visibility& visibility;
  bool two_sided;
  const Unknowns& unknowns;         ///< of this rank's rows
  std::span<const SideView> views;  ///< likewise, an entry an unknown
  Device device = Device::cpu;      ///< else GPUs make the products of ranks that have one
  AboutLight light = {};            ///< what pairs are worth follows from it, where it is known
};

/// What making it has shown, of all ranks but for the scale of the closure.
struct FormFactorStatistics {
  CorrectionCounts corrections;
  std::uint64_t correction_bytes = 0;
  ScheduleRecord corrections_schedule;
  double row_sum_max = 0;                  ///< of the form factors as the rules make them
  double closure_defect_rms = 0;           ///< of the same row sums, area-weighted, from 1 - escape - dark
  std::size_t capped_rows = 0;             ///< of adaptive: rows above 1, scaled down to it
  std::optional<Closure> closure;          ///< with FormFactorOptions::closure
  int gpu_ranks = 0;                       ///< whose products a GPU makes
  std::vector<DeviceFailure> without_gpu;  ///< ranks that have none, where GPUs were wanted
};

/// The form-factor matrix of all ranks as it is solved: bits and kernel, corrections, then the symmetric
/// scaling that caps row sums (adaptive) or closes them (--closure). Construction is collective. A GPU that
/// cannot hold a rank's rows, or fails, leaves them to the processor.
class FormFactorMatrix {
 public:
  /// The parts must outlive this.
  FormFactorMatrix(const Workers& workers, const FormFactorParts& parts, const FormFactorOptions& options);

  /// For all ranks together.
  [[nodiscard]] RadiosityOperator& factors();
  [[nodiscard]] const FormFactorStatistics& statistics() const { return statistics_; }
  [[nodiscard]] const GatherCounts& gathered() const { return power_.gathered(); }
  /// Collective: the GPUs that have been given up since, on all ranks.
  [[nodiscard]] std::vector<DeviceFailure> device_failures(const Communicator& communicator) const {
    return device_failures_of_all(communicator, device_failure_);
  }

 private:
  void scale(const FormFactorParts& parts, const FormFactorOptions& options);

  FormFactorStatistics statistics_;
  SharedColumns columns_;
  HostPower power_;
  std::string device_failure_;         // why this rank's was given up
  std::unique_ptr<RowDevice> device_;  // null: none
  Corrections corrections_;
  RowOperator rows_;
  std::optional<ScaledOperator> scaled_;
};

}  // namespace fluxel
