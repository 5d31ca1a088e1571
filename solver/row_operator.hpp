#pragma once

#include <memory>
#include <span>

#include "core/element.hpp"
#include "formfactor/corrections.hpp"
#include "solver/pair_kernel.hpp"
#include "solver/radiosity_operator.hpp"
#include "visibility/tile_store.hpp"

namespace fluxel {

class RowDevice;

/// The rows of F whose tiles a store holds; form factors are made on the fly from geometry and bits, then
/// what the corrections say is added. A row is summed by one thread, column blocks ascending, so that H has
/// the same bytes for every number of threads and every split of the rows. Pairs take x in the
/// single precision of ColumnPower, corrections in 48 bits. Columns of tiles without any power cost nothing.
/// Vectors have an entry for each unknown of the store's own rows: fronts, then backs.
class RowOperator final : public RadiosityOperator {
 public:
  /// The elements are copied, the store and the corrections must outlive this. `threads` run the rows.
  RowOperator(std::span<const Element> elements, const TileStore& store, const Corrections& corrections,
              const KernelRule& kernel, bool two_sided, int threads);
  /// The same with columns of the elements that are held elsewhere and must outlive this.
  RowOperator(std::span<const Element> elements, PairColumnsView columns, const TileStore& store,
              const Corrections& corrections, const KernelRule& kernel, bool two_sided, int threads);
  ~RowOperator() override;
  RowOperator(RowOperator&&) noexcept;

  /// From the next apply on `exchange`, which must outlive this, holds the power of all columns; without it
  /// the store must own all rows.
  void use(PowerExchange& exchange);

  /// From the next apply on `device`, made of the same elements, store and rule, gathers the rows of products
  /// for as long as it works; corrections are added here, and sweeps stay here. It must outlive this. What it
  /// makes differs from the CPU's rows by the rounding of single precision, and is the same for every split
  /// of the rows. Where it fails in the midst of an apply nothing is lost: the power stands here too, and the
  /// rows that it did not deliver are made on the CPU by the same call (RowDevice).
  void use(RowDevice& device);

  [[nodiscard]] const Ranks& ranks() const override;

  void apply(std::span<const Rgb> x, std::span<Rgb> H) override;
  void apply(std::span<const double> x, std::span<double> H) override;

  /// Across ranks this is block Gauss-Seidel with Jacobi coupling between the blocks: the values depend on
  /// the number of ranks, within the solver's tolerance.
  void sweep(std::span<const Rgb> E, std::span<const Rgb> rho, std::span<Rgb> x) override;
  void sweep(std::span<const double> E, std::span<const double> rho, std::span<double> x) override;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace fluxel
