// cluster_light_bench wooden-staircase.obj
// cluster_light_bench wooden-staircase.obj --block-error 1e-2,2.5e-3
//
// How well a cluster's irradiance can be told for each of its faces: by one number, by a vector (Willmott,
// Heckbert & Garland 1999), by a vector and a constant, by the six sides of a cube. The clusters are those of
// a cut that the rounds of these block errors have come to; each representation is fitted by least squares to
// one half of the places that are drawn on a cluster's faces, and compared with the irradiance of the other
// half.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/error.hpp"
#include "core/options.hpp"
#include "core/sampling.hpp"
#include "formfactor/even_points.hpp"
#include "hierarchy/ray_hierarchy.hpp"
#include "scene/scene_input.hpp"

namespace {

using namespace fluxel;

struct Place {
  glm::dvec3 normal{0};
  double irradiance = 0;
};

/// What a normal gets of each of a representation's numbers.
using Basis = Eigen::VectorXd (*)(const glm::dvec3& normal);

Eigen::VectorXd constant(const glm::dvec3& /*normal*/) { return Eigen::VectorXd::Ones(1); }
Eigen::VectorXd vector_alone(const glm::dvec3& n) { return Eigen::Vector3d(n.x, n.y, n.z); }
Eigen::VectorXd vector_and_constant(const glm::dvec3& n) { return Eigen::Vector4d(1, n.x, n.y, n.z); }
Eigen::VectorXd cube(const glm::dvec3& n) {
  Eigen::VectorXd parts = Eigen::VectorXd::Zero(kCubeSides);
  for (std::size_t axis = 0; axis < 3; ++axis)
    parts[static_cast<Eigen::Index>(cube_side(axis, n))] = cube_parts(n)[axis];
  return parts;
}

struct Representation {
  const char* name;
  Basis basis;
  bool clamps;  ///< of a vector alone: what looks away from it gets nothing
};
constexpr std::array kRepresentations{
    Representation{"constant", constant, false}, Representation{"vector, max(0, n V)", vector_alone, true},
    Representation{"constant and vector", vector_and_constant, false}, Representation{"cube", cube, false}};

/// Of each side of the cube the mean over the places, by what their normals take of it: as rows of rays have
/// it.
Eigen::VectorXd mean_of_sides(std::span<const Place> places, double mean) {
  Eigen::VectorXd sums = Eigen::VectorXd::Zero(kCubeSides), weights = sums;
  for (const Place& place : places) {
    const Eigen::VectorXd parts = cube(place.normal);
    sums += place.irradiance * parts;
    weights += parts;
  }
  for (Eigen::Index side = 0; side < sums.size(); ++side)
    sums[side] = weights[side] > 0 ? sums[side] / weights[side] : mean;
  return sums;
}

/// By least squares, drawn to 0 (a constant hardly) where the normals say little of a number.
Eigen::VectorXd fit(const Representation& of, std::span<const Place> places, double mean) {
  if (of.basis == cube) return mean_of_sides(places, mean);
  constexpr double kRidge = 1;
  constexpr int kSteps = 8;  // of the set of places that a vector lights
  Eigen::VectorXd values;
  for (int step = 0; step < (of.clamps ? kSteps : 1); ++step) {
    const Eigen::Index size = of.basis({0, 0, 1}).size();
    Eigen::MatrixXd squares = kRidge * Eigen::MatrixXd::Identity(size, size);
    if (!of.clamps) squares(0, 0) = 1e-6;
    Eigen::VectorXd right = Eigen::VectorXd::Zero(size);
    for (const Place& place : places) {
      const Eigen::VectorXd parts = of.basis(place.normal);
      if (step > 0 && parts.dot(values) <= 0) continue;
      squares += parts * parts.transpose();
      right += parts * place.irradiance;
    }
    values = squares.ldlt().solve(right);
  }
  return values;
}

struct ClusterPlaces {
  double area = 0;
  std::array<std::vector<Place>, 2> halves;
};

constexpr int kPlaces = 64;

/// Of clusters of many faces.
std::vector<ClusterPlaces> places_of(RayHierarchy& hierarchy, double ray_error) {
  const NodeTree& tree = hierarchy.tree();
  std::vector<ClusterPlaces> clusters;
  std::vector<GatherPoint> points;
  for (const NodeId node : hierarchy.cut()) {
    if (!tree.is_cluster(node) || tree.faces_of_cluster(node).size() < kPlaces / 2) continue;
    clusters.push_back({tree[node].shape.area, {}});
    SobolPoints numbers(node);
    for (int k = 0; k < kPlaces; ++k) {
      auto [u, v, unused, other] = numbers.next();
      const NodeId face = tree.random_face(node, u);
      points.push_back({face, surface_point(tree.outline(face), u, v)});
    }
  }
  SilentProgress silent;
  const std::vector<Rgb> H = hierarchy.gather(points, {ray_error, hierarchy.mean_radiosity()}, silent);
  for (std::size_t k = 0; k < points.size(); ++k)
    clusters[k / kPlaces].halves[k % 2].push_back({tree[points[k].face].shape.normal, mean_of_colours(H[k])});
  return clusters;
}

double mean_of(std::span<const Place> places) {
  double sum = 0;
  for (const Place& place : places) sum += place.irradiance;
  return sum / static_cast<double>(places.size());
}

/// Root mean square over the places of both halves, over their mean.
double error_of(const Representation& representation, const ClusterPlaces& cluster) {
  double squares = 0, sum = 0;
  for (std::size_t half = 0; half < 2; ++half) {
    const std::vector<Place>& fitted = cluster.halves[half];
    const Eigen::VectorXd values = fit(representation, fitted, mean_of(fitted));
    for (const Place& place : cluster.halves[1 - half]) {
      const double off = std::max(0.0, representation.basis(place.normal).dot(values)) - place.irradiance;
      squares += off * off;
      sum += place.irradiance;
    }
  }
  return sum > 0 ? std::sqrt(squares * kPlaces) / sum : 0;
}

/// A quarter, half and three quarters of the light on clusters fall on those with errors below.
void print(const std::vector<ClusterPlaces>& clusters) {
  if (clusters.empty()) throw InputError("the cut has no clusters of many faces: ask for coarser ones");
  fmt::print("{} clusters, errors over the mean of each; a quarter, half, three quarters of the light:\n",
             clusters.size());
  for (const Representation& representation : kRepresentations) {
    std::vector<std::pair<double, double>> errors;  // and power
    double power = 0;
    for (const ClusterPlaces& cluster : clusters) {
      const double received = cluster.area * (mean_of(cluster.halves[0]) + mean_of(cluster.halves[1]));
      errors.emplace_back(error_of(representation, cluster), received);
      power += received;
    }
    std::ranges::sort(errors);
    std::string line;
    double below = 0, part = 0.25;
    for (const auto& [error, received] : errors) {
      below += received;
      for (; part < 1 && below >= part * power; part += 0.25) line += fmt::format("{:8.1f} %", 100 * error);
    }
    fmt::print("  {:<22}{}\n", representation.name, line);
  }
}

int run(const std::string& file, const std::vector<double>& block_errors, double ray_error, int threads) {
  SceneSettings settings;
  settings.threads = threads;
  const Scene scene = build_scene(read_scene_input(file), settings);
  const RayScene ray_scene(scene, threads);
  RayHierarchy hierarchy({}, scene, ray_scene, threads, {});
  SilentProgress silent;
  for (const double error : block_errors) {
    static_cast<void>(hierarchy.refine(error, std::uint64_t{1} << 34, silent));
    hierarchy.solve(Solver::jacobi, {1e-3, 200}, [](const IterationState&) {});
  }
  print(places_of(hierarchy, ray_error));
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Compares representations of the irradiance of clusters.");
  std::string file;
  std::vector<double> block_errors{4e-2, 1e-2};
  double ray_error = 0.02;
  int threads = 1;
  app.add_option("scene", file)->required();
  app.add_option("--block-error", block_errors, "of the rounds")->delimiter(',')->capture_default_str();
  app.add_option("--ray-error", ray_error, "of the irradiance at places")->capture_default_str();
  app.add_option("--threads", threads)->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  try {
    return run(file, block_errors, ray_error, threads);
  } catch (const fluxel::InputError& error) {
    fmt::print(stderr, "cluster_light_bench: {}\n", error.what());
    return 2;
  } catch (const std::exception& error) {
    fmt::print(stderr, "cluster_light_bench: {}\n", error.what());
    return 1;
  }
}
