#include "visibility/visibility_identity.hpp"

#include <gtest/gtest.h>

#include <functional>

#include "tests/unit/test_scenes.hpp"
#include "visibility/instruction_set.hpp"

namespace fluxel {
namespace {

/// Scene and elements after a change.
std::uint64_t identity(const std::function<void(Scene&)>& of_scene = {},
                       const std::function<void(std::vector<Element>&)>& of_elements = {}) {
  Scene scene = test_scenes::random_plates(20, 0.5, Sides::two, 3);
  ElementMesh mesh = test_scenes::uniform_elements(scene, 0.2);
  if (of_scene) of_scene(scene);
  if (of_elements) of_elements(mesh.elements);
  const RayScene ray_scene(scene, 1);
  return visibility_identity(ray_scene, mesh.elements);
}

TEST(VisibilityIdentity, IsTheSameForTheSame) { EXPECT_EQ(identity(), identity()); }

TEST(VisibilityIdentity, LightAndReflectanceDoNotCount) {
  EXPECT_EQ(identity(), identity([](Scene& scene) {
              for (Material& material : scene.materials) material.E = Rgb(7), material.rho = Rgb(0.1);
              scene.name = "another";
            }));
  EXPECT_EQ(identity(), identity({}, [](std::vector<Element>& e) { e[3].material = MaterialId{1}; }));
}

TEST(VisibilityIdentity, GeometryCounts) {
  EXPECT_NE(identity(), identity([](Scene& s) { s.patches[5].outline.corner[1].x += 1e-12; }));
  EXPECT_NE(identity(), identity([](Scene& s) { s.patches.pop_back(); }));
  EXPECT_NE(identity(), identity([](Scene& s) { s.extent *= 2; }));
  EXPECT_NE(identity(), identity({}, [](std::vector<Element>& e) { e.pop_back(); }));
  EXPECT_NE(identity(), identity({}, [](std::vector<Element>& e) { std::swap(e[0], e[1]); }));
  EXPECT_NE(identity(), identity({}, [](std::vector<Element>& e) { e[9].centroid.z += 1e-4f; }));
  EXPECT_NE(identity(), identity({}, [](std::vector<Element>& e) { e[9].sides = kFront; }));
}

TEST(VisibilityIdentity, TheInstructionSetCounts) {
  std::vector<std::uint64_t> all;
  for (const Isa isa : supported_instruction_sets()) {
    use_instruction_set(isa);
    all.push_back(identity());
  }
  use_instruction_set(Isa::automatic);
  std::ranges::sort(all);
  EXPECT_EQ(std::ranges::adjacent_find(all), all.end());
}

}  // namespace
}  // namespace fluxel
