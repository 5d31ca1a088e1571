#include "visibility/facing.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "visibility/facing.cpp"
#include <hwy/foreach_target.h>  // compiles this file once for each instruction set

#include "visibility/lanes-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace fluxel::HWY_NAMESPACE {

FacingWords facing_words(const TilePoints& rows, std::size_t row, const TilePoints& columns,
                         float least_height) {
  const Float d;
  const Vec3 from = set(d, rows.centroid.at(row)), normal = set(d, rows.normal.at(row));
  const Vec least = hn::Set(d, least_height), most = hn::Neg(least);
  FacingWords words;
  for (std::size_t c = 0; c < kTileSize; c += hn::Lanes(d)) {
    const Vec3 separation = load(d, columns.centroid, c) - from;
    const Vec height = dot(normal, separation);                     // of the column over the row
    const Vec depth = dot(load(d, columns.normal, c), separation);  // of the row under the column
    words.of_row[0] |= bits_of(d, hn::Gt(height, least)) << c;
    words.of_row[1] |= bits_of(d, hn::Lt(height, most)) << c;
    words.of_column[0] |= bits_of(d, hn::Lt(depth, most)) << c;
    words.of_column[1] |= bits_of(d, hn::Gt(depth, least)) << c;
  }
  return words;
}

}  // namespace fluxel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace fluxel {

HWY_EXPORT(facing_words);

FacingWords facing_words(const TilePoints& rows, std::size_t row, const TilePoints& columns,
                         float least_height) {
  return HWY_DYNAMIC_DISPATCH(facing_words)(rows, row, columns, least_height);
}

}  // namespace fluxel

#endif  // HWY_ONCE
