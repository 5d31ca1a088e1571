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

/// What the distance of a pair and its second-order term are made of, a row's in all lanes or that of a
/// vector of columns. What a rule does not use is never loaded.
struct ElementVectors {
  Vec3 centroid, elongation;
  Vec disc, variance4, constant, least_r2;
};

template <class Load>
HWY_INLINE ElementVectors element_vectors(const TileColumns& tile, const Load& load) {
  return {{load(tile.x), load(tile.y), load(tile.z)},
          {load(tile.elongation_x), load(tile.elongation_y), load(tile.elongation_z)},
          load(tile.disc),
          load(tile.variance4),
          load(tile.constant),
          load(tile.least_r2)};
}

template <class Load>
HWY_INLINE Vec3 normals(const TileColumns& tile, const Load& load) {
  return {load(tile.normal_x), load(tile.normal_y), load(tile.normal_z)};
}

/// How both planes of a pair stand.
struct PairPlanes {
  Vec row_height;             // of the column over the row's plane; > 0: it is in front of the row
  Vec column_height;          // of the row, times -1; < 0: the row is in front of the column
  Vec cosine;                 // of the normals
  Vec row_turn, column_turn;  // the element's elongation along the other's normal
};

HWY_INLINE PairPlanes pair_planes(const ElementVectors& row, const Vec3& row_normal,
                                  const ElementVectors& column, const Vec3& column_normal,
                                  const Vec3& separation) {
  return {dot(row_normal, separation), dot(column_normal, separation), dot(row_normal, column_normal),
          dot(row.elongation, column_normal), dot(column.elongation, row_normal)};
}

HWY_INLINE Vec3 difference(const Vec3& a, const Vec3& b) {
  return {hn::Sub(a.x, b.x), hn::Sub(a.y, b.y), hn::Sub(a.z, b.z)};
}

/// pi F_ij / A_j by the moments, as formfactor/pair_rule. With r the distance, p and q the heights,
/// w = 3 p q / r^2 and h = n_i . n_j - w, an element's part of the second-order term there is
///   a (w a - p b) + s p^2 h,   s = 4 m,
/// and what is left is p q c. Every step treats rows and columns alike, so that they may change places to the
/// last bit. Where both tiles are flat, a pair costs 29 multiplications for three channels, those fused with
/// sums counted as one and with those that add up; else 44.
HWY_INLINE Vec moments_factor(const ElementVectors& row, const ElementVectors& column,
                              const PairPlanes& planes, const Vec3& separation) {
  const Float d;
  const Vec p = planes.row_height, q = planes.column_height;
  const Vec product = hn::Mul(p, q);
  const Vec r2 = hn::Max(dot(separation, separation), hn::Add(row.least_r2, column.least_r2));
  const Vec inverse_r2 = hn::Div(hn::Set(d, 1.0f), r2);
  const Vec w = hn::Mul(hn::Mul(hn::Set(d, 3.0f), product), inverse_r2);
  const Vec h = hn::Sub(planes.cosine, w);
  const auto part = [&](const ElementVectors& of, Vec height, Vec turn) {
    const Vec along = dot(of.elongation, separation);
    const Vec turned = hn::MulSub(w, along, hn::Mul(height, turn));
    return hn::MulAdd(along, turned, hn::Mul(hn::Mul(of.variance4, hn::Mul(height, height)), h));
  };
  const Vec second_order =
      hn::MulAdd(product, hn::Add(row.constant, column.constant),
                 hn::Add(part(row, p, planes.row_turn), part(column, q, planes.column_turn)));
  const Vec bracket = hn::MulAdd(second_order, inverse_r2, product);
  const Vec kernel = hn::Xor(bracket, hn::And(product, hn::SignBit(d)));
  return hn::Mul(hn::Max(kernel, hn::Zero(d)), hn::Mul(inverse_r2, inverse_r2));
}

/// pi F_ij / A_j for a vector of columns. Divisions are exact ones: an approximate reciprocal and a Newton
/// step took longer where this was measured (Zen 4), and its digits differ between makers of processors.
template <PairRule rule>
HWY_INLINE Vec pair_factor(const ElementVectors& row, const ElementVectors& column, const PairPlanes& planes,
                           const Vec3& separation) {
  if constexpr (rule == PairRule::moments) {
    return moments_factor(row, column, planes, separation);
  } else {
    const Vec heights = hn::Abs(hn::Mul(planes.row_height, planes.column_height));
    const Vec r2 = dot(separation, separation);
    Vec bounded = r2;
    if constexpr (rule == PairRule::disc) bounded = hn::Add(bounded, hn::Max(row.disc, column.disc));
    return hn::Div(heights, hn::Mul(r2, bounded));
  }
}

