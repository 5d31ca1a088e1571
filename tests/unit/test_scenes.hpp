#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <glm/geometric.hpp>
#include <limits>
#include <numeric>
#include <optional>
#include <random>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/camera.hpp"
#include "formfactor/pair_rule.hpp"
#include "scene/scene_input.hpp"
#include "solver/radiosity_operator.hpp"
#include "solver/unknowns.hpp"
#include "subdivision/camera_raster.hpp"
#include "subdivision/subdivide.hpp"
#include "tests/unit/scene_by_hand.hpp"
#include "visibility/ray_scene.hpp"
#include "visibility/tile_store.hpp"
#include "visibility/tile_tracer.hpp"

/// Scenes and linear systems that several tests share.
namespace fluxel::test_scenes {

inline constexpr double kUnbounded = std::numeric_limits<double>::infinity();
inline constexpr std::array kSolvers{Solver::jacobi, Solver::gauss_seidel, Solver::conjugate_gradients,
                                     Solver::southwell};

inline std::string name_of(PairRule rule) {
  return rule == PairRule::point ? "point" : rule == PairRule::disc ? "disc" : "moments";
}

/// Uniform in [low, high).
inline double uniform(std::mt19937& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}

inline glm::dvec3 uniform_point(std::mt19937& random, double low, double high) {
  const double x = uniform(random, low, high), y = uniform(random, low, high);
  return {x, y, uniform(random, low, high)};
}

inline glm::dvec3 random_direction(std::mt19937& random) {
  return by_hand::random_rotation(random) * glm::dvec3(0, 0, 1);
}

/// Elements of any direction and elongation scattered in a cube.
inline std::vector<Element> random_elements(std::size_t n, double reach, std::mt19937& random) {
  std::vector<Element> elements(n);
  for (Element& element : elements) {
    element.centroid = glm::vec3(uniform_point(random, -reach, reach));
    element.normal = glm::vec3(random_direction(random));
    element.area = static_cast<float>(reach * reach * uniform(random, 1e-4, 1e-2));
    element.sides = kFront | kBack;
    const glm::vec3 along = glm::normalize(glm::cross(element.normal, glm::vec3(random_direction(random))));
    element.minor_variance = element.area * static_cast<float>(uniform(random, 0.02, 0.1));
    element.elongation = along * std::sqrt(element.area * static_cast<float>(uniform(random, 0, 0.5)));
  }
  return elements;
}

/// Gives every patch one piece, in the order of the patches, and sets the extent; coordinates stay as they
/// are.
inline Scene finished(Scene scene) {
  for (std::size_t i = 0; i < scene.patches.size(); ++i) {
    const Outline<glm::dvec3>& outline = scene.patches[i].outline;
    scene.pieces.push_back({outline, PatchId{static_cast<std::uint32_t>(i)}});
    for (std::size_t c = 0; c < outline.corners; ++c)
      for (int axis = 0; axis < 3; ++axis)
        scene.extent = std::max(scene.extent, std::abs(outline.corner[c][axis]));
  }
  return scene;
}

/// The inside of the cube [-1/2, 1/2]^3, one-sided; its first patch is the floor, the second the ceiling.
inline Scene unit_cube() {
  Scene scene = by_hand::empty_scene(Sides::one);
  by_hand::add_box(scene, "cube", glm::dvec3(-0.5), glm::dvec3(0.5), false);
  return finished(std::move(scene));
}

/// The square [-1/2, 1/2]^2 at z = 0, facing up.
inline Scene unit_square(Sides sides) {
  Scene scene = by_hand::empty_scene(sides);
  by_hand::add(scene, "square", {{-0.5, -0.5, 0}, {0.5, -0.5, 0}, {0.5, 0.5, 0}, {-0.5, 0.5, 0}});
  return finished(std::move(scene));
}

/// Parallelograms and triangles of about `size` scattered in the cube [-1, 1]^3, every third one a triangle.
inline Scene random_plates(int count, double size, Sides sides, unsigned seed) {
  std::mt19937 random(seed);
  Scene scene = by_hand::empty_scene(sides);
  for (int k = 0; k < count; ++k) {
    const glm::dvec3 at = uniform_point(random, -1, 1);
    const glm::dvec3 u = size * random_direction(random);
    const glm::dvec3 v = size * glm::normalize(glm::cross(u, random_direction(random))) + 0.3 * u;
    if (k % 3 == 2) {
      by_hand::add(scene, "plate", {at, at + u, at + v});
    } else {
      by_hand::add(scene, "plate", {at, at + u, at + u + v, at + v});
    }
  }
  return finished(std::move(scene));
}

/// Elements by longest edge alone.
inline ElementMesh uniform_elements(const Scene& scene, double max_edge) {
  SplitCriterion criterion;
  criterion.max_edge = max_edge;
  return subdivide_pieces(scene, 0, scene.pieces.size(), {}, criterion).mesh;
}

/// The tiles that meet the owned rows, traced.
inline TileStore traced(const RayScene& ray_scene, std::span<const Element> elements, TileRows owned) {
  const std::size_t tiles = tile_count(elements.size());
  TileStore store(tiles, owned);
  const TileTracer tracer(ray_scene, elements);
  for (std::size_t row = 0; row < tiles; ++row) {
    for (std::size_t column = row; column < tiles; ++column) {
      if (!owned.contains(row) && !owned.contains(column)) continue;
      const TracedTile tile = tracer.trace(row, column);
      store.put(row, column, tile.tag, tile.bits);
    }
  }
  return store;
}

inline TileStore traced(const RayScene& ray_scene, std::span<const Element> elements) {
  return traced(ray_scene, elements, {0, tile_count(elements.size())});
}

/// A scene of the project with its camera, at a resolution of the test's own.
struct SceneOfFile {
  Scene scene;
  Camera camera;
  std::optional<double> max_edge;
};

/// `name` is a folder of scenes/ and the stem of the scene file in it.
inline SceneOfFile load(const std::string& name, int width, int height) {
  const auto file = std::filesystem::path(FLUXEL_SOURCE_DIR) / "scenes" / name / (name + ".toml");
  const SceneInput input = read_scene_input(file);
  SceneOfFile loaded;
  SceneSettings settings;
  if (!input.cameras.empty()) {
    const InputCamera& camera = input.cameras.front();
    if (camera.eye) loaded.camera.eye = camera.eye->value;
    if (camera.look_at) loaded.camera.look_at = camera.look_at->value;
    if (camera.up) loaded.camera.up = camera.up->value;
    if (camera.fov) loaded.camera.fov = camera.fov->value;
  }
  for (const InputOption& option : input.options) {
    if (option.name == "max-edge") loaded.max_edge = std::stod(option.value);
    if (option.name == "sides") settings.sides = option.value == "one" ? Sides::one : Sides::two;
  }
  loaded.camera.width = width;
  loaded.camera.height = height;
  settings.camera_eye = loaded.camera.eye;
  loaded.scene = build_scene(input, settings);
  return loaded;
}

/// What the camera sees of a whole scene.
inline Raster look(const RayScene& ray_scene, const Scene& scene, const Camera& camera, int supersample = 1) {
  const auto nearest = nearest_depths(ray_scene, scene, camera, supersample, 1);
  return make_raster(scene, camera, supersample,
                     claim_pixels(ray_scene, scene, camera, supersample, nearest, 1));
}

/// F as a matrix, in double precision, for systems whose exact solution is wanted.
class DenseOperator final : public RadiosityOperator {
 public:
  explicit DenseOperator(std::vector<std::vector<double>> matrix) : F_(std::move(matrix)) {}

