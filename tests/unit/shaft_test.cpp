#include "visibility/shaft.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <glm/vec4.hpp>
#include <numbers>
#include <random>
#include <stdexcept>
#include <utility>
#include <vector>

#include "scene/polygon.hpp"
#include "tests/unit/test_scenes.hpp"

namespace fluxel {
namespace {

using test_scenes::random_direction;
using test_scenes::uniform;
using test_scenes::uniform_point;
using Outline3 = Outline<glm::dvec3>;

constexpr double kEpsilon = 1e-9;

/// Corners at random places on a circle of random place, size and direction.
Polygon random_disc_polygon(std::mt19937& random) {
  std::vector<double> angle(3 + random() % 6);
  for (double& x : angle) x = uniform(random, 0, 2 * std::numbers::pi);
  std::ranges::sort(angle);
  const double radius = uniform(random, 0.1, 0.6);
  const glm::dvec3 centre = uniform_point(random, -1, 1), u = random_direction(random);
  const glm::dvec3 v = glm::normalize(glm::cross(u, random_direction(random)));
  Polygon polygon;
  for (const double x : angle) polygon.push_back(centre + radius * (std::cos(x) * u + std::sin(x) * v));
  return polygon;
}

bool on_one_side(const Polygon& a, const Polygon& b) {
  const auto height = [&](const glm::dvec3& x) { return glm::dot(area_vector(a), x - a[0]); };
  return std::ranges::all_of(b, [&](const auto& x) { return height(x) > -1e-12; }) ||
         std::ranges::all_of(b, [&](const auto& x) { return height(x) < 1e-12; });
}

enum class Contact { none, corner, edge };

std::pair<Polygon, Polygon> random_pair(std::mt19937& random, Contact contact = Contact::none) {
  for (;;) {
    const Polygon a = random_disc_polygon(random);
    Polygon b = random_disc_polygon(random);
    const glm::dvec3 to_corner = a[0] - b[1];
    if (contact == Contact::corner) {
      for (glm::dvec3& x : b) x += to_corner;
    } else if (contact == Contact::edge) {
      b = {a[1], a[0], a[0] + to_corner, a[1] + to_corner};
    }
    if (on_one_side(a, b) && on_one_side(b, a)) return {a, b};
  }
}

Outline3 random_patch(std::mt19937& random, double size, const Box& about) {
  const glm::dvec3 at = about.low + uniform_point(random, 0, 1) * (about.high - about.low);
  const glm::dvec3 u = size * random_direction(random), v = size * random_direction(random);
  if (random() % 2 == 0) return {{at, at + u, at + v}, 3};
  return {{at, at + u, at + u + v, at + v}, 4};
}

/// A random mean of the points, often near the surface of their hull.
glm::dvec3 random_mean(PolygonView points, std::mt19937& random) {
  glm::dvec4 sum(0);
  for (const glm::dvec3& x : points) sum += std::pow(uniform(random, 1e-3, 1), 4) * glm::dvec4(x, 1);
  return glm::dvec3(sum) / sum.w;
}

std::vector<Segment> random_segments(PolygonView a, PolygonView b, std::mt19937& random) {
  std::vector<Segment> segments(50);
  for (Segment& segment : segments) segment = {random_mean(a, random), random_mean(b, random)};
  return segments;
}

bool hits(const Segment& segment, const Outline3& patch) {
  const glm::dvec3 u = patch.corner[1] - patch.corner[0];
  const glm::dvec3 v = patch.corner[patch.corners - 1] - patch.corner[0];
  const glm::dmat3 to_segment(u, v, segment.from - segment.to);
  const glm::dvec3 x = glm::inverse(to_segment) * (segment.from - patch.corner[0]);
  const bool within = patch.corners == 3 ? x.x + x.y < 1 : x.x < 1 && x.y < 1;
  return x.x > 0 && x.y > 0 && within && x.z > 0 && x.z < 1;
}

/// The hull of points by the planes through any three of them that have all others in front.
std::vector<Plane> facets(PolygonView points) {
  std::vector<Plane> hull;
  const auto add = [&](const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
    const glm::dvec3 normal = glm::cross(b - a, c - a);
    const Plane plane{a, glm::normalize(normal)};
    const auto in_front = [&](const glm::dvec3& x) { return plane.distance(x) > -1e-12; };
    if (glm::length(normal) > 1e-9 && std::ranges::all_of(points, in_front)) hull.push_back(plane);
  };
  for (const glm::dvec3& a : points)
    for (const glm::dvec3& b : points)
      for (const glm::dvec3& c : points) add(a, b, c);
  return hull;
}

/// True where one of the points spread evenly over the patch lies deeper than epsilon in the hull.
bool enters(const std::vector<Plane>& hull, const Outline3& patch) {
  constexpr int kSteps = 32;
  const glm::dvec3 u = (patch.corner[1] - patch.corner[0]) / double{kSteps};
  const glm::dvec3 v = (patch.corner[patch.corners - 1] - patch.corner[0]) / double{kSteps};
  for (int i = 0; i <= kSteps; ++i) {
    for (int j = 0; j <= (patch.corners == 3 ? kSteps - i : kSteps); ++j) {
      const glm::dvec3 x = patch.corner[0] + double(i) * u + double(j) * v;
      const auto deep = [&](const Plane& plane) { return plane.distance(x) > kEpsilon; };
      if (std::ranges::all_of(hull, deep)) return true;
    }
  }
  return false;
}

/// May-meet answers against sampled segments and points.
struct Tally {
  int hit = 0;      // patches that a segment or a sampled point shows in the hull
  int missed = 0;   // of those, called free
  int clear = 0;    // patches without any sampled point in the hull
  int doubted = 0;  // of those, not called free

