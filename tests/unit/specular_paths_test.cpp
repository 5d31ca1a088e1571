#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <utility>
#include <vector>

#include "core/error.hpp"
#include "core/sampling.hpp"
#include "reference/missed_luminaires.hpp"
#include "reference/sensors.hpp"
#include "tests/closed_forms/points.hpp"
#include "tests/unit/test_scenes.hpp"

namespace fluxel::specular_paths_test {
namespace {

constexpr double kPi = std::numbers::pi;

/// A mean and its standard error.
struct Found {
  double mean = 0, error = 0;
};

/// `measure(numbers, values)`: of many paths of one randomisation.
template <class Measure>
Found of_randomisations(Measure&& measure, std::uint32_t samples = 4096, int channel = 0) {
  constexpr int kRandom = 16;
  double sum = 0, squares = 0;
  for (int r = 0; r < kRandom; ++r) {
    std::vector<OwenSobol> numbers;
    for (std::uint32_t index = 0; index < samples; ++index)
      numbers.emplace_back(random_bits(static_cast<std::uint64_t>(r)), index);
    std::vector<Rgb> values(samples);
    measure(numbers, values);
    double mean = 0;
    for (const Rgb& value : values) mean += value[channel] / samples;
    sum += mean / kRandom;
    squares += mean * mean / kRandom;
  }
  return {sum, std::sqrt(std::max(0.0, squares - sum * sum) / (kRandom - 1))};
}

Found irradiance(const LightPaths& paths, const LitPoint& at, std::uint32_t samples = 4096, int channel = 0) {
  return of_randomisations(
      [&](std::vector<OwenSobol>& numbers, std::vector<Rgb>& values) {
        std::vector<PathStart> starts;
        for (OwenSobol& of : numbers) {
          const auto [a, b, u, v] = of.next();
          starts.push_back({at, {u, v}, of});
        }
        std::uint64_t rays = 0;
        paths.irradiance(starts, values, rays);
      },
      samples, channel);
}

Found measured(const Sensors& sensors, std::size_t sensor, std::uint32_t samples = 4096) {
  return of_randomisations(
      [&](std::vector<OwenSobol>& numbers, std::vector<Rgb>& values) {
        std::vector<SensorPath> paths;
        for (const OwenSobol& of : numbers) paths.push_back({sensor, of});
        std::uint64_t rays = 0;
        sensors.measure(paths, values, rays);
      },
      samples);
}

/// Within three standard errors, and what rays that start off their surfaces take away.
void expect_mean(const Found& found, double exact, double most_error) {
  EXPECT_LE(std::abs(found.mean - exact), 3 * found.error + 1e-5 * std::abs(exact))
      << found.mean << " for " << exact << ", standard error " << found.error;
  EXPECT_LT(found.error, most_error);
}

MaterialId add_material(Scene& scene, const char* name, const SurfaceOptics& optics, const Rgb& rho = Rgb(0),
                        const Rgb& E = Rgb(0), Sides sides = Sides::two) {
  scene.materials.push_back({.name = name, .rho = rho, .E = E, .sides = sides, .optics = optics});
  return MaterialId{static_cast<std::uint32_t>(scene.materials.size() - 1)};
}

/// The unit cube, a furnace: whatever its walls reflect, H is 1 everywhere.
Scene furnace(double rho, double mirror) {
  Scene scene = test_scenes::unit_cube();
  scene.materials[0].rho = Rgb(rho, 0.5 * rho, 0);
  scene.materials[0].optics.mirror = Rgb(mirror);
  scene.materials[0].E = Rgb(1 - mirror) - scene.materials[0].rho;
  return scene;
}

/// Gives patches that have come since a piece each.
Scene pieced(Scene scene) {
  for (std::size_t i = scene.pieces.size(); i < scene.patches.size(); ++i)
    scene.pieces.push_back({scene.patches[i].outline, PatchId{static_cast<std::uint32_t>(i)}});
  return scene;
}

const LitPoint kInFurnace{{0.1, 0.2, -0.45}, {0.6, 0, 0.8}};

TEST(SpecularPaths, AFurnaceWithMirrorsShinesEverywhere) {
  for (const auto& [rho, mirror] : {std::pair{0.3, 0.5}, std::pair{0.0, 0.8}, std::pair{0.7, 0.2}}) {
    const Scene scene = furnace(rho, mirror);
    const RayScene rays(scene, 1);
    const LightPaths paths(rays);
    for (int channel = 0; channel < 2; ++channel)
      expect_mean(irradiance(paths, kInFurnace, 1024, channel), 1, 1e-2);
  }
}

/// Stands across the middle of the furnace, away from its walls.
void add_panel(Scene& scene, MaterialId material) {
  by_hand::add(scene, "panel", {{0, -0.3, -0.3}, {0, 0.3, -0.3}, {0, 0.3, 0.3}, {0, -0.3, 0.3}}, material);
}

// What a panel sends to a side is what it reflects of that side and transmits of the other.
TEST(SpecularPaths, AFurnaceWithATransmittingPanelShinesEverywhere) {
  for (const SurfaceOptics& optics :
       {SurfaceOptics{.diffuse_transmission = Rgb(0.6)}, SurfaceOptics{.transmission = Rgb(0.6)},
        SurfaceOptics{.mirror = Rgb(0.1), .transmission = Rgb(0.2), .diffuse_transmission = Rgb(0.3)}}) {
    Scene scene = furnace(0.5, 0.2);
    add_panel(scene, add_material(scene, "panel", optics, Rgb(0.4)));
    scene = pieced(std::move(scene));
    const RayScene rays(scene, 1);
    const LightPaths paths(rays);
    expect_mean(irradiance(paths, {{-0.1, 0, 0}, {1, 0, 0}}, 1024), 1, 1e-2);
    expect_mean(irradiance(paths, {{0.1, 0.1, 0}, {-1, 0, 0}}, 1024), 1, 1e-2);
  }
}

MaterialId add_glass(Scene& scene, double index = 1.5) {
  return add_material(scene, "glass", {.refraction_index = index});
}

// In a body of index n radiance that has come from outside is n^2 times that there (Veach 1997, section 5.2).
// In a box it comes in the directions within the critical angle of a normal; the others are trapped, and
// dark. A face's own cone has 1 / n^2 of the irradiance on a plane along it, the upper halves of the four
// cones around it (angle - sin cos) / pi each.
TEST(SpecularPaths, AFurnaceWithClearGlassShinesEverywhere) {
  Scene scene = furnace(0.5, 0.1);
  by_hand::add_box(scene, "glass", {-0.2, -0.25, -0.3}, {0.2, 0.25, 0.3}, true, add_glass(scene));
  scene = pieced(std::move(scene));
  const RayScene rays(scene, 1);
  const LightPaths paths(rays);
  expect_mean(irradiance(paths, {{0, 0, -0.45}, {0, 0, 1}}, 1024), 1, 1e-2);
  expect_mean(irradiance(paths, {{0.4, 0.1, 0}, {-1, 0, 0}}, 1024), 1, 1e-2);
  const double critical = std::asin(1 / 1.5);
  const double within = 1 + 2.25 * 4 * (critical - std::sin(critical) * std::cos(critical)) / kPi;
  expect_mean(irradiance(paths, {{0.05, 0.1, -0.1}, {0, 0, 1}}, 1024), within, 2e-2);
  const Camera camera{{0.45, 0, 0}, {0, 0.05, 0.02}, {0, 0, 1}, 40, 1, 1};
  expect_mean(measured(*pixel_sensors(paths, scene, camera, 0), 0, 1024), 1 / kPi, 1e-2);
}

// A body in the glass in equilibrium with it: it sends what the n^2 of the glass brings.
TEST(SpecularPaths, AFurnaceWithABodyInGlassShinesEverywhere) {
  Scene scene = furnace(0.5, 0.1);
  by_hand::add_box(scene, "glass", {-0.2, -0.25, -0.3}, {0.2, 0.25, 0.3}, true, add_glass(scene));
  by_hand::add_box(scene, "body", glm::dvec3(-0.1), glm::dvec3(0.1), true,
                   add_material(scene, "grey", {.mirror = Rgb(0.2)}, Rgb(0.5), Rgb(0.3 * 2.25), Sides::one));
  scene = pieced(std::move(scene));
  const RayScene rays(scene, 1);
  const LightPaths paths(rays);
  expect_mean(irradiance(paths, {{0, 0, -0.45}, {0, 0, 1}}, 1024), 1, 1e-2);
  expect_mean(irradiance(paths, {{0, 0, 0.12}, {0, 0, -1}}, 1024), 2.25, 2e-2);
}

/// A lamp over [2, 3] x [0, 1] that shines up, and a large mirror in the plane z = 1 that looks down: the
/// lamp's image is in the plane z = 2. Of a floor that reflects 0.001 light comes back a thousandth as
/// strong.
struct MirroredLamp {
  Scene scene = by_hand::empty_scene(Sides::one);

