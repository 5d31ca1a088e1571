#include "hierarchy/ray_operator.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <numeric>
#include <utility>

#include "core/ids.hpp"
#include "solver/channels.hpp"

namespace fluxel {

RayOperator::RayOperator(const NodeTree& tree, const TreeCut& cut, std::span<const RayRow> rows,
                         const Ranks& ranks, int threads)
    : tree_(tree), cut_(cut), rows_(rows), ranks_(ranks), threads_(threads), first_end_{0}, first_own_{0} {
  for (const RayRow& row : rows_) {
    first_end_.push_back(first_end_.back() + row.ends.size());
    first_own_.push_back(first_own_.back() + (tree_.is_cluster(row.node) ? kCubeSides : 1));
  }
  for (const Material& material : tree_.scene().materials)
    largest_rho_.push_back(largest_channel(material.rho));
  senders_.resize(first_end_.back());
  tbb::task_arena arena(threads_);
  arena.execute([&] {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, rows_.size(), 64), [&](const auto& range) {
      for (std::size_t k = range.begin(); k < range.end(); ++k)
        for (std::size_t j = 0; j < rows_[k].ends.size(); ++j) {
          const NodeId leaf = rows_[k].ends[j].leaf;
          const Patch& patch = tree_.scene().patch(tree_.scene().pieces[tree_[leaf].piece].patch);
          senders_[first_end_[k] + j] = {cut_.row_of(tree_, leaf),
                                         static_cast<std::uint32_t>(index(patch.material)),
                                         glm::vec3(tree_[leaf].shape.normal)};
        }
    });
  });
}

bool RayOperator::is_grey() const {
  return std::ranges::all_of(tree_.scene().materials, [](const Material& material) {
    return material.rho.r == material.rho.g && material.rho.g == material.rho.b;
  });
}

template <class Value>
std::vector<Value> RayOperator::of_all(std::span<const Value> own) const {
  // Ranks one after another, the rows of each in the order of the cut.
  const std::vector<Value> gathered = ranks_.gather(own);
  std::vector<Value> all(cut_.unknowns());
  std::vector<std::size_t> next(ranks_.size + 1);
  const auto of_row = [&](std::size_t row) { return cut_.first()[row + 1] - cut_.first()[row]; };
  for (std::size_t row = 0; row < cut_.nodes().size(); ++row)
    next[cut_.nodes()[row] % ranks_.size + 1] += of_row(row);
  std::partial_sum(next.begin(), next.end(), next.begin());
  for (std::size_t row = 0; row < cut_.nodes().size(); ++row) {
    std::size_t& from = next[cut_.nodes()[row] % ranks_.size];
    std::copy_n(gathered.begin() + static_cast<std::ptrdiff_t>(from), of_row(row),
                all.begin() + cut_.first()[row]);
    from += of_row(row);
  }
  return all;
}

template <class Value, class Function>
std::vector<Value> RayOperator::means(const Function& value) const {
  std::vector<Value> own(first_own_.back(), Value(0));
  tbb::task_arena arena(threads_);
  arena.execute([&] {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, rows_.size(), 64), [&](const auto& range) {
      for (std::size_t k = range.begin(); k < range.end(); ++k) {
        const RayRow& row = rows_[k];
        const std::span of_row = std::span(own).subspan(first_own_[k], first_own_[k + 1] - first_own_[k]);
        for (std::size_t j = 0; j < row.ends.size(); ++j) {
          const RayEnd& end = row.ends[j];
          const Value of_end = value(first_end_[k] + j, end);
          if (of_row.size() == 1) {
            of_row[0] += of_end;
            continue;
          }
          const glm::dvec3& normal = tree_[end.from].shape.normal;
          const CubeParts parts = cube_parts(normal);
          for (std::size_t axis = 0; axis < parts.size(); ++axis)
            of_row[cube_side(axis, normal)] += parts[axis] * of_end;
        }
        for (std::size_t side = 0; side < of_row.size(); ++side)
          if (row.weight(side) > 0) of_row[side] /= row.weight(side);
      }
    });
  });
  return of_all(std::span<const Value>(own));
}

template <class Value>
void RayOperator::apply_to(std::span<const Value> x, std::span<Value> H) const {
  const std::vector<Value> found = means<Value>([&](std::size_t number, const RayEnd&) {
    const Sender& sender = senders_[number];
    const Value there = cut_.part(sender.row, glm::dvec3(sender.normal), x);
    if constexpr (kChannelsOf<Value> == 1)
      return largest_rho_[sender.material] * there;
    else
      return tree_.scene().materials[sender.material].rho * there;
  });
  std::ranges::copy(found, H.begin());
}

void RayOperator::apply(std::span<const Rgb> x, std::span<Rgb> H) { apply_to(x, H); }
void RayOperator::apply(std::span<const double> x, std::span<double> H) { apply_to(x, H); }

/// A whole product: there are no rows that could go before others without being asked for one by one.
template <class Value>
void RayOperator::sweep_over(std::span<const Value> E, std::span<const Value> rho, std::span<Value> x) const {
  std::vector<Value> H(x.size());
  apply_to(std::span<const Value>(x), std::span(H));
  for (std::size_t k = 0; k < x.size(); ++k) x[k] = E[k] + rho[k] * H[k];
}

void RayOperator::sweep(std::span<const Rgb> E, std::span<const Rgb> rho, std::span<Rgb> x) {
  sweep_over(E, rho, x);
}
void RayOperator::sweep(std::span<const double> E, std::span<const double> rho, std::span<double> x) {
  sweep_over(E, rho, x);
}

Unknowns RayOperator::system() const {
  std::vector<Rgb> emitted;
  std::vector<double> areas;
  for (const RayRow& row : rows_) {
    const std::size_t sides = tree_.is_cluster(row.node) ? kCubeSides : 1;
    double weights = 0;
    for (std::size_t side = 0; side < sides; ++side) weights += row.weight(side);
    for (std::size_t side = 0; side < sides; ++side) {
      emitted.push_back(row.emitted[side]);
      areas.push_back(weights > 0 ? tree_[row.node].shape.area * row.weight(side) / weights : 0);
    }
  }
  Unknowns unknowns;
  unknowns.E = of_all(std::span<const Rgb>(emitted));
  unknowns.area = of_all(std::span<const double>(areas));
  unknowns.elements = unknowns.active = unknowns.E.size();
  unknowns.rho.assign(unknowns.E.size(), Rgb(1));
  return unknowns;
}

std::vector<Rgb> RayOperator::reflected(const std::function<double(NodeId)>& sent) const {
  return means<Rgb>([&](std::size_t number, const RayEnd& end) {
    return tree_.scene().materials[senders_[number].material].rho * sent(end.leaf);
  });
}

std::vector<double> RayOperator::row_sums() const {
  return means<double>([](std::size_t, const RayEnd&) { return 1.0; });
}

}  // namespace fluxel
