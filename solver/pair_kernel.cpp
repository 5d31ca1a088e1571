#include "solver/pair_kernel.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "solver/pair_kernel.cpp"
#include <hwy/foreach_target.h>  // compiles this file once for each instruction set

#include <hwy/highway.h>

#include <algorithm>
#include <cmath>
#include <numbers>

HWY_BEFORE_NAMESPACE();
namespace fluxel::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using Float = hn::ScalableTag<float>;
using Vec = hn::Vec<Float>;

/// The pair's F_ij / A_j for one vector of columns; `towards_*` tell the sides by their signs.
struct PairVectors {
  Vec factor;       // |c_i c_j| / (pi r^2 [+ max(A_i, A_j)])
  Vec towards_row;  // > 0: the column is in front of the row
  Vec towards_column;
};

template <FormFactor rule>
HWY_INLINE PairVectors pair_vectors(Float d, const PairColumns& columns, std::size_t row, std::size_t j) {
  const auto load = [d, j](const std::vector<float>& of) { return hn::LoadU(d, of.data() + j); };
  const auto splat = [d, row](const std::vector<float>& of) { return hn::Set(d, of[row]); };
  const Vec dx = hn::Sub(load(columns.x), splat(columns.x));
  const Vec dy = hn::Sub(load(columns.y), splat(columns.y));
  const Vec dz = hn::Sub(load(columns.z), splat(columns.z));
  const Vec r2 = hn::MulAdd(dx, dx, hn::MulAdd(dy, dy, hn::Mul(dz, dz)));
  const Vec row_height =
      hn::MulAdd(splat(columns.normal_x), dx,
                 hn::MulAdd(splat(columns.normal_y), dy, hn::Mul(splat(columns.normal_z), dz)));
  const Vec column_height =
      hn::Neg(hn::MulAdd(load(columns.normal_x), dx,
                         hn::MulAdd(load(columns.normal_y), dy, hn::Mul(load(columns.normal_z), dz))));
  Vec denominator = hn::Mul(hn::Set(d, std::numbers::pi_v<float>), r2);
  if constexpr (rule == FormFactor::disc)
    denominator = hn::Add(denominator, hn::Max(load(columns.area), splat(columns.area)));
  const Vec factor = hn::Div(hn::Abs(hn::Mul(row_height, column_height)), hn::Mul(r2, denominator));
  return {factor, row_height, column_height};
}

template <FormFactor rule, bool two_sided>
RowIrradiance gather(const PairColumns& columns, const ColumnPower& power, std::size_t row,
                     std::size_t first_tile, std::span<const std::uint64_t> words) {
  const Float d;
  const std::size_t lanes = hn::Lanes(d);
  const Vec zero = hn::Zero(d);
  Vec front_r = zero, front_g = zero, front_b = zero;
  Vec back_r = zero, back_g = zero, back_b = zero;

  for (std::size_t t = 0; t < words.size(); ++t) {
    if (words[t] == 0) continue;
    for (std::size_t c = 0; c < 64; c += lanes) {
      const std::uint64_t shifted = words[t] >> c;
      const auto sees = hn::LoadMaskBits(d, reinterpret_cast<const std::uint8_t*>(&shifted));
      if (hn::AllFalse(d, sees)) continue;
      const std::size_t j = (first_tile + t) * 64 + c;
      const PairVectors pair = pair_vectors<rule>(d, columns, row, j);
      const Vec factor = hn::IfThenElseZero(sees, pair.factor);
      const auto load_power = [&](std::size_t channel) {
        const Vec of_front = hn::LoadU(d, power.of[0][channel].data() + j);
        if constexpr (!two_sided) return of_front;
        return hn::IfThenElse(hn::Gt(pair.towards_column, zero), of_front,
                              hn::LoadU(d, power.of[1][channel].data() + j));
      };
      if constexpr (two_sided) {
        const auto in_front = hn::Gt(pair.towards_row, zero);
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

RowIrradiance gather_row(FormFactor rule, bool two_sided, const PairColumns& columns,
                         const ColumnPower& power, std::size_t row, std::size_t first_tile,
                         std::span<const std::uint64_t> words) {
  if (rule == FormFactor::disc)
    return two_sided ? gather<FormFactor::disc, true>(columns, power, row, first_tile, words)
                     : gather<FormFactor::disc, false>(columns, power, row, first_tile, words);
  return two_sided ? gather<FormFactor::point, true>(columns, power, row, first_tile, words)
                   : gather<FormFactor::point, false>(columns, power, row, first_tile, words);
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
  area.assign(size, 0);
  for (std::size_t i = 0; i < elements.size(); ++i) {
    x[i] = elements[i].centroid.x * scale;
    y[i] = elements[i].centroid.y * scale;
    z[i] = elements[i].centroid.z * scale;
    normal_x[i] = elements[i].normal.x;
    normal_y[i] = elements[i].normal.y;
    normal_z[i] = elements[i].normal.z;
    area[i] = elements[i].area * scale * scale;
  }
}

RowIrradiance gather_row(FormFactor rule, bool two_sided, const PairColumns& columns,
                         const ColumnPower& power, std::size_t row, std::size_t first_tile,
                         std::span<const std::uint64_t> words) {
  return HWY_DYNAMIC_DISPATCH(gather_row)(rule, two_sided, columns, power, row, first_tile, words);
}

std::string pair_kernel_target() {
  // The lowest bit set is the best of the supported targets, which is what the dispatch takes.
  const std::int64_t supported = hwy::SupportedTargets() & HWY_TARGETS;
  return hwy::TargetName(supported & -supported);
}

}  // namespace fluxel

#endif  // HWY_ONCE