  [[nodiscard]] const std::vector<std::vector<double>>& matrix() const { return F_; }

  void apply(std::span<const Rgb> x, std::span<Rgb> H) override { apply_to(x, H); }
  void apply(std::span<const double> x, std::span<double> H) override { apply_to(x, H); }

  void sweep(std::span<const Rgb> E, std::span<const Rgb> rho, std::span<Rgb> x) override {
    sweep_over(E, rho, x);
  }
  void sweep(std::span<const double> E, std::span<const double> rho, std::span<double> x) override {
    sweep_over(E, rho, x);
  }

  /// B of B = E + rho F B by elimination with pivoting, each colour by itself.
  [[nodiscard]] std::vector<Rgb> exact_solution(const Unknowns& unknowns) const {
    const std::size_t n = F_.size();
    std::vector<Rgb> B(n);
    for (int channel = 0; channel < kChannels; ++channel) {
      std::vector<std::vector<double>> system(n, std::vector<double>(n + 1));
      for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t j = 0; j < n; ++j)
          system[i][j] = (i == j ? 1 : 0) - unknowns.rho[i][channel] * F_[i][j];
        system[i][n] = unknowns.E[i][channel];
      }
      for (std::size_t k = 0; k < n; ++k) {
        std::size_t pivot = k;
        for (std::size_t i = k + 1; i < n; ++i)
          if (std::abs(system[i][k]) > std::abs(system[pivot][k])) pivot = i;
        std::swap(system[k], system[pivot]);
        for (std::size_t i = 0; i < n; ++i) {
          if (i == k) continue;
          const double factor = system[i][k] / system[k][k];
          for (std::size_t j = k; j <= n; ++j) system[i][j] -= factor * system[k][j];
        }
      }
      for (std::size_t i = 0; i < n; ++i) B[i][channel] = system[i][n] / system[i][i];
    }
    return B;
  }

 private:
  template <class Value>
  void apply_to(std::span<const Value> x, std::span<Value> H) const {
    for (std::size_t i = 0; i < F_.size(); ++i) H[i] = row<Value>(i, x);
  }

  template <class Value>
  void sweep_over(std::span<const Value> E, std::span<const Value> rho, std::span<Value> x) const {
    for (std::size_t i = 0; i < F_.size(); ++i) x[i] = E[i] + rho[i] * row<Value>(i, x);
  }

  template <class Value>
  [[nodiscard]] Value row(std::size_t i, std::span<const Value> x) const {
    Value sum(0);
    for (std::size_t j = 0; j < F_.size(); ++j) sum += F_[i][j] * x[j];
    return sum;
  }

  std::vector<std::vector<double>> F_;
};

