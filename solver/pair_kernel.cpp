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
using Mask = hn::Mask<Float>;

struct Vec3 {
  Vec x, y, z;
};

HWY_INLINE Vec dot(const Vec3& a, const Vec3& b) {
  return hn::MulAdd(a.x, b.x, hn::MulAdd(a.y, b.y, hn::Mul(a.z, b.z)));
}

/// An element's data, a row's in all lanes or those of a vector of columns. What a rule does not use is never
/// loaded.
struct ElementVectors {
  Vec3 centroid, normal, elongation;
  Vec disc, variance4, constant, least_r2;
};

template <class Load>
HWY_INLINE ElementVectors element_vectors(const TileColumns& tile, const Load& load) {
  return {{load(tile.x), load(tile.y), load(tile.z)},
          {load(tile.normal_x), load(tile.normal_y), load(tile.normal_z)},
          {load(tile.elongation_x), load(tile.elongation_y), load(tile.elongation_z)},
          load(tile.disc),
          load(tile.variance4),
          load(tile.constant),
          load(tile.least_r2)};
}

/// A pair as the centroids see it: the way from row to column, its square, and the heights over both planes.
struct PairVectors {
  Vec3 separation;
  Vec distance2;
  Vec row_height;     // > 0: the column is in front of the row
  Vec column_height;  // < 0: the row is in front of the column
};

HWY_INLINE PairVectors pair_vectors(const ElementVectors& row, const ElementVectors& column) {
  const Vec3 separation{hn::Sub(column.centroid.x, row.centroid.x),
                        hn::Sub(column.centroid.y, row.centroid.y),
                        hn::Sub(column.centroid.z, row.centroid.z)};
  return {separation, dot(separation, separation), dot(row.normal, separation),
          dot(column.normal, separation)};
}

/// pi F_ij / A_j by the moments, as formfactor/pair_rule. With w = 3 / r^2, q for the height over the other
/// plane and h = n_i . n_j - w p q, an element's part of the second-order term there is
///   p (s p h - a (b - w q a)),   s = 4 m,
/// and what is left is p q c. Every step treats rows and columns alike, so that they may change places to the
/// last bit. Counted as fused, a pair costs 46 multiplications for three channels with those that add up.
HWY_INLINE Vec moments_factor(const ElementVectors& row, const ElementVectors& column,
                              const PairVectors& pair) {
  const Float d;
  const Vec p = pair.row_height, q = pair.column_height;
  const Vec product = hn::Mul(p, q);
  const Vec r2 = hn::Max(pair.distance2, hn::Add(row.least_r2, column.least_r2));
  const Vec inverse_r2 = hn::Div(hn::Set(d, 1.0f), r2);
  const Vec w = hn::Mul(hn::Set(d, 3.0f), inverse_r2);
  const Vec h = hn::NegMulAdd(w, product, dot(row.normal, column.normal));
  const auto part = [&](const ElementVectors& of, const ElementVectors& other, Vec height, Vec other_height) {
    const Vec along = dot(of.elongation, pair.separation);
    const Vec turned = hn::NegMulAdd(hn::Mul(w, other_height), along, dot(of.elongation, other.normal));
    return hn::Mul(height, hn::NegMulAdd(along, turned, hn::Mul(hn::Mul(of.variance4, height), h)));
  };
  const Vec second_order = hn::MulAdd(product, hn::Add(row.constant, column.constant),
                                      hn::Add(part(row, column, p, q), part(column, row, q, p)));
  const Vec bracket = hn::MulAdd(second_order, inverse_r2, product);
  const Vec kernel = hn::Xor(bracket, hn::And(product, hn::SignBit(d)));
  return hn::Mul(hn::Max(kernel, hn::Zero(d)), hn::Mul(inverse_r2, inverse_r2));
}

/// pi F_ij / A_j for a vector of columns. Divisions are exact ones: an approximate reciprocal and a Newton
/// step took longer where this was measured (Zen 4), and its digits differ between makers of processors.
template <PairRule rule>
HWY_INLINE Vec pair_factor(const ElementVectors& row, const ElementVectors& column, const PairVectors& pair) {
  if constexpr (rule == PairRule::moments) {
    return moments_factor(row, column, pair);
  } else {
    const Vec heights = hn::Abs(hn::Mul(pair.row_height, pair.column_height));
    Vec bounded = pair.distance2;
    if constexpr (rule == PairRule::disc) bounded = hn::Add(bounded, hn::Max(row.disc, column.disc));
    return hn::Div(heights, hn::Mul(pair.distance2, bounded));
  }
}