  explicit MirroredLamp(const Rgb& share) {
    by_hand::add(scene, "lamp", {{2, 0, 0}, {3, 0, 0}, {3, 1, 0}, {2, 1, 0}}, by_hand::kLight);
    const MaterialId mirror = add_material(scene, "mirror", {.mirror = share}, Rgb(0), Rgb(0), Sides::one);
    by_hand::add(scene, "mirror", {{-9, -9, 1}, {-9, 9, 1}, {9, 9, 1}, {9, -9, 1}}, mirror);
    by_hand::add(scene, "floor", {{0.45, 0.45, 0}, {0.55, 0.45, 0}, {0.55, 0.55, 0}, {0.45, 0.55, 0}});
    scene = test_scenes::finished(std::move(scene));
  }
};

TEST(SpecularPaths, AMirrorShowsTheLampsImage) {
  const MirroredLamp of(Rgb(0.8, 1, 0));
  const RayScene rays(of.scene, 1);
  const LightPaths paths(rays);
  const LitPoint at{{0.5, 0.5, 0}, {0, 0, 1}};
  const double exact = closed_forms::point_to_parallel_rectangle({1.5, 2.5, -0.5, 0.5}, 2);
  expect_mean(irradiance(paths, at, 16384, 0), 0.8 * exact, 1e-4);
  expect_mean(irradiance(paths, at, 16384, 1), exact, 1e-4);
  EXPECT_EQ(irradiance(paths, at, 1024, 2).mean, 0);
  const std::vector<ElementShape> elements{{of.scene.patches[2].outline, PatchId{2}},
                                           {of.scene.patches[1].outline, PatchId{1}}};
  const auto sensors = element_sensors(paths, of.scene, elements);
  const double F = closed_forms::parallel_rectangles({0.45, 0.55, 0.45, 0.55}, {2, 3, 0, 1}, 2);
  expect_mean(measured(*sensors, 0, 16384), 0.5 * 0.8 * F, 1e-4);
  EXPECT_EQ(measured(*sensors, 1).mean, 0) << "a mirror sends nothing evenly";
}

TEST(SpecularPaths, PixelsSeeWhatAMirrorShows) {
  const MirroredLamp of(Rgb(0.8));
  const RayScene rays(of.scene, 1);
  const LightPaths paths(rays);
  const Camera at_lamp{{0.5, 0.5, 0.1}, {2.5, 0.5, 2}, {0, 0, 1}, 5, 1, 1};
  const Found lamp = measured(*pixel_sensors(paths, of.scene, at_lamp, 0), 0, 64);
  EXPECT_NEAR(lamp.mean, 0.8 / kPi, 1e-12);
  // The floor's image.
  const Camera at_floor{{2.5, 0.5, 0.1}, {0.5, 0.5, 2}, {0, 0, 1}, 1, 1, 1};
  const double H = 0.8 * closed_forms::point_to_parallel_rectangle({1.5, 2.5, -0.5, 0.5}, 2);
  expect_mean(measured(*pixel_sensors(paths, of.scene, at_floor, 0), 0, 16384), 0.8 * 0.5 * H / kPi, 1e-4);
}

// Of a plate (1 - R) / (1 + R) goes through, all reflections within it added up (Stokes 1862).
TEST(SpecularPaths, PixelsSeeThroughAPlateOfGlass) {
  Scene scene = by_hand::empty_scene(Sides::one);
  by_hand::add(scene, "lamp", {{-9, -9, 5}, {-9, 9, 5}, {9, 9, 5}, {9, -9, 5}}, by_hand::kLight);
  by_hand::add_box(scene, "plate", {-9, -9, 0}, {9, 9, 0.1}, true, add_glass(scene));
  scene = test_scenes::finished(std::move(scene));
  const RayScene rays(scene, 1);
  const LightPaths paths(rays);
  const Camera camera{{0, 0, -2}, {0, 0, 0}, {0, 1, 0}, 1, 1, 1};
  const double R = 0.2 * 0.2;
  const Found found = measured(*pixel_sensors(paths, scene, camera, 0), 0, 16384);
  expect_mean(found, (1 - R) / (1 + R) / kPi, 1e-3);
}

/// A lamp over [0, 1]^2 at z = 1 that shines down, or at z = -1 that shines up, and below or above it at z =
/// 0 a sheet whose front is up: it reflects 0.5 and sends 0.3 on evenly.
Scene sheet_and_lamp(Sides sides, bool lamp_above) {
  Scene scene = by_hand::empty_scene(Sides::one);
  if (lamp_above)
    by_hand::add(scene, "lamp", {{0, 0, 1}, {0, 1, 1}, {1, 1, 1}, {1, 0, 1}}, by_hand::kLight);
  else
    by_hand::add(scene, "lamp", {{0, 0, -1}, {1, 0, -1}, {1, 1, -1}, {0, 1, -1}}, by_hand::kLight);
  by_hand::add(scene, "sheet", {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}},
               add_material(scene, "sheet", {.diffuse_transmission = Rgb(0.3)}, Rgb(0.5), Rgb(0), sides));
  return test_scenes::finished(std::move(scene));
}

TEST(SpecularPaths, ElementsSendWhatComesThrough) {
  const double F = closed_forms::opposed_rectangles(1, 1, 1);
  for (const bool lamp_above : {true, false}) {
    const Scene scene = sheet_and_lamp(Sides::two, lamp_above);
    const RayScene rays(scene, 1);
    const LightPaths paths(rays);
    const std::vector<ElementShape> elements{{scene.patches[1].outline, PatchId{1}}};
    const auto sensors = element_sensors(paths, scene, elements);
    ASSERT_EQ(sensors->size(), 2u);
    expect_mean(measured(*sensors, 0, 16384), (lamp_above ? 0.5 : 0.3) * F, 1e-3);
    expect_mean(measured(*sensors, 1, 16384), (lamp_above ? 0.3 : 0.5) * F, 1e-3);
    // The same by paths that meet the sheet.
    const Camera from_above{{0.5, 0.5, 0.5}, {0.5, 0.5, 0}, {0, 1, 0}, 1, 1, 1};
    const double H = closed_forms::point_to_parallel_rectangle({-0.5, 0.5, -0.5, 0.5}, 1);
    expect_mean(measured(*pixel_sensors(paths, scene, from_above, 0), 0, 16384),
                (lamp_above ? 0.5 : 0.3) * H / kPi, 1e-3);
  }
}

// A back that is not active is black: what comes to it is lost, what comes to the front goes on.
TEST(SpecularPaths, SheetsOfOneSideSendWhatComesToIt) {
  for (const bool lamp_above : {true, false}) {
    const Scene scene = sheet_and_lamp(Sides::one, lamp_above);
    const RayScene rays(scene, 1);
    const LightPaths paths(rays);
    const double beyond =
        irradiance(paths, {{0.5, 0.5, lamp_above ? -0.5 : 0.5}, {0, 0, lamp_above ? 1.0 : -1.0}}).mean;
    EXPECT_EQ(beyond > 0.01, lamp_above);
    const std::vector<ElementShape> elements{{scene.patches[1].outline, PatchId{1}}};
    const Found sent = measured(*element_sensors(paths, scene, elements), 0, 16384);
    expect_mean(sent, lamp_above ? 0.5 * closed_forms::opposed_rectangles(1, 1, 1) : 0, 1e-3);
  }
}

/// A room without walls: a floor at z = 0, and 100 cd tables of which the last differs all around.
Scene scene_of_luminaires() {
  Scene scene = by_hand::empty_scene(Sides::one);
  by_hand::add(scene, "floor", {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
  scene.intensities.push_back({{0}, {0, kPi / 3, kPi / 2}, {100, 80, 0}});
  scene.intensities.push_back({{0, kPi / 2, kPi, 3 * kPi / 2, 2 * kPi},
                               {0, kPi / 3, kPi / 2},
                               {100, 80, 0, 100, 160, 0, 100, 40, 0, 100, 10, 0, 100, 80, 0}});
  return scene;
}

Luminaire& add_luminaire(Scene& scene, const glm::dvec3& position, const glm::dvec3& aim, bool round,
                         std::uint32_t table = 0) {
  Luminaire& lamp = scene.luminaires.emplace_back();
  lamp.name = "lamp";
  lamp.position = position;
  lamp.aim = aim;
  lamp.size = {0.6, 0.4};
  lamp.round = round;
  lamp.scale = {1, 0.5, 0};
  lamp.intensity = table;
  return lamp;
}

const LitPoint kOnFloor{{0.5, 0.5, 0}, {0, 0, 1}};

Found lit(const Scene& of, std::uint32_t samples) {
  const Scene scene = test_scenes::finished(of);
  const RayScene rays(scene, 1);
  return irradiance(LightPaths(rays), kOnFloor, samples);
}

TEST(SpecularPaths, AMirrorShowsALuminairesImage) {
  for (const bool round : {false, true}) {
    Scene direct = scene_of_luminaires(), mirrored = direct;
    add_luminaire(direct, {2, 0.5, 2}, {0, 0, -1}, round);
    add_luminaire(mirrored, {2, 0.5, 0}, {0, 0, 1}, round);
    const MaterialId mirror =
        add_material(mirrored, "mirror", {.mirror = Rgb(0.8)}, Rgb(0), Rgb(0), Sides::one);
    by_hand::add(mirrored, "mirror", {{-9, -9, 1}, {-9, 9, 1}, {9, 9, 1}, {9, -9, 1}}, mirror);
    const Found image = lit(direct, 1024);
    EXPECT_LT(image.error, 1e-3 * image.mean);
    expect_mean(lit(mirrored, 16384), 0.8 * image.mean, 0.01 * image.mean);
  }
}

TEST(SpecularPaths, ALuminaireIsSeenThroughASheet) {
  Scene direct = scene_of_luminaires();
  add_luminaire(direct, {0.7, 1.2, 1}, {0, 0, -1}, false, 1);
  Scene behind = direct;
  const auto sheet = [&](double z) {
    by_hand::add(behind, "sheet", {{-9, -9, z}, {9, -9, z}, {9, 9, z}, {-9, 9, z}},
                 add_material(behind, "sheet", {.transmission = Rgb(0.5)}));
  };
  const Found bare = lit(direct, 1024);
  sheet(0.5);
  expect_mean(lit(behind, 16384), 0.5 * bare.mean, 0.01 * bare.mean);
  sheet(1.1);
  expect_mean(lit(behind, 16384), 0.5 * bare.mean, 0.01 * bare.mean);
  by_hand::add(behind, "board", {{-9, -9, 0.8}, {9, -9, 0.8}, {9, 9, 0.8}, {-9, 9, 0.8}},
               add_material(behind, "black", {}));
  EXPECT_EQ(lit(behind, 1024).mean, 0);
}

// As recessed luminaires are: light leaves the opening, whichever side of the surface it lies on.
TEST(SpecularPaths, ALuminaireInTheCeilingsPlaneIsSeenThroughASheet) {
  Scene direct = scene_of_luminaires();
  add_luminaire(direct, {0.7, 1.2, 1}, {0, 0, -1}, false, 1);
  Scene ceiling = direct;
  by_hand::add(ceiling, "ceiling", {{-9, -9, 1}, {-9, 9, 1}, {9, 9, 1}, {9, -9, 1}},
               add_material(ceiling, "black", {}));
  by_hand::add(ceiling, "sheet", {{-9, -9, 0.5}, {9, -9, 0.5}, {9, 9, 0.5}, {-9, 9, 0.5}},
               add_material(ceiling, "sheet", {.transmission = Rgb(0.5)}));
  const Found bare = lit(direct, 1024);
  expect_mean(lit(ceiling, 16384), 0.5 * bare.mean, 0.01 * bare.mean);
}

TEST(SpecularPaths, PicturesShowNoOpenings) {
  Scene scene = scene_of_luminaires();
  add_luminaire(scene, {0.5, 0.5, 0.5}, {0, 0, 1}, false);
  by_hand::add(scene, "mirror", {{-9, -9, 1}, {-9, 9, 1}, {9, 9, 1}, {9, -9, 1}},
               add_material(scene, "mirror", {.mirror = Rgb(1)}));
  scene = test_scenes::finished(std::move(scene));
  const RayScene rays(scene, 1);
  const LightPaths paths(rays);
  const Camera camera{{0.5, 0.5, 0.7}, {0.5, 0.5, 1}, {0, 1, 0}, 1, 1, 1};
  // The floor behind the opening, which is lit by the opening's image alone, and not the opening.
  const double seen = measured(*pixel_sensors(paths, scene, camera, 0), 0, 64).mean;
  EXPECT_LT(seen, 100);
  EXPECT_GT(seen, 0);
}

TEST(SpecularPaths, PointLuminairesBesideMirrorsAreRefused) {
  Scene scene = scene_of_luminaires();
  add_luminaire(scene, {0, 0, 2}, {0, 0, -1}, false).size = {0, 0};
  const MaterialId mirror = add_material(scene, "bright", {.mirror = Rgb(0.5)});
  EXPECT_NO_THROW(refuse_missed_luminaires(scene)) << "nothing is of the material";
  by_hand::add(scene, "sheet", {{0, 0, 1}, {1, 0, 1}, {1, 1, 1}},
               add_material(scene, "sheet", {.diffuse_transmission = Rgb(0.5)}));
  EXPECT_NO_THROW(refuse_missed_luminaires(scene)) << "a sheet that scatters is lit by it";
  by_hand::add(scene, "mirror", {{0, 0, 1}, {1, 0, 1}, {1, 1, 1}}, mirror);
  try {
    refuse_missed_luminaires(scene);
    FAIL();
  } catch (const InputError& error) {
    const std::string message = error.what();
    for (const char* word : {"luminaire 'lamp'", "material 'bright'", "fluxel photons", "a point"})
      EXPECT_NE(message.find(word), std::string::npos) << message;
  }
  scene.luminaires[0].size = {0.1, 0};
  EXPECT_THROW(refuse_missed_luminaires(scene), InputError) << "nor does a ray meet a line";
  scene.luminaires[0].size = {0.1, 0.1};
  EXPECT_NO_THROW(refuse_missed_luminaires(scene));
}

}  // namespace
}  // namespace fluxel::specular_paths_test