/// True where all elements of a tile lie in one plane, up to the rounding of their centroids, as they mostly
/// do: tiles are parts of patches.
HWY_INLINE bool is_flat(const TileColumns& tile) {
  const Float d;
  // The largest coordinate is between 1 and 2.
  constexpr float kRounding = 0x1p-22f;
  const auto first = [d](const TileFloats& of) { return hn::Set(d, of[0]); };
  const Vec3 normal = normals(tile, first), origin{first(tile.x), first(tile.y), first(tile.z)};
  for (std::size_t j = 0; j < kTileSize; j += hn::MaxLanes(d)) {
    const auto load = [d, j](const TileFloats& of) { return hn::Load(d, of.data() + j); };
    const Vec3 own = normals(tile, load);
    const Vec height = hn::Abs(dot(normal, difference({load(tile.x), load(tile.y), load(tile.z)}, origin)));
    const Mask even = hn::And(hn::And(hn::Eq(own.x, normal.x), hn::Eq(own.y, normal.y)),
                              hn::And(hn::Eq(own.z, normal.z), hn::Le(height, hn::Set(d, kRounding))));
    const Mask padding = hn::Eq(load(tile.disc), hn::Zero(d));
    if (!hn::AllTrue(d, hn::Or(even, padding))) return false;
  }
  return true;
}

/// What two flat tiles tell of all their pairs at once.
struct FlatPair {
  alignas(64) TileFloats row_height, column_turn;  // of each column
  alignas(64) TileFloats column_height, row_turn;  // of each row
  float cosine;
};

/// The heights of a flat tile's elements over the plane of another, times `sign`, and their turns.
HWY_INLINE void stand_over(const TileColumns& plane, const TileColumns& tile, float sign, TileFloats& height,
                           TileFloats& turn) {
  const Float d;
  const auto first = [d](const TileFloats& of) { return hn::Set(d, of[0]); };
  const Vec3 normal = normals(plane, first), origin{first(plane.x), first(plane.y), first(plane.z)};
  for (std::size_t j = 0; j < kTileSize; j += hn::MaxLanes(d)) {
    const auto load = [d, j](const TileFloats& of) { return hn::Load(d, of.data() + j); };
    const Vec3 centroid{load(tile.x), load(tile.y), load(tile.z)};
    const Vec3 elongation{load(tile.elongation_x), load(tile.elongation_y), load(tile.elongation_z)};
    hn::Store(hn::Mul(hn::Set(d, sign), dot(normal, difference(centroid, origin))), d, height.data() + j);
    hn::Store(dot(normal, elongation), d, turn.data() + j);
  }
}

