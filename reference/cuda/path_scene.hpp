#pragma once

#include "sampling/cuda/path_numbers.hpp"
#include "visibility/cuda/tile_scene.hpp"

namespace fluxel::cuda {

/// What a side of a patch does with light, of three channels: see SideLight.
struct PathSide {
  Double3 rho;
  Double3 E;  ///< [W/m2]
};

/// An uncovered emitting side.
struct EmittingSide {
  Double3 corner[4];
  Double3 normal;  ///< to where it emits
  Double3 E;       ///< [W/m2]
  std::uint32_t corners;
};

/// All that paths of light need, as plain arrays in the memory of the host or of a device.
struct PathScene {
  TileScene rays;             ///< without elements
  const std::uint8_t* flags;  ///< of each patch by its number: see first_side.hpp
  const PathSide* sides;      ///< front and back of each patch by its number
  const EmittingSide* emitters;
  const double* emitter_ends;  ///< running sums of area times magnitude of E
  std::size_t emitter_count;
  const SobolDirections* directions;
  double lift;  ///< [m], of rays off the surfaces that they begin and end on
};

/// A path from where light falls on: see fluxel::PathStart.
struct PathBegin {
  Double3 position, normal;
  double light[2];
  PathNumbers numbers;
};

/// What a path has found.
struct PathEstimate {
  Double3 irradiance;  ///< [W/m2]
  std::uint32_t rays;
};

}  // namespace fluxel::cuda
