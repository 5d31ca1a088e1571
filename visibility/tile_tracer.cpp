#include "visibility/tile_tracer.hpp"

#include <algorithm>
#include <bit>

#include "visibility/facing.hpp"
#include "visibility/find_occluders.hpp"
#include "visibility/largest_bodies.hpp"

namespace fluxel {

namespace {

/// Rays of a tile, traced in packets in the order in which they come.
class PacketTracer {
 public:
  PacketTracer(const RayScene& ray_scene, TileBits& visible) : ray_scene_(ray_scene), visible_(visible) {}

  void add(std::size_t row, std::size_t column, const glm::vec3& from, const glm::vec3& to) {
    packet_.set_segment(count_, from, to);
    place_[static_cast<std::size_t>(count_)] = {row, column};
    if (++count_ == RayPacket::kSize) finish();
  }

  void finish() {
    if (count_ == 0) return;
    const std::uint32_t hidden = ray_scene_.occluded(packet_, count_);
    for (int k = 0; k < count_; ++k) {
      const auto [row, column] = place_[static_cast<std::size_t>(k)];
      if ((hidden >> k & 1u) == 0) visible_[row] |= std::uint64_t{1} << column;
    }
    rays_ += static_cast<std::uint64_t>(count_);
    count_ = 0;
  }

  [[nodiscard]] std::uint64_t rays() const { return rays_; }

 private:
  struct Place {
    std::size_t row, column;
  };

