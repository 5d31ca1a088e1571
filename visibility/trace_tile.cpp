#include "visibility/trace_tile.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace fluxel {

namespace {

/// Fills packets with the pairs of one row, traces full ones, and leaves the row's word.
class RowTracer {
 public:
  RowTracer(const RayScene& ray_scene, const Element& row)
      : ray_scene_(ray_scene), row_(row), epsilon_(ray_scene.surface_epsilon()) {}

  void add(std::size_t column_bit, const Element& column, float row_height, float column_height) {
    const auto lane = static_cast<std::size_t>(count_);
    // Both ends are lifted off the planes of their own elements, so that rounding cannot make an element hide
    // itself or its coplanar neighbours. Were the ray shortened instead until it has left the planes, at a
    // grazing angle it would begin behind the wall that stands beside the element.
    const glm::vec3 from = row_.centroid + std::copysign(epsilon_, row_height) * row_.normal;
    const glm::vec3 to = column.centroid + std::copysign(epsilon_, column_height) * column.normal;
    packet_.origin_x[lane] = from.x;
    packet_.origin_y[lane] = from.y;
    packet_.origin_z[lane] = from.z;
    packet_.direction_x[lane] = to.x - from.x;
    packet_.direction_y[lane] = to.y - from.y;
    packet_.direction_z[lane] = to.z - from.z;
    packet_.t_near[lane] = 0;
    packet_.t_far[lane] = 1;
    bit_[lane] = column_bit;
    if (++count_ == RayPacket::kSize) trace();
  }

  std::uint64_t finish() {
    if (count_ > 0) trace();
    return word_;
  }

  [[nodiscard]] std::uint64_t rays() const { return rays_; }

 private:
  void trace() {
    const std::uint32_t hidden = ray_scene_.occluded(packet_, count_);
    for (int k = 0; k < count_; ++k)
      if ((hidden >> k & 1u) == 0) word_ |= std::uint64_t{1} << bit_[static_cast<std::size_t>(k)];
    rays_ += static_cast<std::uint64_t>(count_);
    count_ = 0;
  }

  const RayScene& ray_scene_;
  const Element& row_;
  float epsilon_;
  RayPacket packet_;
  std::array<std::size_t, RayPacket::kSize> bit_{};
  int count_ = 0;
  std::uint64_t word_ = 0;
  std::uint64_t rays_ = 0;
};

bool side_is_unknown(const Element& element, float towards) {
  return (element.sides & (towards > 0 ? kFront : kBack)) != 0;
}

TileTag tag_of(const TracedTile& tile, std::size_t rows, std::size_t columns) {
  if (tile.rays == 0) return TileTag::facing_away;
  const auto row_words = std::span(tile.bits).first(rows);
  if (std::ranges::all_of(row_words, [](std::uint64_t word) { return word == 0; })) return TileTag::blocked;
  if (std::ranges::all_of(row_words, [columns](std::uint64_t word) { return word == low_bits(columns); }))
    return TileTag::visible;
  return TileTag::bits;
}

}  // namespace

TracedTile trace_tile(const RayScene& ray_scene, std::span<const Element> elements, std::size_t row_tile,
                      std::size_t column_tile) {
  TracedTile tile;
  const std::size_t rows = rows_of_tile(row_tile, elements.size());
  const std::size_t columns = rows_of_tile(column_tile, elements.size());
  // Below two epsilons the other centroid lies in the element's own plane for all that rays can tell.
  const float least_height = 2 * ray_scene.surface_epsilon();

  for (std::size_t r = 0; r < rows; ++r) {
    const Element& row = elements[row_tile * kTileSize + r];
    RowTracer tracer(ray_scene, row);
    for (std::size_t c = row_tile == column_tile ? r + 1 : 0; c < columns; ++c) {
      const Element& column = elements[column_tile * kTileSize + c];
      if (row.patch == column.patch) continue;
      const glm::vec3 separation = column.centroid - row.centroid;
      const float row_height = glm::dot(row.normal, separation);
      const float column_height = -glm::dot(column.normal, separation);
      if (std::abs(row_height) <= least_height || std::abs(column_height) <= least_height) continue;
      if (!side_is_unknown(row, row_height) || !side_is_unknown(column, column_height)) continue;
      tracer.add(c, column, row_height, column_height);
    }
    tile.bits[r] = tracer.finish();
    tile.rays += tracer.rays();
  }
  if (row_tile == column_tile) {
    TileBits mirrored = tile.bits;
    transpose(mirrored);
    for (std::size_t r = 0; r < kTileSize; ++r) tile.bits[r] |= mirrored[r];
  }
  tile.tag = tag_of(tile, rows, columns);
  return tile;
}

}  // namespace fluxel
