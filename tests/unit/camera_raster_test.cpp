#include "subdivision/camera_raster.hpp"

#include <gtest/gtest.h>

#include "core/error.hpp"
#include "tests/unit/test_scenes.hpp"

namespace fluxel {
namespace {

using by_hand::kLight;
using by_hand::kWhite;
using test_scenes::finished;
using test_scenes::look;

const std::vector<glm::dvec3> kFacingUp{{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
const std::vector<glm::dvec3> kFacingDown{{-1, -1, 0}, {-1, 1, 0}, {1, 1, 0}, {1, -1, 0}};

Camera from_above() {
  Camera camera;
  camera.eye = {0.1, -0.2, 3};
  camera.look_at = {0, 0, 0};
  camera.width = camera.height = 16;
  return camera;
}

struct Sheet {
  std::vector<glm::dvec3> corners;
  MaterialId material;
};

Scene sheets(Sides sides, const std::vector<Sheet>& all) {
  Scene scene = by_hand::empty_scene(sides);
  for (const Sheet& sheet : all) by_hand::add(scene, "sheet", sheet.corners, sheet.material);
  return finished(std::move(scene));
}

/// The patch that all pixels which see anything agree on.
PatchId winner(const Scene& scene) {
  const Raster raster = look(RayScene(scene, 1), scene, from_above());
  std::vector<PatchId> seen = raster.patch;
  std::erase(seen, kNoPatch);
  EXPECT_GT(seen.size(), 100u);
  EXPECT_TRUE(std::ranges::all_of(seen, [&](PatchId id) { return id == seen.front(); }));
  return seen.front();
}

TEST(CameraRaster, OfCoincidentSurfacesTheEmitterWins) {
  for (const Sides sides : {Sides::one, Sides::two}) {
    EXPECT_EQ(winner(sheets(sides, {{kFacingUp, kWhite}, {kFacingUp, kLight}})), PatchId{1});
    EXPECT_EQ(winner(sheets(sides, {{kFacingUp, kLight}, {kFacingUp, kWhite}})), PatchId{0});
  }
}

TEST(CameraRaster, OfCoincidentSurfacesTheLowerNumberWins) {
  EXPECT_EQ(winner(sheets(Sides::one, {{kFacingUp, kWhite}, {kFacingUp, kWhite}, {kFacingUp, kWhite}})),
            PatchId{0});
  EXPECT_EQ(winner(sheets(Sides::two, {{kFacingUp, kLight}, {kFacingUp, kLight}})), PatchId{0});
}

TEST(CameraRaster, SurfacesWithinTheToleranceAreCoincident) {
  std::vector<glm::dvec3> higher = kFacingUp;
  for (glm::dvec3& corner : higher) corner.z = 1e-7;
  EXPECT_EQ(winner(sheets(Sides::one, {{kFacingUp, kLight}, {higher, kWhite}})), PatchId{0});
  for (glm::dvec3& corner : higher) corner.z = 1e-3;
  EXPECT_EQ(winner(sheets(Sides::one, {{kFacingUp, kLight}, {higher, kWhite}})), PatchId{1});
}

TEST(CameraRaster, OfOneSidedSheetsBackToBackTheFrontWins) {
  EXPECT_EQ(winner(sheets(Sides::one, {{kFacingDown, kWhite}, {kFacingUp, kWhite}})), PatchId{1});
  EXPECT_EQ(winner(sheets(Sides::one, {{kFacingDown, kLight}, {kFacingUp, kWhite}})), PatchId{1});
  EXPECT_EQ(winner(sheets(Sides::two, {{kFacingDown, kLight}, {kFacingUp, kWhite}})), PatchId{0})
      << "where both sides are unknowns no side comes first";
}

TEST(CameraRaster, TheOrderInTheRaySceneDoesNotCount) {
  const Scene scene = test_scenes::load("cornell-box", 48, 48).scene;
  const Camera camera = test_scenes::load("cornell-box", 48, 48).camera;
  std::vector<PatchId> patches;
  for (std::size_t i = 0; i < scene.patches.size(); ++i)
    patches.push_back(PatchId{static_cast<std::uint32_t>(i)});
  const Raster forward = look(RayScene(scene, patches, 1), scene, camera);
  std::ranges::reverse(patches);
  const Raster backward = look(RayScene(scene, patches, 1), scene, camera);
  EXPECT_EQ(backward.patch, forward.patch);
  EXPECT_EQ(backward.depth, forward.depth);
  EXPECT_EQ(backward.front, forward.front);
}

TEST(CameraRaster, MergedPartsEqualTheWhole) {
  for (const char* name : {"cornell-box", "office-2391", "three-rectangles"}) {
    const auto [scene, camera, max_edge] = test_scenes::load(name, 64, 48);
    const RayScene whole(scene, 1);
    const auto nearest = nearest_depths(whole, scene, camera, 2, 1);
    const auto claims = claim_pixels(whole, scene, camera, 2, nearest, 1);
    for (const std::size_t parts : {2u, 5u}) {
      std::vector<std::vector<PatchId>> patches(parts);
      for (std::size_t i = 0; i < scene.patches.size(); ++i)
        patches[i % parts].push_back(PatchId{static_cast<std::uint32_t>(i)});
      std::vector<double> merged_nearest(nearest.size(), test_scenes::kUnbounded);
      std::vector<PixelClaim> merged_claims(claims.size(), kNoClaim);
      for (const auto& part : patches) {
        const auto own = nearest_depths(RayScene(scene, part, 1), scene, camera, 2, 1);
        std::ranges::transform(own, merged_nearest, merged_nearest.begin(),
                               [](double a, double b) { return std::min(a, b); });
      }
      for (const auto& part : patches) {
        const auto own = claim_pixels(RayScene(scene, part, 1), scene, camera, 2, merged_nearest, 1);
        std::ranges::transform(own, merged_claims, merged_claims.begin(),
                               [](PixelClaim a, PixelClaim b) { return std::min(a, b); });
      }
      EXPECT_EQ(merged_nearest, nearest) << name << ' ' << parts;
      EXPECT_EQ(merged_claims, claims) << name << ' ' << parts;
    }
  }
}

// Two sheets that single precision cannot tell apart: either may be hit first, and the depth is that of the
// upper one.
TEST(CameraRaster, TheNearestDepthIsTheLeastOfNearlyCoincidentSheets) {
  std::vector<glm::dvec3> higher = kFacingUp;
  for (glm::dvec3& corner : higher) corner.z = 1e-9;
  Camera camera = from_above();
  camera.eye = {0, 0, 2};
  for (const auto& both : {std::vector<Sheet>{{kFacingUp, kWhite}, {higher, kWhite}},
                           std::vector<Sheet>{{higher, kWhite}, {kFacingUp, kWhite}}}) {
    const Scene scene = sheets(Sides::one, both);
    for (const double depth : nearest_depths(RayScene(scene, 1), scene, camera, 1, 1))
      EXPECT_NEAR(depth, 2 - 1e-9, 1e-14);
  }
}

// A chequered floor seen from ever further away with the field of view that keeps its size: the directions
// become parallel, so that from some distance on the picture does not change any more.
TEST(CameraRaster, AFarCameraSeesWhatANearerOneDoes) {
  // A floor below, which would win if the two counted as one.
  std::vector<Sheet> fields{{{{-2, -2, -0.2}, {2, -2, -0.2}, {2, 2, -0.2}, {-2, 2, -0.2}}, kLight}};
  for (int x = 0; x < 4; ++x) {
    for (int y = 0; y < 4; ++y) {
      std::vector<glm::dvec3> corners = kFacingUp;
      for (glm::dvec3& corner : corners) corner = 0.5 * corner + glm::dvec3(x - 1.5, y - 1.5, 0);
      fields.push_back({corners, kWhite});
    }
  }
  const Scene scene = sheets(Sides::one, fields);
  const RayScene rays(scene, 1);
  const auto seen_from = [&](double distance) {
    Camera camera = from_above();
    camera.width = camera.height = 48;
    camera.eye = distance * glm::normalize(glm::dvec3(0.3, -0.5, 0.6));
    camera.fov = 2 * std::atan(3 / distance) * 180 / 3.14159265358979323846;
    return look(rays, scene, camera).patch;
  };
  const std::vector<PatchId> reference = seen_from(1e5);
  EXPECT_GT(std::ranges::count_if(reference, [](PatchId id) { return id != kNoPatch && id != PatchId{0}; }),
            500);
  for (const double distance : {1e6, 1e7, 1e8}) {
    const std::vector<PatchId> seen = seen_from(distance);
    std::size_t different = 0;
    for (std::size_t pixel = 0; pixel < seen.size(); ++pixel)
      different += seen[pixel] != reference[pixel] ? 1 : 0;
    EXPECT_LE(different, 4u) << distance;  // at the edges of fields
  }
}

TEST(CameraRaster, ThreadsDoNotCount) {
  const auto [scene, camera, max_edge] = test_scenes::load("cornell-box", 48, 48);
  const RayScene whole(scene, 2);
  const auto nearest = nearest_depths(whole, scene, camera, 1, 1);
  EXPECT_EQ(nearest_depths(whole, scene, camera, 1, 2), nearest);
  EXPECT_EQ(claim_pixels(whole, scene, camera, 1, nearest, 2),
            claim_pixels(whole, scene, camera, 1, nearest, 1));
}

TEST(CameraRaster, DepthIsAlongTheViewAxis) {
  const Scene scene = sheets(Sides::one, {{kFacingUp, kWhite}});
  Camera camera = from_above();
  camera.eye = {0, 0, 2};
  const Raster raster = look(RayScene(scene, 1), scene, camera);
  for (std::size_t pixel = 0; pixel < raster.pixels(); ++pixel) {
    ASSERT_EQ(raster.patch[pixel], PatchId{0});
    EXPECT_NEAR(raster.depth[pixel], 2, 1e-14);
    EXPECT_EQ(raster.front[pixel], 1);
    EXPECT_NEAR(pixel_point(scene, camera, PixelRays(camera), raster, pixel).z, 0, 1e-14);
  }
  // Row 0 is the top of the picture, column 0 its left.
  EXPECT_LT(pixel_point(scene, camera, PixelRays(camera), raster, 0).x, 0);
  EXPECT_GT(pixel_point(scene, camera, PixelRays(camera), raster, 0).y, 0);
}

TEST(CameraRaster, ACameraThatSeesNothingIsAnError) {
  const Scene scene = sheets(Sides::two, {{kFacingUp, kWhite}});
  Camera camera = from_above();
  camera.look_at = {0, 0, 10};
  camera.eye = {0, 0, 3};
  const Raster nothing = look(RayScene(scene, 1), scene, camera);
  EXPECT_TRUE(std::ranges::all_of(nothing.patch, [](PatchId id) { return id == kNoPatch; }));
  EXPECT_TRUE(std::ranges::all_of(nothing.depth, [](double depth) { return std::isinf(depth); }));
  try {
    require_view(scene, nothing);
    FAIL() << "no error";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("sees nothing"), std::string::npos) << error.what();
  }
}

TEST(CameraRaster, ACameraThatSeesOnlyBacksIsAnError) {
  const Scene backs = sheets(Sides::one, {{kFacingDown, kWhite}});
  try {
    require_view(backs, look(RayScene(backs, 1), backs, from_above()));
    FAIL() << "no error";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("only backs"), std::string::npos) << error.what();
  }
  const Scene two_sided = sheets(Sides::two, {{kFacingDown, kWhite}});
  EXPECT_NO_THROW(require_view(two_sided, look(RayScene(two_sided, 1), two_sided, from_above())));
  Scene sealed = two_sided;
  sealed.patches[0].sides = kFront;
  EXPECT_THROW(require_view(sealed, look(RayScene(sealed, 1), sealed, from_above())), InputError);
  const Scene fronts = sheets(Sides::one, {{kFacingUp, kWhite}});
  EXPECT_NO_THROW(require_view(fronts, look(RayScene(fronts, 1), fronts, from_above())));
}

TEST(CameraRaster, TheLeastSpacingIsBelowAllDistancesOnAPlane) {
  std::mt19937 random(1);
  double tightest = test_scenes::kUnbounded;
  for (int repeat = 0; repeat < 200; ++repeat) {
    Camera camera;
    camera.look_at = test_scenes::random_direction(random);
    camera.eye = glm::dvec3(0);
    camera.fov = test_scenes::uniform(random, 10, 120);
    camera.width = 12;
    camera.height = repeat % 2 == 0 ? 9 : 1;
    const int supersample = repeat % 3 == 0 ? 2 : 1;
    const PixelRays rays(camera, supersample);
    const glm::dvec3 normal = repeat < 40 ? -camera.look_at : test_scenes::random_direction(random);
    std::vector<glm::dvec3> points;
    double nearest = test_scenes::kUnbounded;
    for (int row = 0; row < rays.height(); ++row) {
      for (int column = 0; column < rays.width(); ++column) {
        const double depth = -1 / glm::dot(normal, rays.direction(column, row));
        if (depth <= 0) continue;
        points.push_back(depth * rays.direction(column, row));
        nearest = std::min(nearest, depth);
      }
    }
    if (points.size() < 2) continue;
    const double spacing = least_pixel_spacing(camera, supersample, nearest);
    EXPECT_GT(spacing, 0);
    for (std::size_t i = 0; i < points.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        const double distance = glm::distance(points[i], points[j]);
        EXPECT_GE(distance, spacing * (1 - 1e-12));
        tightest = std::min(tightest, distance / spacing);
      }
    }
  }
  EXPECT_LT(tightest, 1.2) << "and it is no wild guess";
}

}  // namespace
}  // namespace fluxel