  const RayScene& ray_scene_;
  TileBits& visible_;
  RayPacket packet_;
  std::array<Place, RayPacket::kSize> place_{};
  int count_ = 0;
  std::uint64_t rays_ = 0;
};

Shaft shaft_of(const RayBundle& bundle) {
  const auto copy = [](std::span<const glm::vec3> hull, std::array<glm::dvec3, 8>& corners) {
    std::ranges::copy(hull, corners.begin());
    return std::span<const glm::dvec3>(corners).first(hull.size());
  };
  std::array<glm::dvec3, 8> from_corners, to_corners;
  const auto from = copy(bundle.from.corners(bundle.row_side), from_corners);
  const auto to = copy(bundle.to.corners(bundle.column_side), to_corners);
  if (bundle.from.flat && bundle.to.flat) return {from, to};
  return {bounds(from), bounds(to)};
}

/// A bundle of fewer rays is traced without a list.
constexpr std::size_t kWorthAList = 64;
/// So many bodies are listed for a bundle; where there are more, the others are not looked for.
constexpr std::size_t kMaxListed = 192;
/// So many bodies of a list are tested before the others: those that are likely to hide most.
constexpr std::size_t kFirstTested = 32;
/// What it costs to test a body for a bundle: as much as tracing so many rays.
constexpr std::size_t kRaysOfBody = 8;

}  // namespace

/// The rays of a tile by side of the row and side of the column.
struct TileTracer::Facing {
  std::array<std::array<TileBits, 2>, 2> rays{};
  std::array<std::array<bool, 2>, 2> any{};
};

TileTracer::TileTracer(const RayScene& ray_scene, std::span<const Element> elements, Shortcuts shortcuts)
    : ray_scene_(ray_scene),
      elements_(elements.size()),
      extent_(static_cast<float>(ray_scene.scene().extent)),
      shortcuts_(shortcuts),
      tree_(ray_scene.scene()) {
  points_.reserve(tile_count(elements.size()));
  for (std::size_t tile = 0; tile < tile_count(elements.size()); ++tile)
    points_.push_back(tile_points(ray_scene.scene(), elements, tile, ray_scene.surface_epsilon()));
}

TileTracer::Facing TileTracer::find_facing(std::size_t row_tile, std::size_t column_tile) const {
  const TilePoints& rows = points_[row_tile];
  const TilePoints& columns = points_[column_tile];
  // Below two epsilons the other centroid lies in the element's own plane for all that rays can tell.
  const float least_height = kFacingHeights * ray_scene_.surface_epsilon();
  Facing facing;
  for (std::size_t r = 0; r < rows_of_tile(row_tile, elements_); ++r) {
    const FacingWords words = facing_words(rows, r, columns, least_height);
    const std::uint64_t later = row_tile == column_tile ? ~std::uint64_t{0} << r << 1 : ~std::uint64_t{0};
    for (const std::size_t a : {0u, 1u}) {
      if ((rows.unknown[a] >> r & 1u) == 0) continue;
      for (const std::size_t b : {0u, 1u}) {
        const std::uint64_t word = words.of_row[a] & words.of_column[b] & columns.unknown[b] & later;
        facing.rays[a][b][r] = word;
        facing.any[a][b] = facing.any[a][b] || word != 0;
      }
    }
  }
  return facing;
}

TracedTile TileTracer::trace(std::size_t row_tile, std::size_t column_tile) const {
  TracedTile tile;
  const Facing facing = find_facing(row_tile, column_tile);
  PacketTracer tracer(ray_scene_, tile.bits);
  bool any = false;
  for (const Side row_side : kSides) {
    for (const Side column_side : kSides) {
      const std::size_t a = index(row_side), b = index(column_side);
      if (!facing.any[a][b]) continue;
      any = true;
      const TileBits& rays = facing.rays[a][b];
      const Occlusion occlusion = occlude_tile(row_tile, column_tile, row_side, column_side, rays);
      const TileVectors& from = points_[row_tile].lifted[a];
      const TileVectors& to = points_[column_tile].lifted[b];
      for (std::size_t r = 0; r < kTileSize; ++r) {
        const std::uint64_t open = rays[r] & ~occlusion.blocked[r];
        tile.bits[r] |= open & ~occlusion.unsure[r];
        for (std::uint64_t left = open & occlusion.unsure[r]; left != 0; left &= left - 1) {
          const auto c = static_cast<std::size_t>(std::countr_zero(left));
          tracer.add(r, c, from.at(r), to.at(c));
        }
      }
    }
  }
  if (!any) return tile;
  tracer.finish();
  tile.rays = tracer.rays();
  complete_tile(row_tile, column_tile, elements_, tile);
  return tile;
}

Occlusion TileTracer::occlude_tile(std::size_t row_tile, std::size_t column_tile, Side row_side,
                                   Side column_side, const TileBits& rays) const {
  Occlusion occlusion;
  if (shortcuts_ == Shortcuts::off) {
    occlusion.unsure = rays;
    return occlusion;
  }
  const TilePoints& rows = points_[row_tile];
  const TilePoints& columns = points_[column_tile];
  std::vector<std::uint32_t> numbers;
  for (std::size_t i = 0; i < rows.clusters.size(); ++i)
    for (std::size_t j = 0; j < columns.clusters.size(); ++j)
      if (any_ray(rows.clusters[i], columns.clusters[j], rays))
        occlude_bundle({rows, columns, rows.clusters[i], columns.clusters[j], row_side, column_side, extent_},
                       rays, numbers, occlusion);
  return occlusion;
}

void TileTracer::occlude_bundle(const RayBundle& bundle, const TileBits& rays,
                                std::vector<std::uint32_t>& numbers, Occlusion& occlusion) const {
  const auto trace_all = [&] { add_rays(bundle.from, bundle.to, rays, occlusion.unsure); };
  const std::size_t asked = count_rays(bundle.from, bundle.to, rays);
  if (asked < kWorthAList) return trace_all();
  const bool complete = find_occluders(tree_, shaft_of(bundle), extent_, kMaxListed, numbers);
  if (numbers.empty()) return;
  // Half the price, as the first to hide all ends the tests.
  if (asked < kRaysOfBody * std::min(numbers.size(), kFirstTested) / 2) return trace_all();
  // What is hidden needs one body, what is seen the whole list. Where that is not known, only what is as
  // large as the bundle is worth a test.
  const float least_breadth = complete ? 0 : mean_radius(bundle);
  const std::size_t first = largest_first(bundle, tree_.bodies(), kFirstTested, least_breadth, numbers);
  if (first > 0) occlude(bundle, tree_.bodies(), std::span(numbers).first(first), rays, occlusion);
  const auto rest = std::span(numbers).subspan(first);
  if (complete && rest.empty()) return;

  TileBits open{};
  std::size_t count = 0;
  for (std::size_t r = bundle.from.first; r < bundle.from.last; ++r) {
    open[r] = rays[r] & bundle.to.mask() & ~occlusion.blocked[r];
    count += static_cast<std::size_t>(std::popcount(open[r]));
  }
  if (count == 0) return;
  if (!complete || rest.size() > kMaxBodies || count < kRaysOfBody * rest.size()) {
    add_rays(bundle.from, bundle.to, open, occlusion.unsure);
  } else {
    occlude(bundle, tree_.bodies(), rest, open, occlusion);
  }
}

}  // namespace fluxel
