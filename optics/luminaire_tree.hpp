#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

namespace fluxel {

/// A point of a side of a surface, which luminaires light.
struct LitPlace {
  glm::dvec3 position{0};  ///< [m, recentred]
  glm::dvec3 normal{0};    ///< unit, of the side
};

/// What of a luminaire decides how likely its group is drawn.
struct LuminairePlace {
  glm::dvec3 low{0}, high{0};  ///< of its opening [m, recentred]
  double mean = 0;             ///< intensity over all directions
};

/// A binary tree of luminaires by their places, through which one group of few is drawn in a time that grows
/// with the logarithm of their number. Queries may run from many threads at once.
class LuminaireTree {
 public:
  explicit LuminaireTree(std::span<const LuminairePlace> luminaires);

  struct Group {
    std::span<const std::uint32_t> members;  ///< none: nothing comes that way
    double chance = 1;                       ///< of this group
    double choice = 0;                       ///< what is left of the number, of [0, 1) again
  };

  /// Drawn by a number of [0, 1), at each node by about what its halves would bring if they sent in all
  /// directions alike; above 0 wherever one of them is in front of the place (as Conty Estevez and Kulla
  /// 2018, section 4, without their cones of directions, and with boxes in place of spheres).
  [[nodiscard]] Group draw(const LitPlace& at, double choice) const;

 private:
  struct Node {
    glm::dvec3 low{0}, high{0};  ///< of all openings
    double mean = 0;             ///< sum of the luminaires'
    std::uint32_t first = 0, count = 0;
    std::uint32_t second = 0;  ///< the other half; the one begins at the next node; 0: a group
  };

  std::uint32_t build(std::span<const LuminairePlace> luminaires, std::uint32_t first, std::uint32_t count);
  [[nodiscard]] static double expected(const Node& node, const LitPlace& at);

  std::vector<std::uint32_t> order_;
  std::vector<Node> nodes_;
};

}  // namespace fluxel