/// Sums of one side.
template <std::size_t channels>
struct SideSums {
  std::array<Vec, channels> of;

  HWY_INLINE void add(Vec factor, const std::array<Vec, channels>& power) {
    for (std::size_t c = 0; c < channels; ++c) of[c] = hn::MulAdd(factor, power[c], of[c]);
  }
};

/// Sums of a row's front and, in two-sided scenes, back.
template <std::size_t channels>
struct RowSums {
  SideSums<channels> front, back;
};

/// Adds what the columns of one word send. `all`: the word has all its bits, which need not be looked at.
template <PairRule rule, bool two_sided, bool all, std::size_t channels>
HWY_INLINE void gather_word(const ElementVectors& row, const TileColumns& tile, const float* of_tile,
                            std::uint64_t word, RowSums<channels>& sums) {
  const Float d;
  constexpr std::size_t kLanes = hn::MaxLanes(Float());
  constexpr std::uint64_t kLaneBits = low_bits(kLanes);
  for (std::size_t j = 0; j < kTileSize; j += kLanes) {
    const std::uint64_t bits = word >> j & kLaneBits;
    if (!all && bits == 0) continue;
    const ElementVectors column =
        element_vectors(tile, [&](const TileFloats& of) { return hn::Load(d, of.data() + j); });
    const PairVectors pair = pair_vectors(row, column);
    Vec factor = pair_factor<rule>(row, column, pair);
    if constexpr (!all)
      factor = hn::IfThenElseZero(hn::LoadMaskBits(d, reinterpret_cast<const std::uint8_t*>(&bits)), factor);
    std::array<Vec, channels> power;
    for (std::size_t c = 0; c < channels; ++c) power[c] = hn::Load(d, of_tile + c * kTileSize + j);
    if constexpr (two_sided) {
      const Mask of_front = hn::Lt(pair.column_height, hn::Zero(d));
      for (std::size_t c = 0; c < channels; ++c)
        power[c] = hn::IfThenElse(of_front, power[c], hn::Load(d, of_tile + (channels + c) * kTileSize + j));
      // Columns of one vector are mostly on one side of the row.
      const Mask in_front = hn::Gt(pair.row_height, hn::Zero(d));
      if (!hn::AllFalse(d, in_front)) sums.front.add(hn::IfThenElseZero(in_front, factor), power);
      if (!hn::AllTrue(d, in_front)) sums.back.add(hn::IfThenZeroElse(in_front, factor), power);
    } else {
      sums.front.add(factor, power);
    }
  }
}

template <PairRule rule, bool two_sided, std::size_t channels>
HWY_INLINE void gather_row(const PairBlock& block, std::size_t row, RowIrradiance<channels>& sums) {
  const Float d;
  const ElementVectors of_row =
      element_vectors(block.columns.tiles[row / kTileSize],
                      [&](const TileFloats& of) { return hn::Set(d, of[row % kTileSize]); });
  RowSums<channels> vectors;
  vectors.front.of.fill(hn::Zero(d));
  vectors.back.of.fill(hn::Zero(d));
  for (const SeenTile& seen : block.tiles) {
    const std::uint64_t word = (*seen.bits)[row % kTileSize];
    const TileColumns& tile = block.columns.tiles[seen.tile];
    if (word == ~std::uint64_t{0})
      gather_word<rule, two_sided, true>(of_row, tile, block.power.of(seen.tile), word, vectors);
    else
      gather_word<rule, two_sided, false>(of_row, tile, block.power.of(seen.tile), word, vectors);
  }
  const auto sum = [d](Vec v) { return static_cast<double>(hn::GetLane(hn::SumOfLanes(d, v))); };
  for (std::size_t c = 0; c < channels; ++c) {
    sums[0][c] += sum(vectors.front.of[c]);
    if constexpr (two_sided) sums[1][c] += sum(vectors.back.of[c]);
  }
}