/// A random matrix without diagonal whose rows add up to `row_sum`.
inline std::vector<std::vector<double>> random_matrix(std::size_t n, double row_sum, std::mt19937& random) {
  std::vector<std::vector<double>> matrix(n, std::vector<double>(n));
  for (std::size_t i = 0; i < n; ++i) {
    double sum = 0;
    for (std::size_t j = 0; j < n; ++j) sum += matrix[i][j] = i == j ? 0 : uniform(random, 0, 1);
    for (double& entry : matrix[i]) entry *= row_sum / sum;
  }
  return matrix;
}

/// Random emission, area and reflectance below `rho_max`, one-sided.
inline Unknowns random_unknowns(std::size_t n, double rho_max, std::mt19937& random) {
  Unknowns unknowns;
  unknowns.elements = unknowns.active = n;
  for (std::size_t i = 0; i < n; ++i) {
    unknowns.E.push_back(uniform_point(random, 0, 1));
    unknowns.rho.push_back(uniform_point(random, 0, rho_max));
    unknowns.area.push_back(uniform(random, 0.1, 1));
  }
  return unknowns;
}

/// A system as a scene makes it: A F is symmetric.
struct RandomSystem {
  DenseOperator F;
  Unknowns unknowns;
};

/// Of n sides whose rows of F add up to `row_sum`, with random areas, emission and reflectances below
/// `rho_max`.
inline RandomSystem random_system(std::size_t n, double row_sum, double rho_max, std::mt19937& random) {
  std::vector<std::vector<double>> F(n, std::vector<double>(n));
  std::vector<double> size(n);
  for (double& of : size) of = uniform(random, 0.3, 1);
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < i; ++j) F[i][j] = F[j][i] = size[i] * size[j] * uniform(random, 0.1, 1);
  Unknowns unknowns = random_unknowns(n, rho_max, random);
  for (std::size_t i = 0; i < n; ++i) {
    // What is symmetric is A F, so the area follows from the sum of its row.
    unknowns.area[i] = std::accumulate(F[i].begin(), F[i].end(), 0.0) / row_sum;
    for (double& entry : F[i]) entry /= unknowns.area[i];
  }
  return {DenseOperator(std::move(F)), std::move(unknowns)};
}

/// max |x - y| for each colour.
inline Rgb largest_difference(std::span<const Rgb> x, std::span<const Rgb> y) {
  Rgb largest(0);
  for (std::size_t i = 0; i < x.size(); ++i) largest = glm::max(largest, glm::abs(x[i] - y[i]));
  return largest;
}

}  // namespace fluxel::test_scenes
