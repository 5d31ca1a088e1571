#include "bench/stability/lit_rooms.hpp"

#include <random>

#include "bench/stability/rooms.hpp"

namespace fluxel::lab {

namespace {

constexpr double kRho = 0.5;
constexpr double kDoorWidth = 0.4, kDoorHeight = 0.8, kWall = 0.2;
constexpr double kLamp = 0.5;

using Vector = glm::dvec3;

double uniform(std::mt19937_64& random) { return static_cast<double>(random() >> 11) * 0x1p-53; }

/// The normal is along a x b.
void add_rectangle(SceneInput& input, const std::string& group, const Vector& corner, const Vector& a,
                   const Vector& b) {
  add_polygon(input, group, kRho, 0, {corner, corner + a, corner + a + b, corner + b});
}

/// From `from` to `to` along a and along b, as fractions of them.
struct Opening {
  double from_a, to_a, from_b, to_b;
};

/// What an opening leaves of a rectangle.
void add_frame(SceneInput& input, const Vector& corner, const Vector& a, const Vector& b,
               const Opening& opening) {
  const auto add = [&](double from_a, double to_a, double from_b, double to_b) {
    if (from_a < to_a && from_b < to_b)
      add_rectangle(input, "room", corner + from_a * a + from_b * b, (to_a - from_a) * a,
                    (to_b - from_b) * b);
  };
  add(0, opening.from_a, 0, 1);
  add(opening.to_a, 1, 0, 1);
  add(opening.from_a, opening.to_a, 0, opening.from_b);
  add(opening.from_a, opening.to_a, opening.to_b, 1);
}

/// A ceiling's part with a lamp in its middle.
void add_lit_ceiling(SceneInput& input, const std::string& lamp, const Vector& corner, const Vector& a,
                     const Vector& b) {
  const double half_a = 0.5 * kLamp / glm::length(a), half_b = 0.5 * kLamp / glm::length(b);
  add_frame(input, corner, a, b, {0.5 - half_a, 0.5 + half_a, 0.5 - half_b, 0.5 + half_b});
  add_rectangle(input, lamp, corner + (0.5 - half_a) * a + (0.5 - half_b) * b, 2 * half_a * a,
                2 * half_b * b);
}

void add_ceiling_with_lamps(SceneInput& input, const Vector& corner, const Vector& a, const Vector& b) {
  add_lit_ceiling(input, "lamp", corner, a, 0.5 * b);
  add_lit_ceiling(input, "second lamp", corner + 0.5 * b, a, 0.5 * b);
}

/// What is alike in all of them: floor and the two walls along x.
void add_floor_and_sides(SceneInput& input, const Vector& corner, const Vector& size) {
  const Vector x{size.x, 0, 0}, y{0, size.y, 0}, z{0, 0, size.z};
  add_rectangle(input, "room", corner, x, y);
  add_rectangle(input, "room", corner, z, x);
  add_rectangle(input, "room", corner + y, x, z);
}

void add_one_room(SceneInput& input, const Vector& size) {
  const Vector x{size.x, 0, 0}, y{0, size.y, 0}, z{0, 0, size.z};
  add_floor_and_sides(input, Vector(0), size);
  add_ceiling_with_lamps(input, z, y, x);
  add_rectangle(input, "room", Vector(0), y, z);
  add_rectangle(input, "room", x, z, y);
}

void add_boxes(SceneInput& input, const Vector& room) {
  constexpr int kAlong = 4, kAcross = 3;
  std::mt19937_64 random(1);
  for (int i = 0; i < kAlong; ++i) {
    for (int j = 0; j < kAcross; ++j) {
      const Vector cell{room.x / kAlong, room.y / kAcross, room.z};
      const Vector size = cell * Vector(0.2 + 0.3 * uniform(random), 0.2 + 0.3 * uniform(random),
                                        0.15 + 0.5 * uniform(random));
      const Vector low =
          cell * Vector(i, j, 0) + (cell - size) * Vector(uniform(random), uniform(random), 0.1);
      add_box(input, "boxes", kRho, 0, low, low + size, true);
    }
  }
}

void add_two_rooms(SceneInput& input, const Vector& size) {
  const Vector y{0, size.y, 0}, z{0, 0, size.z}, second{size.x + kWall, 0, 0};
  add_floor_and_sides(input, Vector(0), size);
  add_floor_and_sides(input, second, size);
  add_ceiling_with_lamps(input, z, y, {size.x, 0, 0});
  add_rectangle(input, "room", second + z, y, {size.x, 0, 0});
  add_rectangle(input, "room", Vector(0), y, z);
  add_rectangle(input, "room", second + Vector(size.x, 0, 0), z, y);

  const double left = 0.5 * (size.y - kDoorWidth), right = left + kDoorWidth;
  const Opening door{left / size.y, right / size.y, 0, kDoorHeight / size.z};
  add_frame(input, {size.x, 0, 0}, z, y, {door.from_b, door.to_b, door.from_a, door.to_a});
  add_frame(input, second, y, z, door);
  const Vector through{kWall, 0, 0}, across{0, kDoorWidth, 0}, up{0, 0, kDoorHeight}, at{size.x, left, 0};
  add_rectangle(input, "door", at, through, across);
  add_rectangle(input, "door", at + up, across, through);
  add_rectangle(input, "door", at, up, through);
  add_rectangle(input, "door", at + across, through, up);
}

}  // namespace

Setup lit_room(LitRoom room, double max_edge) {
  constexpr Vector kSmall{4, 4, 3}, kLarge{10, 8, 3};
  Setup setup;
  setup.subdivision = Subdivision::uniform;
  setup.max_edge = max_edge;
  switch (room) {
    case LitRoom::box:
      add_one_room(setup.input, kSmall);
      break;
    case LitRoom::cluttered:
      add_one_room(setup.input, kLarge);
      add_boxes(setup.input, kLarge);
      break;
    case LitRoom::two_rooms:
      add_two_rooms(setup.input, kSmall);
      break;
  }
  return setup;
}

void light(const Prepared& room, const std::string& group, const Rgb& E, Unknowns& unknowns) {
  for (std::size_t i = 0; i < unknowns.size(); ++i) {
    const Patch& patch = room.scene.patch(room.mesh.elements[i % unknowns.elements].patch);
    const bool lit = unknowns.area[i] > 0 && room.scene.groups[index(patch.group)] == group;
    unknowns.E[i] = lit ? E : Rgb(0);
  }
}

void set_reflectance(double rho, Unknowns& unknowns) {
  for (std::size_t i = 0; i < unknowns.size(); ++i) unknowns.rho[i] = Rgb(unknowns.area[i] > 0 ? rho : 0);
}

void mix_reflectances(const Prepared& room, double least, double most, Unknowns& unknowns) {
  for (std::size_t i = 0; i < unknowns.size(); ++i) {
    if (unknowns.area[i] == 0) continue;
    std::mt19937_64 random(index(room.mesh.elements[i % unknowns.elements].patch));
    for (int c = 0; c < kChannels; ++c) unknowns.rho[i][c] = least + (most - least) * uniform(random);
  }
}

}  // namespace fluxel::lab
