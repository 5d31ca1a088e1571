#include "solver/pair_kernel.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "solver/pair_kernel.cpp"
#include <hwy/foreach_target.h>  // compiles this file once for each instruction set

#include <hwy/highway.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

HWY_BEFORE_NAMESPACE();
namespace fluxel::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using Float = hn::ScalableTag<float>;
using Vec = hn::Vec<Float>;

struct Vec3 {
  Vec x, y, z;
};

HWY_INLINE Vec dot(const Vec3& a, const Vec3& b) {
  return hn::MulAdd(a.x, b.x, hn::MulAdd(a.y, b.y, hn::Mul(a.z, b.z)));
}

/// An element's data, a row's in all lanes or those of a vector of columns.
struct ElementVectors {
  Vec3 centroid, normal, elongation;
  Vec area, spread, constant, least_r2;
};

template <class Load>
HWY_INLINE ElementVectors element_vectors(const PairColumns& columns, const Load& load) {
  return {{load(columns.x), load(columns.y), load(columns.z)},
          {load(columns.normal_x), load(columns.normal_y), load(columns.normal_z)},
          {load(columns.elongation_x), load(columns.elongation_y), load(columns.elongation_z)},
          load(columns.area),
          load(columns.spread),
          load(columns.constant),
          load(columns.least_r2)};
}

/// The pair's F_ij / A_j for one vector of columns.
struct PairVectors {
  Vec factor;
  Vec row_height;     // > 0: the column is in front of the row
  Vec column_height;  // < 0: the row is in front of the column
};

/// As second_order of formfactor/pair_rule, where the symbols are explained. Sums of both elements' terms
/// come first, so that rows and columns may change places to the last bit.
HWY_INLINE Vec second_order(Float d, const ElementVectors& row, const ElementVectors& column,
                            const Vec3& separation, Vec p, Vec q, Vec product, Vec inverse_r2) {
  const Vec along_row = dot(row.elongation, separation);
  const Vec along_column = dot(column.elongation, separation);
  const Vec k = hn::Add(hn::Mul(row.spread, hn::Mul(p, p)), hn::Mul(column.spread, hn::Mul(q, q)));
  const Vec squares = hn::Add(hn::Mul(along_row, along_row), hn::Mul(along_column, along_column));
  const Vec turned = hn::Add(hn::Mul(hn::Mul(p, along_row), dot(row.elongation, column.normal)),
                             hn::Mul(hn::Mul(q, along_column), dot(column.elongation, row.normal)));
  const Vec bracket = hn::MulAdd(hn::Mul(hn::Set(d, 3.0f), inverse_r2), hn::Sub(squares, k),
                                 hn::Add(row.constant, column.constant));
  return hn::MulAdd(product, bracket, hn::MulSub(dot(row.normal, column.normal), k, turned));
}

template <PairRule rule>
HWY_INLINE PairVectors pair_vectors(Float d, const ElementVectors& row, const ElementVectors& column) {
  const Vec3 separation{hn::Sub(column.centroid.x, row.centroid.x),
                        hn::Sub(column.centroid.y, row.centroid.y),
                        hn::Sub(column.centroid.z, row.centroid.z)};
  const Vec distance2 = dot(separation, separation);
  const Vec row_height = dot(row.normal, separation);
  const Vec column_height = dot(column.normal, separation);
  const Vec product = hn::Mul(row_height, column_height);
  if constexpr (rule != PairRule::moments) {
    Vec denominator = hn::Mul(hn::Set(d, std::numbers::pi_v<float>), distance2);
    if constexpr (rule == PairRule::disc) denominator = hn::Add(denominator, hn::Max(row.area, column.area));
    return {hn::Div(hn::Abs(product), hn::Mul(distance2, denominator)), row_height, column_height};
  } else {
    const Vec r2 = hn::Max(distance2, hn::Add(row.least_r2, column.least_r2));
    const Vec inverse_r2 = hn::Div(hn::Set(d, 1.0f), r2);
    const Vec bracket =
        hn::MulAdd(second_order(d, row, column, separation, row_height, column_height, product, inverse_r2),
                   inverse_r2, product);
    const Vec kernel = hn::Xor(bracket, hn::And(product, hn::SignBit(d)));
    const Vec factor = hn::Mul(hn::Mul(hn::Max(kernel, hn::Zero(d)), hn::Mul(inverse_r2, inverse_r2)),
                               hn::Set(d, std::numbers::inv_pi_v<float>));
    return {factor, row_height, column_height};
  }
}

