#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "visibility/cuda/scene_arrays.hpp"

namespace fluxel::cuda::checks {

/// A parallelogram with elements: corner + a u + b v, for a and b from 0 to 1 [m].
struct Face {
  Double3 corner, u, v;
  Double3 normal;
};

struct CheckScene {
  std::string name;
  std::vector<Face> faces;
  std::vector<ExactPatch> patches;  ///< in the way
  std::uint32_t sides = 1;          ///< of elements, as End's
  float extent = 0, lift = 0;       ///< [m], see TileScene
  bool sees_nothing = false;        ///< no element sees any other
};

enum class Outlines { triangles, parallelograms };

/// Boxes of random place and size in so many layers, none of which touch; their sides are from a third of
/// `most_of_cell` to all of it, in shares of the room a box.
struct Boxes {
  std::uint32_t count, layers;
  double most_of_cell;
};

/// A closed room of 10 x 8 x 3 m with boxes: of triangles 12 a box and for the walls.
[[nodiscard]] CheckScene room_with(const Boxes& boxes, Outlines outlines);

/// A floor and a ceiling, and between them a sheet of triangles without a gap. Where it has no bumps, all
/// coordinates are such that very many rays pass exactly through edges and corners. `bumps` [m]: from the
/// sheet's plane.
[[nodiscard]] CheckScene closed_sheet(double bumps);

/// The same of parallelograms, triangles, and four triangles around points off the lattice: edges on which
/// all is exact and others meet in corners that very many rays pass through.
[[nodiscard]] CheckScene mixed_sheet();

/// Triangles, parallelograms and slivers, all through each other, with elements on both sides. Each stands
/// there twice, where the ends of the other's rays lie, so that these are within rounding of its plane.
[[nodiscard]] CheckScene random_plates();

/// Exactly `count` elements, shared out by area, so that small faces may have none: a face is bisected along
/// its longer side again and again, and elements follow each other as bisection meets them.
[[nodiscard]] std::vector<End> elements_on(const CheckScene& scene, std::size_t count);

/// The scene with so many elements, as rays need it.
[[nodiscard]] SceneArrays arrays_of(const CheckScene& scene, std::size_t elements);

}  // namespace fluxel::cuda::checks
