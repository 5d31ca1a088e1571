#include "bench/gpu_check/scenes.hpp"

#include <algorithm>
#include <cmath>

#include "bench/gpu_check/chance.hpp"

namespace fluxel::cuda::checks {

namespace {

Double3 normal_of(const Double3& u, const Double3& v) {
  const Double3 n = cross(u, v);
  return 1 / length(n) * n;
}

Face face_of(const Double3& corner, const Double3& u, const Double3& v) {
  return {corner, u, v, normal_of(u, v)};
}

ExactPatch triangle(const Double3& a, const Double3& b, const Double3& c) {
  return {{a, b, c, c}, normal_of(b - a, c - a), 3};
}

void add_patches(const Face& face, Outlines outlines, std::vector<ExactPatch>& patches) {
  const Double3 a = face.corner, b = a + face.u, c = b + face.v, d = a + face.v;
  if (outlines == Outlines::parallelograms) {
    patches.push_back({{a, b, c, d}, face.normal, 4});
  } else {
    patches.push_back({{a, b, c, c}, face.normal, 3});
    patches.push_back({{a, c, d, d}, face.normal, 3});
  }
}

/// Six faces, which look outwards or inwards.
void add_box(const Double3& low, const Double3& size, bool outwards, std::vector<Face>& faces) {
  const Double3 edge[3] = {{size.x, 0, 0}, {0, size.y, 0}, {0, 0, size.z}};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const Double3 &u = edge[(axis + 1) % 3], &v = edge[(axis + 2) % 3];
    faces.push_back(outwards ? face_of(low, v, u) : face_of(low, u, v));
    faces.push_back(outwards ? face_of(low + edge[axis], u, v) : face_of(low + edge[axis], v, u));
  }
}

void set_extent(CheckScene& scene) {
  double extent = 0;
  for (const ExactPatch& patch : scene.patches)
    for (const Double3& x : patch.corner)
      extent = std::max({extent, std::fabs(x.x), std::fabs(x.y), std::fabs(x.z)});
  scene.extent = static_cast<float>(extent);
  // About as much as in the program's scenes; a power of two keeps a lattice's points on a lattice.
  scene.lift = std::ldexp(1.0f, std::ilogb(2e-6f * scene.extent));
}

/// Bits of the place along each axis in turn, so that what follows each other is near (Morton, A computer
/// oriented geodetic data base, 1966).
std::uint64_t curve_place(const std::uint32_t (&cell)[3]) {
  std::uint64_t place = 0;
  for (std::uint32_t bit = 0; bit < 16; ++bit)
    for (std::uint32_t axis = 0; axis < 3; ++axis)
      place |= std::uint64_t{cell[axis] >> bit & 1u} << (3 * bit + axis);
  return place;
}

struct Cell {
  std::uint32_t at[3];
};

/// Cells of a regular division of the room, along the curve, and how many there are along each axis.
std::vector<Cell> cells_for(const Boxes& boxes, const Double3& room, std::uint32_t (&counts)[3]) {
  const double in_layer = std::ceil(static_cast<double>(boxes.count) / boxes.layers);
  counts[0] = static_cast<std::uint32_t>(std::ceil(std::sqrt(in_layer * room.x / room.y)));
  counts[1] = static_cast<std::uint32_t>(std::ceil(in_layer / counts[0]));
  counts[2] = boxes.layers;
  std::vector<Cell> cells;
  for (std::uint32_t z = 0; z < counts[2]; ++z)
    for (std::uint32_t y = 0; y < counts[1]; ++y)
      for (std::uint32_t x = 0; x < counts[0]; ++x) cells.push_back({{x, y, z}});
  std::sort(cells.begin(), cells.end(),
            [](const Cell& a, const Cell& b) { return curve_place(a.at) < curve_place(b.at); });
  cells.resize(boxes.count);
  return cells;
}

void add_elements(const Face& face, std::size_t count, std::uint32_t sides, std::vector<End>& ends) {
  if (count == 0) return;
  if (count == 1) {
    const Double3 middle = face.corner + 0.5 * (face.u + face.v);
    ends.push_back({narrow(middle), sides, narrow(face.normal), 0});
    return;
  }
  const std::size_t before = count / 2;
  const double share = static_cast<double>(before) / static_cast<double>(count);
  Face first = face, second = face;
  const bool along_u = length(face.u) >= length(face.v);
  Double3 &shorter = along_u ? first.u : first.v, &rest = along_u ? second.u : second.v;
  shorter = share * shorter;
  second.corner = face.corner + shorter;
  rest = (1 - share) * rest;
  add_elements(first, before, sides, ends);
  add_elements(second, count - before, sides, ends);
}

/// Of the sheets between floor and ceiling [m], whose cells are a power of two.
constexpr std::size_t kCells = 64;
constexpr double kSheetSide = 8, kStep = kSheetSide / kCells;

CheckScene floor_and_ceiling(const char* name) {
  CheckScene scene;
  scene.name = name;
  scene.sees_nothing = true;
  scene.faces.push_back(face_of({0, 0, 0}, {kSheetSide, 0, 0}, {0, kSheetSide, 0}));
  scene.faces.push_back(face_of({0, 0, kSheetSide}, {0, kSheetSide, 0}, {kSheetSide, 0, 0}));
  return scene;
}

}  // namespace

