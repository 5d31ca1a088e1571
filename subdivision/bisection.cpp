#include "subdivision/bisection.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <iterator>
#include <limits>

#include "core/error.hpp"

namespace fluxel {

namespace {

/// Of an outline's width: what is taken to lie on a dividing line.
constexpr double kOnLine = 1e-9;

/// Deeper than double precision can follow: 2^-100 of the root's area.
constexpr int kMaxDepth = 100;

struct Division {
  glm::dvec3 from, to;  // the dividing segment
  Outline3 left, right;
};

double edge_length(const Outline3& outline, std::uint32_t edge) {
  return glm::distance(outline.corner[edge], outline.corner[(edge + 1) % outline.corners]);
}

Division divide(const Outline3& outline, std::uint32_t e) {
  const auto& corner = outline.corner;
  const auto middle = [&corner, n = outline.corners](std::uint32_t edge) {
    return 0.5 * (corner[edge] + corner[(edge + 1) % n]);
  };
  if (outline.corners == 4) {
    const glm::dvec3 from = middle(e), to = middle(e + 2);
    const glm::dvec3 a = corner[e], b = corner[e + 1], c = corner[e + 2], d = corner[(e + 3) % 4];
    return {from, to, {{a, from, to, d}, 4}, {{from, b, c, to}, 4}};
  }
  const glm::dvec3 from = middle(e), to = corner[(e + 2) % 3];
  const glm::dvec3 a = corner[e], b = corner[(e + 1) % 3];
  return {from, to, {{a, from, to}, 3}, {{from, b, to}, 3}};
}

glm::dvec3 twice_area_vector(const Outline3& outline) {
  const auto& c = outline.corner;
  return outline.corners == 4 ? glm::cross(c[2] - c[0], c[3] - c[1]) : glm::cross(c[1] - c[0], c[2] - c[0]);
}

struct Limits {
  std::size_t max_pixels;
  double max_edge;  // [m]
  double finest;    // [m]: of elements no longer than this corners coincide in single precision
};

/// The distance of numbers in single precision at the outline's largest coordinate [m].
double single_spacing(const Outline3& outline) {
  float largest = 0;
  for (std::uint32_t c = 0; c < outline.corners; ++c)
    for (int axis = 0; axis < 3; ++axis)
      largest = std::max(largest, std::abs(static_cast<float>(outline.corner[c][axis])));
  return double{std::nextafter(largest, std::numeric_limits<float>::infinity())} - double{largest};
}

void bisect_node(const Outline3& outline, std::vector<PixelPoint> pixels, const Limits& limits, int depth,
                 std::vector<Leaf>& leaves) {
  const double longest = longest_edge(outline);
  if (pixels.size() <= limits.max_pixels && !is_longer(longest, limits.max_edge)) {
    Leaf leaf{outline, {}, depth};
    std::ranges::transform(pixels, std::back_inserter(leaf.pixels), &PixelPoint::pixel);
    leaves.push_back(std::move(leaf));
    return;
  }
  if (depth == kMaxDepth || longest <= limits.finest)
    throw InputError(
        "the camera's pixels cannot be told apart on a surface in single precision, or --max-edge is too "
        "small "
        "for it (ask for a wider --fov or a smaller --resolution, or move the camera away from the surface)");
  const Division halves = divide(outline, edge_to_bisect(outline));
  const auto on_left = [&, area = twice_area_vector(outline)](const PixelPoint& p) {
    return in_first_half(halves.from, halves.to, area, p.point);
  };
  const auto first_right = std::stable_partition(pixels.begin(), pixels.end(), on_left);
  std::vector<PixelPoint> right_pixels(first_right, pixels.end());
  pixels.erase(first_right, pixels.end());
  bisect_node(halves.left, std::move(pixels), limits, depth + 1, leaves);
  bisect_node(halves.right, std::move(right_pixels), limits, depth + 1, leaves);
}

}  // namespace

bool is_longer(double length, double other) {
  constexpr double kLonger = 1 + 1e-9;
  return length > kLonger * other;
}

std::pair<Outline3, Outline3> bisect(const Outline3& outline) {
  return bisect(outline, edge_to_bisect(outline));
}

std::pair<Outline3, Outline3> bisect(const Outline3& outline, std::uint32_t edge) {
  const Division halves = divide(outline, edge);
  return {halves.left, halves.right};
}

std::uint32_t edge_to_bisect(const Outline3& outline) {
  // The long edges of a parallelogram are the first and third, or the second and fourth.
  std::uint32_t longest = 0;
  for (std::uint32_t edge = 1; edge < (outline.corners == 4 ? 2 : 3); ++edge)
    if (is_longer(edge_length(outline, edge), edge_length(outline, longest))) longest = edge;
  return longest;
}

bool in_first_half(const glm::dvec3& from, const glm::dvec3& to, const glm::dvec3& twice_area,
                   const glm::dvec3& point) {
  const glm::dvec3 to_right = glm::cross(to - from, twice_area);
  return glm::dot(to_right, point - from) <= kOnLine * glm::dot(twice_area, twice_area);
}

HalfPlane first_half(const glm::dvec3& from, const glm::dvec3& to, const glm::dvec3& twice_area) {
  const glm::dvec3 to_right = glm::cross(to - from, twice_area);
  return {to_right, glm::dot(to_right, from) + kOnLine * glm::dot(twice_area, twice_area)};
}

double longest_edge(const Outline3& outline) {
  double longest = 0;
  for (std::uint32_t edge = 0; edge < outline.corners; ++edge)
    longest = std::max(longest, edge_length(outline, edge));
  return longest;
}

double diameter(const Outline3& outline) {
  double largest = longest_edge(outline);
  if (outline.corners == 4) {
    largest = std::max(largest, glm::distance(outline.corner[0], outline.corner[2]));
    largest = std::max(largest, glm::distance(outline.corner[1], outline.corner[3]));
  }
  return largest;
}

double area(const Outline3& outline) { return 0.5 * glm::length(twice_area_vector(outline)); }

glm::dvec3 centroid(const Outline3& outline) {
  glm::dvec3 sum(0);
  for (std::uint32_t c = 0; c < outline.corners; ++c) sum += outline.corner[c];
  return sum / static_cast<double>(outline.corners);
}

void bisect_until(const Outline3& root, std::vector<PixelPoint> pixels, std::size_t max_pixels,
                  double max_edge, std::vector<Leaf>& leaves) {
  bisect_node(root, std::move(pixels), {max_pixels, max_edge, single_spacing(root)}, 0, leaves);
}

int step_bound(const Outline3& root, double spacing) {
  const double shrink = std::log(spacing / diameter(root));
  if (shrink > 0) return 0;
  // A node as wide as the spacing is still too wide, hence one step more than the equation gives.
  if (root.corners == 4) return static_cast<int>(std::floor(shrink / (0.5 * std::log(5.0 / 8.0)))) + 1;
  return 2 * (static_cast<int>(std::floor(shrink / (0.5 * std::log(3.0 / 4.0)))) + 1);
}

}  // namespace fluxel