  void add(const Shaft& shaft, PolygonView a, PolygonView b, double size, std::mt19937& random) {
    Polygon points(a.begin(), a.end());
    points.insert(points.end(), b.begin(), b.end());
    const std::vector<Plane> hull = facets(points);
    const std::vector<Segment> segments = random_segments(a, b, random);
    for (int k = 0; k < 20; ++k) {
      const Outline3 patch = random_patch(random, size, bounds(points));
      const bool meets = shaft.may_meet(patch, kEpsilon);
      const auto hit_by = [&](const Segment& segment) { return hits(segment, patch); };
      if (std::ranges::any_of(segments, hit_by) || enters(hull, patch)) {
        ++hit;
        missed += meets ? 0 : 1;
        continue;
      }
      ++clear;
      doubted += meets ? 1 : 0;
    }
  }

  void expect_sharp() const {
    EXPECT_GT(hit, 200);
    EXPECT_GT(clear, 300);
    EXPECT_EQ(missed, 0);
    EXPECT_LT(doubted, 0.025 * clear);  // corners that reach in between the sampled points
  }
};

TEST(Shaft, OfPolygonsIsTheirHull) {
  std::mt19937 random(1);
  for (const Contact contact : {Contact::none, Contact::corner, Contact::edge}) {
    for (const double size : {0.1, 0.5}) {
      Tally tally;
      for (int k = 0; k < 100; ++k) {
        const auto [a, b] = random_pair(random, contact);
        tally.add(Shaft(a, b), a, b, size, random);
      }
      tally.expect_sharp();
    }
  }
}

TEST(Shaft, OfBoxesIsTheirHull) {
  std::mt19937 random(2);
  Tally tally;
  for (int k = 0; k < 200; ++k) {
    Box box[2];
    Polygon corner[2];
    for (int i : {0, 1}) {
      box[i].low = uniform_point(random, -1, 0.5);
      box[i].high = box[i].low + uniform_point(random, 0.05, 0.5);
      if (k % 4 == 0) box[i].high[k / 4 % 3] = box[i].low[k / 4 % 3];
      for (int c = 0; c < 8; ++c)
        corner[i].push_back(glm::mix(box[i].low, box[i].high, glm::dvec3(c & 1, c >> 1 & 1, c >> 2)));
    }
    tally.add(Shaft(box[0], box[1]), corner[0], corner[1], 0.1, random);
  }
  tally.expect_sharp();
}

TEST(Shaft, BlockingPatchesStopEverySegment) {
  std::mt19937 random(4);
  int blocked = 0;
  for (int k = 0; k < 1000; ++k) {
    const auto [a, b] = random_pair(random);
    const Shaft shaft(a, b);
    const std::vector<Segment> segments = random_segments(a, b, random);
    for (int i = 0; i < 20; ++i) {
      const Outline3 patch = random_patch(random, 2, {glm::dvec3(-1), glm::dvec3(1)});
      const bool blocks = shaft.blocks(patch, kEpsilon);
      const auto hit = [&](const Segment& segment) { return hits(segment, patch); };
      bool all_corners = true;
      for (const glm::dvec3& x : a)
        for (const glm::dvec3& y : b) all_corners = all_corners && hit({x, y});
      EXPECT_EQ(blocks, all_corners);
      EXPECT_TRUE(!blocks || (std::ranges::all_of(segments, hit) && shaft.may_meet(patch, kEpsilon)));
      blocked += blocks ? 1 : 0;
    }
  }
  EXPECT_GT(blocked, 200);
}

/// The unit square of the corner (x, y, z), its edges along two axes.
Polygon square(const glm::dvec3& corner, int u, int v) {
  glm::dvec3 along_u(0), along_v(0);
  along_u[u] = along_v[v] = 1;
  return {corner, corner + along_u, corner + along_u + along_v, corner + along_v};
}

Outline3 outline(const Polygon& polygon) { return {{polygon[0], polygon[1], polygon[2], polygon[3]}, 4}; }

const Polygon kFloor = square({0, 0, 0}, 0, 1);
const Polygon kCeiling = square({0, 0, 1}, 1, 0);
const Polygon kWall = square({0, 0, 0}, 1, 2);  // shares the edge x = z = 0 with the floor

TEST(Shaft, SeesNothingWithinEpsilonOfItsSurface) {
  constexpr double kLarge = 1e-6;
  const Shaft shaft(kFloor, kCeiling);
  for (const double z : {0.0, 0.5e-6, 2e-6, 0.5, 1 - 2e-6, 1 - 0.5e-6, 1.0, 1.5}) {
    const bool between = z > kLarge && z < 1 - kLarge;
    const Outline3 sheet = outline(square({0, 0, z}, 0, 1));
    EXPECT_EQ(shaft.may_meet(sheet, kLarge), between) << z;
    EXPECT_EQ(shaft.blocks(sheet, kLarge), between) << z;
  }
  for (const double x : {-1.0, -0.5, 0.0, 0.5, 1 - 2e-6, 1 - 0.5e-6, 1.0}) {
    const Outline3 level = outline(square({x, 0, 0.5}, 0, 1)), upright = outline(square({x, 0, 0}, 1, 2));
    EXPECT_EQ(shaft.may_meet(level, kLarge), x > -1 && x < 1 - kLarge) << x;
    EXPECT_EQ(shaft.may_meet(upright, kLarge), x > 0 && x < 1 - kLarge) << x;
  }
}

TEST(Shaft, OfSquaresWithACommonEdgeIsAWedge) {
  const Shaft shaft(kFloor, kWall);
  EXPECT_FALSE(shaft.may_meet(outline(kFloor), kEpsilon));
  EXPECT_FALSE(shaft.may_meet(outline(kWall), kEpsilon));
  EXPECT_FALSE(shaft.may_meet(outline(square({-1, -1, 0}, 0, 1)), kEpsilon));
  EXPECT_FALSE(shaft.may_meet(outline(square({0, 1, 0}, 0, 2)), kEpsilon));  // edges with both
  EXPECT_FALSE(shaft.may_meet(outline(square({1, 0, 0}, 1, 2)), kEpsilon));  // an edge with the floor
  EXPECT_FALSE(shaft.may_meet(outline(kCeiling), kEpsilon));                 // an edge with the wall
  EXPECT_FALSE(shaft.may_meet(outline({{1, 0, 0}, {1, 1, 0}, {0, 1, 1}, {0, 0, 1}}), kEpsilon));
  // A sheet on the bisector, from the common edge on, cuts off all light; a shorter one not all.
  EXPECT_TRUE(shaft.blocks(outline({{0, 0, 0}, {0.5, 0, 0.5}, {0.5, 1, 0.5}, {0, 1, 0}}), kEpsilon));
  const Outline3 shorter = outline({{0, 0, 0}, {0.4, 0, 0.4}, {0.4, 1, 0.4}, {0, 1, 0}});
  EXPECT_FALSE(shaft.blocks(shorter, kEpsilon));
  EXPECT_TRUE(shaft.may_meet(shorter, kEpsilon));
}

Polygon turned(Polygon polygon, const glm::dquat& rotation) {
  for (glm::dvec3& x : polygon) x = rotation * x;
  return polygon;
}

TEST(Shaft, CommonCornersAreNoDirections) {
  std::mt19937 random(5);
  const Polygon floor{{1, 0, 0}, {0, 0, 0}, {0, 1, 0}, {1, 1, 0}};
  const Polygon leaning{{0.2, -1, 1}, {0, 0, 0}, {-0.6, -0.4, 1}};
  const Polygon outside{{0.5, -0.6, 0.3}, {0.6, -0.5, 0.3}, {0.7, -0.5, 0.2}, {0.6, -0.6, 0.2}};  // y + z < 0
  for (int k = 0; k < 100; ++k) {
    const glm::dquat rotation = by_hand::random_rotation(random);
    const Shaft shaft(turned(floor, rotation), turned(leaning, rotation));
    EXPECT_FALSE(shaft.may_meet(outline(turned(outside, rotation)), kEpsilon));
  }
}

TEST(Shaft, WallBetweenTwoRoomsBlocksInEveryDirection) {
  std::mt19937 random(6);
  // A floor square at the wall's foot, and squares beyond it, one on a side wall that the wall ends at.
  const Polygon beyond = square({1, 0, 0}, 0, 2), away = square({2, 0, 1}, 0, 1);
  for (int k = 0; k < 100; ++k) {
    const glm::dquat rotation = by_hand::random_rotation(random);
    const auto wall = [&](double gap) {
      return outline(turned({{1, gap, 0}, {1, 1, 0}, {1, 1, 1}, {1, gap, 1}}, rotation));
    };
    for (const Polygon& other : {beyond, away}) {
      const Shaft shaft(turned(kFloor, rotation), turned(other, rotation));
      EXPECT_TRUE(shaft.may_meet(wall(0), kEpsilon));
      EXPECT_TRUE(shaft.blocks(wall(0), kEpsilon));
      EXPECT_TRUE(shaft.blocks(wall(0.5e-9), kEpsilon));
      EXPECT_FALSE(shaft.blocks(wall(2e-9), kEpsilon));
    }
  }
}

TEST(Shaft, TakesPolygonsOfThreeToEightCorners) {
  const Polygon line(2), nine(9);
  EXPECT_THROW(Shaft(line, kCeiling), std::logic_error);
  EXPECT_THROW(Shaft(kFloor, nine), std::logic_error);
}

}  // namespace
}  // namespace fluxel
