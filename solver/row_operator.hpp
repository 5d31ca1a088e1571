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
/// the same bytes for every number of threads and every split of the rows. Columns of tiles without any power
/// cost nothing. As a RadiosityOperator it serves a store that owns all rows; entries of other rows are left
/// as they are.
class RowOperator final : public RadiosityOperator {
 public:
  /// The elements are copied, the store and the corrections must outlive this. `threads` run the rows.
  RowOperator(std::span<const Element> elements, const TileStore& store, const Corrections& corrections,
              const KernelRule& kernel, bool two_sided, int threads);
  /// The same with columns of the elements that are held elsewhere and must outlive this.
  RowOperator(std::span<const Element> elements, PairColumnsView columns, const TileStore& store,
              const Corrections& corrections, const KernelRule& kernel, bool two_sided, int threads);
  ~RowOperator() override;

  /// From the next start (or apply) on `device`, made of the same elements, store and rule, gathers the rows
  /// of products for as long as it works; corrections are added here, and sweeps stay here. It must outlive
  /// this. What it makes differs from the CPU's rows by the rounding of single precision, and is the same for
  /// every split of the rows. Where it fails in the midst of an apply nothing is lost: x and its power stand
  /// here too, and the rows that it did not deliver are made on the CPU by the same call (RowDevice).
  void use(RowDevice& device);

  void apply(std::span<const Rgb> x, std::span<Rgb> H) override;
  void apply(std::span<const double> x, std::span<double> H) override;

  /// Rows of other stores keep the values they came with: across ranks this is block Gauss-Seidel with Jacobi
  /// coupling between the blocks.
  void sweep(std::span<const Rgb> E, std::span<const Rgb> rho, std::span<Rgb> x) override;
  void sweep(std::span<const double> E, std::span<const double> rho, std::span<double> x) override;

  /// An apply in parts: `start` takes x, whose values must stay as they are until the last part; then
  /// `apply_rows` makes the rows of these tile rows, which must be owned, with apply's bytes.
  void start(std::span<const Rgb> x);
  void start(std::span<const double> x);
  void apply_rows(TileRows rows, std::span<Rgb> H);
  void apply_rows(TileRows rows, std::span<double> H);

  [[nodiscard]] const TileRows& owned() const;

  /// Elements [first, last) whose rows are here.
  [[nodiscard]] std::size_t first_row() const;
  [[nodiscard]] std::size_t last_row() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace fluxel