template <PairRule rule, bool two_sided, std::size_t channels>
void gather_rows(const PairBlock& block, std::span<RowIrradiance<channels>> sums) {
  for (std::size_t r = 0; r < sums.size(); ++r)
    gather_row<rule, two_sided, channels>(block, block.first_row + r, sums[r]);
}

template <PairRule rule, std::size_t channels>
void gather_by(const PairBlock& block, std::span<RowIrradiance<channels>> sums) {
  block.two_sided ? gather_rows<rule, true>(block, sums) : gather_rows<rule, false>(block, sums);
}

template <std::size_t channels>
void gather(const PairBlock& block, std::span<RowIrradiance<channels>> sums) {
  switch (block.rule) {
    case PairRule::point:
      return gather_by<PairRule::point>(block, sums);
    case PairRule::disc:
      return gather_by<PairRule::disc>(block, sums);
    case PairRule::moments:
      return gather_by<PairRule::moments>(block, sums);
  }
}

void gather_rgb(const PairBlock& block, std::span<RowIrradiance<kChannels>> sums) { gather(block, sums); }
void gather_one(const PairBlock& block, std::span<RowIrradiance<1>> sums) { gather(block, sums); }

}  // namespace fluxel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace fluxel {

HWY_EXPORT(gather_rgb);
HWY_EXPORT(gather_one);

PairColumns::PairColumns(std::span<const Element> elements)
    : tiles(tile_count(elements.size())), area(elements.size()) {
  make_columns(elements, 0, tiles.size(), tiles, area);
}

void make_columns(std::span<const Element> elements, std::size_t first, std::size_t last,
                  std::span<TileColumns> tiles, std::span<float> area) {
  // Form factors have no unit: lengths are divided by a power of two near the largest coordinate, so that r^4
  // neither overflows nor vanishes in single precision, whatever the scene's size.
  float largest = 0;
  for (const Element& element : elements)
    for (int axis = 0; axis < 3; ++axis) largest = std::max(largest, std::abs(element.centroid[axis]));
  const float scale = largest > 0 ? std::ldexp(1.0f, -std::ilogb(largest)) : 1.0f;
  for (std::size_t i = first * kTileSize; i < std::min(last * kTileSize, elements.size()); ++i) {
    TileColumns& tile = tiles[i / kTileSize];
    const std::size_t c = i % kTileSize;
    if (c == 0) tile = {};
    tile.x[c] = elements[i].centroid.x * scale;
    tile.y[c] = elements[i].centroid.y * scale;
    tile.z[c] = elements[i].centroid.z * scale;
    tile.normal_x[c] = elements[i].normal.x;
    tile.normal_y[c] = elements[i].normal.y;
    tile.normal_z[c] = elements[i].normal.z;
    area[i] = elements[i].area * scale * scale;
    tile.disc[c] = area[i] * std::numbers::inv_pi_v<float>;
    const glm::vec3 elongation = 2 * scale * elements[i].elongation;
    tile.elongation_x[c] = elongation.x;
    tile.elongation_y[c] = elongation.y;
    tile.elongation_z[c] = elongation.z;
    tile.variance4[c] = 4 * elements[i].minor_variance * scale * scale;
    tile.constant[c] = tile.variance4[c] - glm::dot(elongation, elongation) / 2;
    tile.least_r2[c] =
        static_cast<float>(kNearestSquares * flat_shape(elements[i]).moments.trace()) * scale * scale;
  }
  // Padding stands far away, so that no distance is zero.
  for (std::size_t i = elements.size(); i < last * kTileSize; ++i) {
    TileColumns& tile = tiles[i / kTileSize];
    tile.x[i % kTileSize] = tile.y[i % kTileSize] = tile.z[i % kTileSize] = 1e3f;
  }
}

void gather_block(const PairBlock& block, std::span<RowIrradiance<kChannels>> sums) {
  HWY_DYNAMIC_DISPATCH(gather_rgb)(block, sums);
}

void gather_block(const PairBlock& block, std::span<RowIrradiance<1>> sums) {
  HWY_DYNAMIC_DISPATCH(gather_one)(block, sums);
}

}  // namespace fluxel

#endif  // HWY_ONCE
