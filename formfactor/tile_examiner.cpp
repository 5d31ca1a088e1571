#include "formfactor/tile_examiner.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <stdexcept>

#include "scene/occluding_patches.hpp"

namespace fluxel {

namespace {

/// Of the power, in tolerances: full sets of rays at once; probes everywhere; probes where the bits show the
/// edge of a shadow. Many small shares at one shadow's edge err alike: hence the last is less than one.
constexpr double kLargeShare = 30, kMiddleShare = 10, kSmallShare = kMinShare;

/// Measured in the Cornell box: rays there, what else a pair takes in rays, and tiles of which no pair takes
/// any.
constexpr double kRaySeconds = 7.5e-8, kExchangeRays = 16, kContourRays = 100;
constexpr double kTileSeconds = 3e-5, kLargeTileSeconds = 8e-5;
/// Of the pairs of a tile with bits, how many turn out to be partly visible.
constexpr double kPartialPairs = 0.05;

/// The sides (0 front, 1 back) that the centroids of two elements show each other.
struct FacingSides {
  std::uint32_t i, j;
};

FacingSides facing_sides(const Element& i, const Element& j) {
  const glm::vec3 separation = j.centroid - i.centroid;
  return {glm::dot(i.normal, separation) > 0 ? 0u : 1u, glm::dot(j.normal, separation) < 0 ? 0u : 1u};
}

/// Whose parts all elements of the tile are, or kNoPatch.
PatchId patch_of_tile(std::span<const Element> elements, std::size_t tile) {
  const std::span<const Element> of_tile =
      elements.subspan(tile * kTileSize, rows_of_tile(tile, elements.size()));
  const PatchId patch = of_tile.front().patch;
  const bool alone =
      std::ranges::all_of(of_tile, [&](const Element& element) { return element.patch == patch; });
  return alone ? patch : kNoPatch;
}

/// The bits that differ from one beside them, and the aligned 4 x 4 blocks that are not all one value: four
/// elements in a row are a node of a patch's tree more often than not. Elsewhere no edge of a shadow is near.
TileBits shadow_edges(const TileBits& bits) {
  constexpr std::uint64_t kFirstOfFour = 0x1111111111111111ull, kLast = std::uint64_t{1} << 63;
  TileBits edges;
  for (std::size_t r = 0; r < kTileSize; r += 4) {
    const std::uint64_t any_row = bits[r] | bits[r + 1] | bits[r + 2] | bits[r + 3];
    const std::uint64_t all_rows = bits[r] & bits[r + 1] & bits[r + 2] & bits[r + 3];
    const std::uint64_t any = (any_row | any_row >> 1 | any_row >> 2 | any_row >> 3) & kFirstOfFour;
    const std::uint64_t all = (all_rows & all_rows >> 1 & all_rows >> 2 & all_rows >> 3) & kFirstOfFour;
    for (std::size_t k = 0; k < 4; ++k) edges[r + k] = (any & ~all) * 0xF;
  }
  for (std::size_t r = 0; r < kTileSize; ++r) {
    const std::uint64_t row = bits[r];
    edges[r] |= row ^ (row << 1 | (row & 1));
    edges[r] |= row ^ (row >> 1 | (row & kLast));
    if (r > 0) edges[r] |= row ^ bits[r - 1];
    if (r + 1 < kTileSize) edges[r] |= row ^ bits[r + 1];
  }
  return edges;
}

}  // namespace

TileExaminer::TileExaminer(const RayScene& ray_scene, const Scene& scene, const ElementView& mesh,
                           const FormFactorOptions& options, const PowerEstimate& power)
    : ray_scene_(ray_scene),
      occlusion_(ray_scene, options.rule == FormFactor::adaptive ? occluding_patches(scene) : Scene{},
                 static_cast<double>(ray_scene.surface_epsilon())),
      mesh_(mesh),
      examiner_(occlusion_, scene, mesh, options, power),
      elements_(mesh.elements),
      options_(options),
      power_(power),
      pair_tolerance_(kPairTolerance * options.tolerance),
      filter_(elements_, pair_tolerance_, kCrossingShare * pair_tolerance_),
      shares_(elements_, power),
      bodies_(scene) {
  if (power.B.size() > std::numeric_limits<std::uint32_t>::max())
    throw std::length_error("more unknowns than 32 bits count");
  for (std::size_t tile = 0; tile < tile_count(elements_.size()); ++tile) {
    shapes_.push_back(tile_shape(elements_, tile));
    powers_.push_back(tile_power(elements_, tile, power));
    patches_.push_back(patch_of_tile(elements_, tile));
    corners_.push_back(HiddenPairs::tile_corners(mesh_, tile));
  }
}

bool TileExaminer::has_work(std::size_t row, std::size_t column) const {
  const Work work = work_of(row, column);
  return work.near || work.large || work.small;
}

double TileExaminer::predicted_seconds(std::size_t row, std::size_t column, TileTag tag) const {
  constexpr std::size_t kPairs = 16;
  const std::size_t rows = rows_of_tile(row, elements_.size()),
                    columns = rows_of_tile(column, elements_.size());
  const Work work = work_of(row, column);
  double rays = 0;
  for (std::size_t k = 0; k < kPairs; ++k) {
    // One of each four rows, and columns that are spread evenly.
    const std::size_t i = row * kTileSize + (4 * k + k % 4) % rows;
    const std::size_t j = column * kTileSize + (23 * k + 7) % columns;
    if (elements_[i].patch != elements_[j].patch)
      rays += predicted_rays({std::min(i, j), std::max(i, j), false}, work, tag);
  }
  return kTileSeconds + (work.large ? kLargeTileSeconds : 0) +
         rays * kRaySeconds * static_cast<double>(rows * columns) / kPairs;
}

double TileExaminer::predicted_rays(const PairBit& pair, const Work& work, TileTag tag) const {
  if (options_.rule == FormFactor::points) {
    const auto points = static_cast<double>(options_.points.m * options_.points.n);
    return points * points;
  }
  const bool near = work.near && needs_contour(pair.i, pair.j);
  const double least = tag == TileTag::bits ? kSmallShare : kMiddleShare;
  const double share = share_of(pair) / options_.tolerance;
  if (!near && share <= least) return 0;
  const auto rays_for = [](double wanted) { return std::clamp<double>(wanted, kMinPairRays, kMaxPairRays); };
  // As visible_fraction draws them; what is clipped in their place costs about as much or less.
  const double of_whole = rays_for(0.5 * share / kUnanimousTolerance);
  const double of_partial =
      tag == TileTag::bits ? kPartialPairs * rays_for(rays_at_an_edge({share, kRayTolerance})) : 0;
  if (near) return kContourRays + (share > kMinShare ? of_whole + of_partial : 0);
  if (share > kLargeShare) return kExchangeRays + of_whole + of_partial;
  return VisibilityProbe::kRays + of_partial;
}

TileExaminer::Work TileExaminer::work_of(std::size_t row, std::size_t column) const {
  // No part of a patch sees another.
  if (patches_[row] != kNoPatch && patches_[row] == patches_[column]) return {false, false, false};
  const bool near =
      options_.rule == FormFactor::points || may_be_near(shapes_[row], shapes_[column], pair_tolerance_);
  const double share =
      options_.partial_visibility
          ? largest_share(shapes_[row], powers_[row], shapes_[column], powers_[column]) / options_.tolerance
          : 0;
  return {near, share > kMiddleShare, share > kSmallShare};
}

void TileExaminer::examine(std::size_t row, std::size_t column, const TileBits& bits, std::size_t first,
                           std::size_t last, Found& found) const {
  const Work work = work_of(row, column);
  VisibilityProbe probe(ray_scene_, mesh_);
  HiddenPairs hiders(bodies_, mesh_, corners_, static_cast<double>(ray_scene_.surface_epsilon()));
  const bool any = std::ranges::any_of(bits, [](std::uint64_t word) { return word != 0; });
  if (!any && row != column && hiders.hidden_tiles(row, column)) return;
  TileOccluders occluders(occlusion_, mesh_, bounds(corners_[row]), bounds(corners_[column]));
  const TileBits edges = work.small ? shadow_edges(bits) : TileBits{};
  for (std::size_t r = first; r < std::min(last, rows_of_tile(row, elements_.size())); ++r) {
    const std::size_t i = row * kTileSize + r;
    const std::uint64_t near = work.near ? near_candidates(i, column) : 0;
    const std::uint64_t worth = worth_rays(i, column, work, edges[r]);
    const std::uint64_t later = row == column ? ~std::uint64_t{0} << r << 1 : ~std::uint64_t{0};
    std::uint64_t left = (near | worth) & later & low_bits(rows_of_tile(column, elements_.size()));
    for (; left != 0; left &= left - 1) {
      const auto c = static_cast<std::size_t>(std::countr_zero(left));
      const std::size_t j = column * kTileSize + c;
      if (elements_[i].patch == elements_[j].patch) continue;
      const PairBit pair{i, j, (bits[r] >> c & 1u) != 0};
      if ((near >> c & 1u) != 0 && examine_near(pair, occluders, found)) continue;
      if ((worth >> c & 1u) == 0) continue;
      const bool at_edge = (edges[r] >> c & 1u) != 0;
      const double share = share_of(pair) / options_.tolerance;
      if (share > kLargeShare) {
        // A hundred rays would only find the same, and of such pairs there are many: all shadows of lamps.
        if (!pair.sees && hiders.hidden(i, j)) continue;
        add(pair, examiner_.exchange(i, j, false, pair.sees, occluders, found.counts), found.entries);
      } else if (share > (at_edge ? kSmallShare : kMiddleShare)) {
        if (!pair.sees && hiders.hidden(i, j)) continue;
        probe.add(pair);
      }
    }
  }
  probe.finish();
  found.counts.rays += probe.rays();
  for (const PairBit& pair : probe.contradicted())
    add(pair, examiner_.exchange(pair.i, pair.j, false, pair.sees, occluders, found.counts), found.entries);
}

std::uint64_t TileExaminer::worth_rays(std::size_t i, std::size_t tile, const Work& work,
                                       std::uint64_t edges) const {
  std::uint64_t worth = 0;
  if (work.large) worth |= shares_.above(kMiddleShare * options_.tolerance, i, tile);
  if (edges != 0) worth |= edges & shares_.above(kSmallShare * options_.tolerance, i, tile);
  return worth;
}

std::uint64_t TileExaminer::near_candidates(std::size_t i, std::size_t tile) const {
  return options_.rule == FormFactor::points ? ~std::uint64_t{0} : filter_.candidates(i, tile);
}

bool TileExaminer::needs_contour(std::size_t i, std::size_t j) const {
  const FlatShape a = flat_shape(elements_[i]), b = flat_shape(elements_[j]);
  return moments_error(a, b) > pair_tolerance_ || crossing_error(a, b) > kCrossingShare * pair_tolerance_;
}

bool TileExaminer::examine_near(const PairBit& pair, TileOccluders& occluders, Found& found) const {
  if (options_.rule == FormFactor::points) {
    add(pair, examiner_.exchange_by_points(pair.i, pair.j, found.counts), found.entries);
  } else if (needs_contour(pair.i, pair.j)) {
    add(pair, examiner_.exchange(pair.i, pair.j, true, pair.sees, occluders, found.counts), found.entries);
  } else {
    return false;
  }
  ++found.counts.near_pairs;
  return true;
}

double TileExaminer::share_of(const PairBit& pair) const {
  const Element &a = elements_[pair.i], &b = elements_[pair.j];
  const FacingSides sides = facing_sides(a, b);
  if ((a.sides >> sides.i & 1u) == 0 || (b.sides >> sides.j & 1u) == 0) return 0;
  const double F = pair_form_factor(PairRule::disc, a, b);
  return power_.share(pair.i + sides.i * elements_.size(), pair.j + sides.j * elements_.size(), F,
                      F * static_cast<double>(a.area) / static_cast<double>(b.area));
}

void TileExaminer::add(const PairBit& pair, const SideExchanges& exchanges,
                       std::vector<CorrectionEntry>& entries) const {
  const Element &a = elements_[pair.i], &b = elements_[pair.j];
  const FacingSides seen = facing_sides(a, b);
  const PairRule rule =
      rule_between(shapes_[pair.i / kTileSize], shapes_[pair.j / kTileSize], kernel_rule(options_));
  const double of_kernel = pair.sees ? static_cast<double>(a.area) * pair_form_factor(rule, a, b) : 0.0;
  const auto add_sides = [&](std::uint32_t side_i, std::uint32_t side_j, double G) {
    // What changes neither row by a hundredth of what a pair may err by is not worth its bytes.
    const double least = static_cast<double>(std::min(a.area, b.area));
    if (std::abs(G) <= 0.01 * pair_tolerance_ * least) return;
    const auto row = static_cast<std::uint32_t>(pair.i + side_i * elements_.size());
    const auto column = static_cast<std::uint32_t>(pair.j + side_j * elements_.size());
    entries.push_back({row, column, static_cast<float>(G)});
    entries.push_back({column, row, static_cast<float>(G)});
  };
  bool kernel_done = !pair.sees;
  for (const SideExchange& exchange : exchanges) {
    const bool same = exchange.side_i == seen.i && exchange.side_j == seen.j;
    add_sides(exchange.side_i, exchange.side_j, exchange.G - (same ? of_kernel : 0.0));
    kernel_done = kernel_done || same;
  }
  if (!kernel_done) add_sides(seen.i, seen.j, -of_kernel);
}

}  // namespace fluxel
