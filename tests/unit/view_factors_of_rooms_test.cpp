#include <gtest/gtest.h>

#include <cstdlib>
#include <numbers>
#include <string>

#include "tests/unit/random_rooms.hpp"

/// View factors of random rooms: what holds for every scene.
namespace fluxel {
namespace {

/// Fronts that rays from a front's points see, drawn evenly and with Lambert's cosine, as exchange areas with
/// their standard errors. Each ray is tested against all polygons, in double precision: nothing is shared
/// with what is tested.
class RayCounts {
 public:
  RayCounts(const random_rooms::Room& room, std::size_t from, std::size_t rays, std::mt19937& random)
      : rays_(rays), hits_(room.polygons.size(), 0) {
    const closed_forms::Polygon& polygon = room.polygons[from];
    const glm::dvec3 u = polygon[1] - polygon[0], v = polygon[3] - polygon[0];  // a parallelogram
    area_ = glm::length(glm::cross(u, v));
    const glm::dvec3 normal = glm::cross(u, v) / area_, x = glm::normalize(u), y = glm::cross(normal, x);
    for (std::size_t k = 0; k < rays; ++k) {
      const glm::dvec3 start =
          polygon[0] + test_scenes::uniform(random, 0, 1) * u + test_scenes::uniform(random, 0, 1) * v;
      const double square = test_scenes::uniform(random, 0, 1);
      const double angle = test_scenes::uniform(random, 0, 2 * std::numbers::pi);
      const double sine = std::sqrt(square);
      const glm::dvec3 way =
          sine * std::cos(angle) * x + sine * std::sin(angle) * y + std::sqrt(1 - square) * normal;
      if (const std::size_t hit = first_front(room, start, way, from); hit < hits_.size()) ++hits_[hit];
    }
  }

  [[nodiscard]] double exchange(std::size_t to) const {
    return area_ * static_cast<double>(hits_[to]) / static_cast<double>(rays_);
  }

  /// Where none or all hit, by the rule of succession: not 0.
  [[nodiscard]] double error(std::size_t to) const {
    const double count = static_cast<double>(rays_);
    const double part = (static_cast<double>(hits_[to]) + 1) / (count + 2);
    return area_ * std::sqrt(part * (1 - part) / count);
  }

 private:
  static std::size_t first_front(const random_rooms::Room& room, const glm::dvec3& start,
                                 const glm::dvec3& way, std::size_t from) {
    const double touching = 1e-7 * room.size;
    std::size_t found = room.polygons.size();
    double front = test_scenes::kUnbounded, back = test_scenes::kUnbounded;
    for (std::size_t k = 0; k < room.polygons.size(); ++k) {
      if (k == from) continue;
      const closed_forms::Polygon& polygon = room.polygons[k];
      const glm::dvec3 u = polygon[1] - polygon[0], v = polygon[3] - polygon[0], normal = glm::cross(u, v);
      const double down = glm::dot(normal, way);
      const double distance = glm::dot(normal, polygon[0] - start) / down;
      if (!(std::abs(down) > 0) || distance < -touching) continue;
      const glm::dvec3 place = start + distance * way - polygon[0];
      const double square = glm::dot(normal, normal);
      const double s = glm::dot(glm::cross(place, v), normal) / square;
      const double t = glm::dot(glm::cross(u, place), normal) / square;
      if (s < 0 || s > 1 || t < 0 || t > 1) continue;
      // What covers the start, such as the bottom of a box on the floor, hides all else.
      if (distance <= touching) return room.polygons.size();
      if (down > 0) {
        back = std::min(back, distance);
      } else if (distance < front) {
        front = distance;
        found = k;
      }
    }
    // Behind the side of a box that touches a wall nobody sees the wall.
    if (!(front < back - touching)) return room.polygons.size();
    return found;
  }

  std::size_t rays_;
  std::vector<std::size_t> hits_;
  double area_ = 0;  // [m2]
};

struct Exchanges {
  std::vector<SurfaceExchange> list;
  std::vector<double> areas;  // of surfaces [m2]

  Exchanges(const random_rooms::Room& room, bool cut) {
    const Scene scene = room.scene(cut);
    const RayScene ray_scene(scene, 1);
    const FacePairs pairs(ray_scene, scene, 1e-3);
    for (std::size_t row = 0; row < pairs.rows(); ++row)
      for (const SurfaceExchange& entry : pairs.examine_row(row).list) list.push_back(entry);
    list = sum_by_surfaces(std::move(list));
    areas = pairs.surface_areas();
  }

  [[nodiscard]] SurfaceExchange between(std::size_t one, std::size_t other) const {
    const std::uint32_t from = surface_of(static_cast<std::uint32_t>(std::min(one, other)), false);
    const std::uint32_t to = surface_of(static_cast<std::uint32_t>(std::max(one, other)), false);
    for (const SurfaceExchange& entry : list)
      if (entry.from == from && entry.to == to) return entry;
    return {from, to, 0, 0, 0};
  }
};

void check_row_sums(const random_rooms::Room& room, const Exchanges& found, const std::string& where) {
  std::vector<SurfaceExchange> sums(found.areas.size());
  for (const SurfaceExchange& entry : found.list) {
    sums[entry.from] += entry;
    sums[entry.to] += entry;
  }
  for (std::size_t group = 0; group < room.polygons.size(); ++group) {
    const std::size_t surface = surface_of(static_cast<std::uint32_t>(group), false);
    if (found.areas[surface] == 0) continue;
    const double allowed = sums[surface].error + 4 * sums[surface].deviation + 1e-6 * found.areas[surface];
    EXPECT_NEAR(sums[surface].G, found.areas[surface], allowed) << where << ", row of " << room.names[group];
  }
}

void check_against_rays(const random_rooms::Room& room, const Exchanges& found, const std::string& where,
                        std::mt19937& random) {
  const std::size_t from = random() % room.polygons.size();
  const RayCounts rays(room, from, 4000, random);
  for (std::size_t to = 0; to < room.polygons.size(); ++to) {
    if (to == from) continue;
    const SurfaceExchange entry = found.between(from, to);
    const double deviation = std::hypot(rays.error(to), double{entry.deviation});
    // Of some hundred comparisons 5 errors are passed by chance in one run of ten thousand.
    EXPECT_NEAR(entry.G, rays.exchange(to), 5 * deviation + entry.error)
        << where << ", " << room.names[from] << " to " << room.names[to];
    const double free =
        closed_forms::polygon_to_polygon(room.polygons[from], room.polygons[to]) * area(room.polygons[from]);
    EXPECT_LE(entry.G, free + entry.error + 1e-6 * free) << where << ", more than nothing hides";
  }
}

/// A variable of the environment may ask for others than the first 20.
unsigned rooms_asked_for(const char* variable, unsigned otherwise) {
  const char* const text = std::getenv(variable);
  return text == nullptr ? otherwise : static_cast<unsigned>(std::stoul(text));
}

TEST(RandomViewFactors, HoldInEveryRoom) {
  const unsigned first = rooms_asked_for("FLUXEL_FIRST_ROOM", 0);
  const unsigned rooms = rooms_asked_for("FLUXEL_ROOMS", 20);
  for (unsigned seed = first; seed < first + rooms; ++seed) {
    std::mt19937 random(seed);
    const random_rooms::Room room(random);
    const bool cut = seed % 4 != 3;
    const std::string where = "room " + std::to_string(seed) + (cut ? "" : ", not cut");
    const Exchanges found(room, cut);
    if (room.closed) check_row_sums(room, found, where);
    check_against_rays(room, found, where, random);
  }
}

}  // namespace
}  // namespace fluxel