CheckScene room_with(const Boxes& boxes, Outlines outlines) {
  CheckScene scene;
  scene.name =
      "room-" + std::to_string(boxes.count) + (outlines == Outlines::triangles ? "" : " (4 corners)");
  const Double3 room{10, 8, 3};
  add_box({0, 0, 0}, room, false, scene.faces);
  Chance chance;
  const auto share = [&] { return chance.between(boxes.most_of_cell / 3, boxes.most_of_cell); };
  std::uint32_t counts[3];
  for (const Cell& cell : cells_for(boxes, room, counts)) {
    const Double3 step{room.x / counts[0], room.y / counts[1], room.z / counts[2]};
    const Double3 size{step.x * share(), step.y * share(), step.z * share()};
    const Double3 low{step.x * cell.at[0] + (step.x - size.x) * chance.between(0.02, 0.98),
                      step.y * cell.at[1] + (step.y - size.y) * chance.between(0.02, 0.98),
                      step.z * cell.at[2] + 0.002};
    add_box(low, size, true, scene.faces);
  }
  for (const Face& face : scene.faces) add_patches(face, outlines, scene.patches);
  set_extent(scene);
  return scene;
}

CheckScene closed_sheet(double bumps) {
  CheckScene scene = floor_and_ceiling(bumps == 0 ? "flat sheet" : "bumpy sheet");
  Chance chance;
  std::vector<Double3> corner;
  for (std::size_t y = 0; y <= kCells; ++y)
    for (std::size_t x = 0; x <= kCells; ++x)
      corner.push_back({static_cast<double>(x) * kStep, static_cast<double>(y) * kStep,
                        kSheetSide / 2 + chance.between(-bumps, bumps)});
  for (std::size_t y = 0; y < kCells; ++y) {
    for (std::size_t x = 0; x < kCells; ++x) {
      const std::size_t at = y * (kCells + 1) + x, above = at + kCells + 1;
      scene.patches.push_back(triangle(corner[at], corner[at + 1], corner[above + 1]));
      scene.patches.push_back(triangle(corner[at], corner[above + 1], corner[above]));
    }
  }
  set_extent(scene);
  return scene;
}

CheckScene mixed_sheet() {
  CheckScene scene = floor_and_ceiling("mixed sheet");
  Chance chance;
  for (std::size_t y = 0; y < kCells; ++y) {
    for (std::size_t x = 0; x < kCells; ++x) {
      const Double3 low{static_cast<double>(x) * kStep, static_cast<double>(y) * kStep, kSheetSide / 2};
      if ((x + y) % 2 == 0) {
        add_patches(face_of(low, {kStep, 0, 0}, {0, kStep, 0}),
                    chance.between(0, 1) < 0.5 ? Outlines::parallelograms : Outlines::triangles,
                    scene.patches);
        continue;
      }
      const Double3 corner[4] = {low, low + Double3{kStep, 0, 0}, low + Double3{kStep, kStep, 0},
                                 low + Double3{0, kStep, 0}};
      const auto off = [&] { return kStep * chance.between(0.3, 0.7); };
      const double along_x = off(), along_y = off();
      const Double3 middle = low + Double3{along_x, along_y, kStep * chance.between(-0.5, 0.5)};
      for (std::size_t c = 0; c < 4; ++c)
        scene.patches.push_back(triangle(corner[c], corner[(c + 1) % 4], middle));
    }
  }
  set_extent(scene);
  return scene;
}

CheckScene random_plates() {
  CheckScene scene;
  scene.name = "random plates";
  scene.sides = 3;
  Chance chance;
  const auto direction = [&] {
    return Double3{chance.between(-1, 1), chance.between(-1, 1), chance.between(-1, 1)};
  };
  for (int plate = 0; plate < 100; ++plate) {
    Double3 corner = 2.0 * direction();
    const Double3 u = chance.between(0.1, 0.7) * direction();
    const Double3 v = (plate % 5 == 0 ? 0.01 : chance.between(0.1, 0.7)) * direction();
    for (int copy = 0; copy < 2; ++copy) {
      if (plate % 2 == 0) {
        scene.faces.push_back(face_of(corner, u, v));
        add_patches(scene.faces.back(), Outlines::parallelograms, scene.patches);
      } else {
        scene.faces.push_back(face_of(corner, 0.5 * u, 0.5 * v));  // lies inside of the triangle
        scene.patches.push_back(triangle(corner, corner + u, corner + v));
      }
      // As far as the ends of rays are lifted in this scene.
      corner = corner + 0x1p-18 * normal_of(u, v);
    }
  }
  set_extent(scene);
  return scene;
}

std::vector<End> elements_on(const CheckScene& scene, std::size_t count) {
  std::vector<double> area_up_to{0};
  for (const Face& face : scene.faces)
    area_up_to.push_back(area_up_to.back() + length(cross(face.u, face.v)));
  const auto elements_up_to = [&](std::size_t face) {
    return static_cast<std::size_t>(
        std::llround(static_cast<double>(count) * (area_up_to[face] / area_up_to.back())));
  };
  std::vector<End> ends;
  ends.reserve(count);
  for (std::size_t face = 0; face < scene.faces.size(); ++face)
    add_elements(scene.faces[face], elements_up_to(face + 1) - elements_up_to(face), scene.sides, ends);
  return ends;
}

SceneArrays arrays_of(const CheckScene& scene, std::size_t elements) {
  return {scene.patches, elements_on(scene, elements), scene.extent, scene.lift};
}

}  // namespace fluxel::cuda::checks
