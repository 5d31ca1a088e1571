#pragma once

#include <glm/gtc/quaternion.hpp>

#include "bench/stability/lab.hpp"
#include "scene/polygon.hpp"

/// Rooms that several situations and the tests of exact claims share.
namespace fluxel::lab {

/// The six faces of an axis-parallel box, normals outward or inward; bottom, top, then the sides.
void add_box(SceneInput& input, const std::string& group, double rho, double E, const glm::dvec3& low,
             const glm::dvec3& high, bool outward);

/// Uniform over all rotations (Shoemake 1992), the same for the same number everywhere.
[[nodiscard]] glm::dquat random_rotation(unsigned number);

/// x -> scale * (rotation * x) + shift for all corners.
void transform(SceneInput& input, const glm::dquat& rotation, double scale, const glm::dvec3& shift);

/// Makes any closed room a furnace: reflectances random for each patch to 0.9 and E = 1 - rho, so that
/// B = 1 is the exact solution.
void make_furnace(Setup& setup);

/// max |B - 1| over the unknowns, infinite where B is not finite.
[[nodiscard]] double furnace_error(const Run& run);

/// The largest fraction of a side's rays that leave the scene.
[[nodiscard]] double largest_escape_fraction(const Run& run);

/// What parts the dark room from the lit one.
enum class Wall { sheet, two_faces, box };

/// A room of 8 x 4 x 3 m with a wall across it that is parallel to none of its own. The end on one side of
/// the wall emits 1, so the other side must be dark.
struct DarkRoom {
  Setup setup;
  Plane dark_face;  ///< of the wall, its normal into the dark room [world m]
};

/// `thickness` is a fraction of the room's length, of no meaning for a sheet. A sheet is two-sided, two faces
/// are one-sided, back to back; a box is as `sides` says.
[[nodiscard]] DarkRoom dark_room(Wall wall, double thickness, Sides sides, unsigned rotation);

/// Mean of B over the surfaces of the dark room; 0 where nothing leaks.
[[nodiscard]] double leak(const DarkRoom& room, const Run& run);

}  // namespace fluxel::lab
