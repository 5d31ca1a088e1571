#pragma once

#include <optional>
#include <span>

#include "core/options.hpp"
#include "formfactor/open_fraction.hpp"
#include "mpi_master/communicator.hpp"
#include "mpi_master/corrections_job.hpp"
#include "mpi_master/distributed_operator.hpp"
#include "mpi_master/visibility_job.hpp"
#include "solver/closure.hpp"
#include "solver/scaled_operator.hpp"
#include "solver/unknowns.hpp"

namespace fluxel {

/// What the matrix is made of.
struct FormFactorParts {
  const RayScene& ray_scene;
  const Scene& scene;
  const ElementMesh& mesh;
  const Visibility& visibility;
  const Unknowns& unknowns;
  std::span<const SideView> views;  ///< an entry an unknown
};

/// What making it has shown; counts are of all ranks.
struct FormFactorFacts {
  CorrectionCounts corrections;
  std::uint64_t correction_bytes = 0;
  DealtTiles corrections_dealt;
  double row_sum_max = 0;          ///< of the form factors as the rules make them
  double closure_defect_rms = 0;   ///< of the same row sums, area-weighted, from 1 - open - dark
  std::size_t capped_rows = 0;     ///< of adaptive: rows above 1, scaled down to it
  std::optional<Closure> closure;  ///< with FormFactorOptions::closure
};

/// The form-factor matrix of all ranks as it is solved: bits and kernel, corrections, then the symmetric
/// scaling that caps row sums (adaptive) or closes them (--closure). Construction and use are collective.
class FormFactorMatrix {
 public:
  /// The parts must outlive this.
  FormFactorMatrix(const Communicator& communicator, const FormFactorParts& parts,
                   const FormFactorOptions& options, int threads, Progress& progress);

  [[nodiscard]] RadiosityOperator& factors();
  [[nodiscard]] const FormFactorFacts& facts() const { return facts_; }
  [[nodiscard]] const GatherCounts& gathered() const { return all_rows_.gathered(); }

 private:
  FormFactorFacts facts_;
  Corrections corrections_;
  RowOperator rows_;
  DistributedOperator all_rows_;
  std::optional<ScaledOperator> scaled_;
};

}  // namespace fluxel