void make_flat_pair(const TileColumns& rows, const TileColumns& columns, FlatPair& pair) {
  stand_over(rows, columns, 1, pair.row_height, pair.column_turn);
  stand_over(columns, rows, -1, pair.column_height, pair.row_turn);
  pair.cosine = rows.normal_x[0] * columns.normal_x[0] + rows.normal_y[0] * columns.normal_y[0] +
                rows.normal_z[0] * columns.normal_z[0];
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

/// A row and a tile of columns. `flat` is null where one of both tiles is not flat.
struct RowAndTile {
  const TileColumns& rows;
  std::size_t row;  // of the tile
  const TileColumns& columns;
  const FlatPair* flat;
  const float* power;  // of the columns
  std::uint64_t bits;
};

/// Adds what the columns of one word send. `all`: the word has all its bits, which need not be looked at.
template <PairRule rule, bool two_sided, bool flat, bool all, std::size_t channels>
HWY_INLINE void gather_word(const ElementVectors& row, const RowAndTile& of, RowSums<channels>& sums) {
  const Float d;
  constexpr std::size_t kLanes = hn::MaxLanes(Float());
  constexpr std::uint64_t kLaneBits = low_bits(kLanes);
  const auto of_row = [&](const TileFloats& values) { return hn::Set(d, values[of.row]); };
  for (std::size_t j = 0; j < kTileSize; j += kLanes) {
    const std::uint64_t bits = of.bits >> j & kLaneBits;
    if (!all && bits == 0) continue;
    const auto load = [&](const TileFloats& values) { return hn::Load(d, values.data() + j); };
    const ElementVectors column = element_vectors(of.columns, load);
    const Vec3 separation = difference(column.centroid, row.centroid);
    PairPlanes planes;
    if constexpr (flat)
      planes = {load(of.flat->row_height), of_row(of.flat->column_height), hn::Set(d, of.flat->cosine),
                of_row(of.flat->row_turn), load(of.flat->column_turn)};
    else
      planes = pair_planes(row, normals(of.rows, of_row), column, normals(of.columns, load), separation);
    Vec factor = pair_factor<rule>(row, column, planes, separation);
    if constexpr (!all)
      factor = hn::IfThenElseZero(hn::LoadMaskBits(d, reinterpret_cast<const std::uint8_t*>(&bits)), factor);
    std::array<Vec, channels> power;
    for (std::size_t c = 0; c < channels; ++c) power[c] = hn::Load(d, of.power + c * kTileSize + j);
    if constexpr (two_sided) {
      const Mask of_front = hn::Lt(planes.column_height, hn::Zero(d));
      for (std::size_t c = 0; c < channels; ++c)
        power[c] = hn::IfThenElse(of_front, power[c], hn::Load(d, of.power + (channels + c) * kTileSize + j));
      // Columns of one vector are mostly on one side of the row.
      const Mask in_front = hn::Gt(planes.row_height, hn::Zero(d));
      if (!hn::AllFalse(d, in_front)) sums.front.add(hn::IfThenElseZero(in_front, factor), power);
      if (!hn::AllTrue(d, in_front)) sums.back.add(hn::IfThenZeroElse(in_front, factor), power);
    } else {
      sums.front.add(factor, power);
    }
  }
}

template <PairRule rule, bool two_sided, bool flat, std::size_t channels>
HWY_INLINE void gather_tile(const ElementVectors& row, const RowAndTile& of, RowSums<channels>& sums) {
  if (of.bits == ~std::uint64_t{0})
    gather_word<rule, two_sided, flat, true>(row, of, sums);
  else
    gather_word<rule, two_sided, flat, false>(row, of, sums);
}

template <PairRule rule, bool two_sided, std::size_t channels>
HWY_INLINE void gather_row(const PairBlock& block, std::size_t row, std::span<const FlatPair* const> flat,
                           RowIrradiance<channels>& sums) {
  const Float d;
  const TileColumns& rows = block.columns.tiles[row / kTileSize];
  const std::size_t r = row % kTileSize;
  const ElementVectors of_row =
      element_vectors(rows, [&](const TileFloats& of) { return hn::Set(d, of[r]); });
  RowSums<channels> vectors;
  vectors.front.of.fill(hn::Zero(d));
  vectors.back.of.fill(hn::Zero(d));
  for (std::size_t t = 0; t < block.tiles.size(); ++t) {
    const std::size_t tile = block.tiles[t].tile;
    const RowAndTile of{
        rows, r, block.columns.tiles[tile], flat[t], block.power.of(tile), (*block.tiles[t].bits)[r]};
    if (flat[t] != nullptr)
      gather_tile<rule, two_sided, true>(of_row, of, vectors);
    else
      gather_tile<rule, two_sided, false>(of_row, of, vectors);
  }
  const auto sum = [d](Vec v) { return static_cast<double>(hn::GetLane(hn::SumOfLanes(d, v))); };
  for (std::size_t c = 0; c < channels; ++c) {
    sums[0][c] += sum(vectors.front.of[c]);
    if constexpr (two_sided) sums[1][c] += sum(vectors.back.of[c]);
  }
}

template <PairRule rule, bool two_sided, std::size_t channels>
void gather_rows(const PairBlock& block, std::span<RowIrradiance<channels>> sums) {
  std::array<FlatPair, kBlockTiles> pairs;
  std::array<const FlatPair*, kBlockTiles> flat{};
  const TileColumns& rows = block.columns.tiles[block.first_row / kTileSize];
  if (is_flat(rows)) {
    for (std::size_t t = 0; t < block.tiles.size(); ++t) {
      const TileColumns& columns = block.columns.tiles[block.tiles[t].tile];
      if (!is_flat(columns)) continue;
      make_flat_pair(rows, columns, pairs[t]);
      flat[t] = &pairs[t];
    }
  }
  for (std::size_t r = 0; r < sums.size(); ++r)
    gather_row<rule, two_sided, channels>(block, block.first_row + r, flat, sums[r]);
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