template <PairRule rule, bool two_sided>
RowIrradiance gather(const PairColumns& columns, const ColumnPower& power, std::size_t row,
                     std::size_t first_tile, std::span<const std::uint64_t> words) {
  const Float d;
  const std::size_t lanes = hn::Lanes(d);
  const Vec zero = hn::Zero(d);
  const ElementVectors of_row =
      element_vectors(columns, [d, row](const std::vector<float>& of) { return hn::Set(d, of[row]); });
  Vec front_r = zero, front_g = zero, front_b = zero;
  Vec back_r = zero, back_g = zero, back_b = zero;

  for (std::size_t t = 0; t < words.size(); ++t) {
    if (words[t] == 0) continue;
    for (std::size_t c = 0; c < 64; c += lanes) {
      const std::uint64_t shifted = words[t] >> c;
      const auto sees = hn::LoadMaskBits(d, reinterpret_cast<const std::uint8_t*>(&shifted));
      if (hn::AllFalse(d, sees)) continue;
      const std::size_t j = (first_tile + t) * 64 + c;
      const PairVectors pair =
          pair_vectors<rule>(d, of_row, element_vectors(columns, [d, j](const std::vector<float>& of) {
                               return hn::LoadU(d, of.data() + j);
                             }));
      const Vec factor = hn::IfThenElseZero(sees, pair.factor);
      const auto load_power = [&](std::size_t channel) {
        const Vec of_front = hn::LoadU(d, power.of[0][channel].data() + j);
        if constexpr (!two_sided) return of_front;
        return hn::IfThenElse(hn::Lt(pair.column_height, zero), of_front,
                              hn::LoadU(d, power.of[1][channel].data() + j));
      };
      if constexpr (two_sided) {
        const auto in_front = hn::Gt(pair.row_height, zero);
        const Vec to_front = hn::IfThenElseZero(in_front, factor);
        const Vec to_back = hn::IfThenZeroElse(in_front, factor);
        front_r = hn::MulAdd(to_front, load_power(0), front_r);
        front_g = hn::MulAdd(to_front, load_power(1), front_g);
        front_b = hn::MulAdd(to_front, load_power(2), front_b);
        back_r = hn::MulAdd(to_back, load_power(0), back_r);
        back_g = hn::MulAdd(to_back, load_power(1), back_g);
        back_b = hn::MulAdd(to_back, load_power(2), back_b);
      } else {
        front_r = hn::MulAdd(factor, load_power(0), front_r);
        front_g = hn::MulAdd(factor, load_power(1), front_g);
        front_b = hn::MulAdd(factor, load_power(2), front_b);
      }
    }
  }
  const auto sum = [d](Vec v) { return static_cast<double>(hn::GetLane(hn::SumOfLanes(d, v))); };
  return {Rgb(sum(front_r), sum(front_g), sum(front_b)), Rgb(sum(back_r), sum(back_g), sum(back_b))};
}

template <PairRule rule>
RowIrradiance gather_by(bool two_sided, const PairColumns& columns, const ColumnPower& power, std::size_t row,
                        std::size_t first_tile, std::span<const std::uint64_t> words) {
  return two_sided ? gather<rule, true>(columns, power, row, first_tile, words)
                   : gather<rule, false>(columns, power, row, first_tile, words);
}

RowIrradiance gather_row(PairRule rule, bool two_sided, const PairColumns& columns, const ColumnPower& power,
                         std::size_t row, std::size_t first_tile, std::span<const std::uint64_t> words) {
  switch (rule) {
    case PairRule::point:
      return gather_by<PairRule::point>(two_sided, columns, power, row, first_tile, words);
    case PairRule::disc:
      return gather_by<PairRule::disc>(two_sided, columns, power, row, first_tile, words);
    case PairRule::moments:
      return gather_by<PairRule::moments>(two_sided, columns, power, row, first_tile, words);
  }
  return {};
}

}  // namespace fluxel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

#include "visibility/tile.hpp"

namespace fluxel {

HWY_EXPORT(gather_row);

PairColumns::PairColumns(std::span<const Element> elements) {
  const std::size_t size = tile_count(elements.size()) * kTileSize;
  // Form factors have no unit: lengths are divided by a power of two near the largest coordinate, so that r^4
  // neither overflows nor vanishes in single precision, whatever the scene's size.
  float largest = 0;
  for (const Element& element : elements)
    for (int axis = 0; axis < 3; ++axis) largest = std::max(largest, std::abs(element.centroid[axis]));
  const float scale = largest > 0 ? std::ldexp(1.0f, -std::ilogb(largest)) : 1.0f;
  // Padding stands far away, so that no distance is zero; it has no area and no power.
  for (std::vector<float>* axis : {&x, &y, &z}) axis->assign(size, 1e3f);
  for (std::vector<float>* axis : {&normal_x, &normal_y, &normal_z}) axis->assign(size, 0);
  for (std::vector<float>* nothing :
       {&area, &elongation_x, &elongation_y, &elongation_z, &spread, &constant, &least_r2})
    nothing->assign(size, 0);
  for (std::size_t i = 0; i < elements.size(); ++i) {
    x[i] = elements[i].centroid.x * scale;
    y[i] = elements[i].centroid.y * scale;
    z[i] = elements[i].centroid.z * scale;
    normal_x[i] = elements[i].normal.x;
    normal_y[i] = elements[i].normal.y;
    normal_z[i] = elements[i].normal.z;
    area[i] = elements[i].area * scale * scale;
    const glm::vec3 elongation = 2 * scale * elements[i].elongation;
    elongation_x[i] = elongation.x;
    elongation_y[i] = elongation.y;
    elongation_z[i] = elongation.z;
    spread[i] = 4 * elements[i].spread * scale * scale;
    constant[i] = spread[i] - glm::dot(elongation, elongation) / 2;
    least_r2[i] =
        static_cast<float>(kNearestSquares * flat_shape(elements[i]).moments.trace()) * scale * scale;
  }
}

RowIrradiance gather_row(PairRule rule, bool two_sided, const PairColumns& columns, const ColumnPower& power,
                         std::size_t row, std::size_t first_tile, std::span<const std::uint64_t> words) {
  return HWY_DYNAMIC_DISPATCH(gather_row)(rule, two_sided, columns, power, row, first_tile, words);
}

std::string pair_kernel_target() {
  // The lowest bit set is the best of the supported targets, which is what the dispatch takes.
  const std::int64_t supported = hwy::SupportedTargets() & HWY_TARGETS;
  return hwy::TargetName(supported & -supported);
}

}  // namespace fluxel

#endif  // HWY_ONCE
