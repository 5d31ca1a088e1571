#include "scene/patch_order.hpp"

#include <algorithm>
#include <glm/common.hpp>
#include <limits>
#include <tuple>
#include <utility>
#include <vector>

#include "scene/polygon.hpp"

namespace fluxel {
namespace {

constexpr std::uint32_t kBits = 21;

}  // namespace

std::uint64_t hilbert_key(std::array<std::uint32_t, 3> cell) {
  constexpr std::uint32_t kHighest = 1u << (kBits - 1);
  for (std::uint32_t bit = kHighest; bit > 1; bit >>= 1) {
    const std::uint32_t lower = bit - 1;
    for (std::uint32_t& x : cell) {
      if ((x & bit) != 0) {
        cell[0] ^= lower;
      } else {
        const std::uint32_t exchanged = (cell[0] ^ x) & lower;
        cell[0] ^= exchanged;
        x ^= exchanged;
      }
    }
  }
  cell[1] ^= cell[0];
  cell[2] ^= cell[1];
  std::uint32_t gray = 0;
  for (std::uint32_t bit = kHighest; bit > 1; bit >>= 1) {
    if ((cell[2] & bit) != 0) gray ^= bit - 1;
  }
  std::uint64_t key = 0;
  for (std::uint32_t bit = kBits; bit-- > 0;) {
    for (const std::uint32_t x : cell) key = key << 1 | ((x ^ gray) >> bit & 1u);
  }
  return key;
}

void order_pieces(Scene& scene) {
  std::vector<glm::dvec3> centre;
  glm::dvec3 low{std::numeric_limits<double>::infinity()}, high{-low};
  for (const Patch& patch : scene.patches) {
    centre.push_back(centroid(corners(patch.outline)));
    low = glm::min(low, centre.back());
    high = glm::max(high, centre.back());
  }
  // One scale for the three axes, so that the cells are cubes.
  const glm::dvec3 size = high - low;
  const double largest = std::max({size.x, size.y, size.z});
  const double scale = largest > 0 ? ((1u << kBits) - 1) / largest : 0;
  // Fractions of the box, which scenes are full of, stay away from where cells meet: there rounding, and with
  // it the unit of length, would choose the cell.
  constexpr double kOffset = 0.382;
  std::vector<std::uint64_t> key;
  for (const glm::dvec3& c : centre) {
    const glm::dvec3 cell = (c - low) * scale + kOffset;
    key.push_back(hilbert_key({static_cast<std::uint32_t>(cell.x), static_cast<std::uint32_t>(cell.y),
                               static_cast<std::uint32_t>(cell.z)}));
  }
  std::vector<std::tuple<std::uint64_t, PatchId, std::size_t>> order;
  order.reserve(scene.pieces.size());
  for (const Piece& piece : scene.pieces)
    order.emplace_back(key[index(piece.patch)], piece.patch, order.size());
  std::ranges::sort(order);
  std::vector<Piece> pieces;
  pieces.reserve(order.size());
  for (const auto& place : order) pieces.push_back(scene.pieces[std::get<2>(place)]);
  scene.pieces = std::move(pieces);
}

}  // namespace fluxel
