#include "formfactor/find_corrections.hpp"

#include <gtest/gtest.h>

#include <map>
#include <numbers>

#include "formfactor/pair_rule.hpp"
#include "solver/row_operator.hpp"
#include "tests/closed_forms/closed_forms.hpp"
#include "tests/unit/test_scenes.hpp"

namespace fluxel {
namespace {

using test_scenes::traced;
using test_scenes::uniform_elements;
using Matrix = std::vector<std::vector<double>>;

/// A scene with its elements and bits.
struct System {
  Scene scene;
  ElementMesh mesh;
  RayScene ray_scene;
  TileStore store;
  bool two_sided;
  PowerEstimate power;

  System(Scene from, double max_edge)
      : scene(std::move(from)),
        mesh(uniform_elements(scene, max_edge)),
        ray_scene(scene, 1),
        store(traced(ray_scene, mesh.elements)),
        two_sided(std::ranges::any_of(mesh.elements, [](const Element& e) { return e.sides > kFront; })) {
    power.B.assign(unknowns(), 1);
    power.H.assign(unknowns(), 1);
  }

  [[nodiscard]] std::size_t size() const { return mesh.elements.size(); }
  [[nodiscard]] std::size_t unknowns() const { return size() * (two_sided ? 2 : 1); }

  [[nodiscard]] FoundCorrections find(const FormFactorOptions& options, int threads = 1) const {
    return find_corrections(ray_scene, scene, mesh, store, options, power, threads);
  }

  /// Kernel and corrections as the solver applies them.
  [[nodiscard]] Matrix solved(const FormFactorOptions& options) const {
    const FoundCorrections found = find(options);
    RowOperator F(mesh.elements, store, found.corrections, kernel_rule(options), two_sided, 1);
    Matrix matrix(unknowns(), std::vector<double>(unknowns()));
    std::vector<Rgb> x(unknowns(), Rgb(0)), H(unknowns());
    for (std::size_t j = 0; j < unknowns(); ++j) {
      x[j] = Rgb(1);
      F.apply(x, H);
      x[j] = Rgb(0);
      for (std::size_t i = 0; i < unknowns(); ++i) matrix[i][j] = H[i].r;
    }
    return matrix;
  }

  /// Every pair of sides by the contour integral, as if nothing stood between.
  [[nodiscard]] Matrix exact() const {
    Matrix matrix(unknowns(), std::vector<double>(unknowns()));
    for (std::size_t i = 0; i < unknowns(); ++i) {
      for (std::size_t j = 0; j < unknowns(); ++j) {
        if (mesh.elements[i % size()].patch == mesh.elements[j % size()].patch) continue;
        if (sides(i) && sides(j)) matrix[i][j] = closed_forms::polygon_to_polygon(polygon(i), polygon(j));
      }
    }
    return matrix;
  }

 private:
  [[nodiscard]] bool sides(std::size_t unknown) const {
    return (mesh.elements[unknown % size()].sides >> (unknown / size()) & 1u) != 0;
  }
  [[nodiscard]] Polygon polygon(std::size_t unknown) const {
    const Outline<glm::dvec3> outline = widen(mesh.outlines[unknown % size()]);
    const PolygonView view = corners(outline);
    return unknown < size() ? Polygon(view.begin(), view.end()) : Polygon(view.rbegin(), view.rend());
  }
};

FormFactorOptions adaptive(double tolerance, bool partial_visibility) {
  FormFactorOptions options;
  options.tolerance = tolerance;
  options.partial_visibility = partial_visibility;
  return options;
}

double largest_difference(const Matrix& a, const Matrix& b) {
  double largest = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    for (std::size_t j = 0; j < a.size(); ++j) largest = std::max(largest, std::abs(a[i][j] - b[i][j]));
  return largest;
}

Scene box() {
  Scene scene = by_hand::empty_scene(Sides::one);
  by_hand::add_box(scene, "box", {-0.5, -0.4, -0.3}, {0.5, 0.4, 0.3}, false);
  return test_scenes::finished(std::move(scene));
}

/// Two-sided: a plate, and beside it a triangle that crosses its plane and that it sees freely.
Scene crossing_plates() {
  Scene scene = by_hand::empty_scene(Sides::two);
  by_hand::add(scene, "lying", {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
  by_hand::add(scene, "crossing", {{1.3, 0, -0.4}, {1.5, 0.1, 0.8}, {1.4, 1, 0.5}});
  return test_scenes::finished(std::move(scene));
}

TEST(FindCorrections, AClosedBoxIsAsExactAsAskedFor) {
  const System system(box(), 0.3);
  const Matrix exact = system.exact();
  for (const double tolerance : {1e-2, 1e-3, 1e-4}) {
    const Matrix solved = system.solved(adaptive(tolerance, false));
    EXPECT_LT(largest_difference(solved, exact), kPairTolerance * tolerance + 3e-5) << tolerance;
    for (std::size_t i = 0; i < system.size(); ++i) {
      double sum = 0;
      for (const double F : solved[i]) sum += F;
      EXPECT_NEAR(sum, 1, tolerance) << "a closed room";
    }
  }
}

// Undivided, each has parts on both sides of the other's plane.
TEST(FindCorrections, ElementsThatCrossPlanes) {
  for (const double max_edge : {4.0, 0.5}) {
    const System system(crossing_plates(), max_edge);
    ASSERT_TRUE(system.two_sided);
    const Matrix exact = system.exact();
    EXPECT_LT(largest_difference(system.solved(adaptive(1e-3, false)), exact), 1e-3) << max_edge;
    double backs = 0;
    for (std::size_t i = 0; i < system.size(); ++i)
      for (std::size_t j = system.size(); j < system.unknowns(); ++j) backs = std::max(backs, exact[i][j]);
    EXPECT_GT(backs, 1e-3) << "fronts see backs";
  }
}

TEST(FindCorrections, AreSymmetricAndAscending) {
  for (const bool two : {false, true}) {
    const System system(two ? crossing_plates() : box(), 0.3);
    const Corrections corrections = system.find(adaptive(1e-3, true)).corrections;
    ASSERT_EQ(corrections.start.size(), system.unknowns() + 1);
    ASSERT_EQ(corrections.start.back(), corrections.column.size());
    ASSERT_GT(corrections.column.size(), 20u);
    std::map<std::pair<std::size_t, std::size_t>, float> entries;
    for (std::size_t row = 0; row < system.unknowns(); ++row) {
      for (std::size_t k = corrections.start[row]; k < corrections.start[row + 1]; ++k) {
        EXPECT_TRUE(k == corrections.start[row] || corrections.column[k - 1] < corrections.column[k]);
        entries[{row, corrections.column[k]}] = corrections.G[k];
      }
    }
    for (const auto& [place, G] : entries) {
      const auto mirrored = entries.find({place.second, place.first});
      ASSERT_NE(mirrored, entries.end());
      EXPECT_EQ(mirrored->second, G);
    }
  }
}

using ColumnAndG = std::pair<std::uint32_t, float>;

std::vector<ColumnAndG> row_of(const Corrections& corrections, std::size_t row) {
  std::vector<ColumnAndG> entries;
  for (std::size_t k = corrections.start[row]; k < corrections.start[row + 1]; ++k)
    entries.emplace_back(corrections.column[k], corrections.G[k]);
  return entries;
}

TEST(FindCorrections, AnySplitAndAnyThreadsGiveTheSame) {
  const System system(test_scenes::random_plates(25, 0.7, Sides::two, 3), 0.3);
  const std::size_t tiles = system.store.tiles();
  ASSERT_GT(tiles, 3u);
  for (const bool points : {false, true}) {
    FormFactorOptions options = adaptive(3e-3, true);
    if (points) options.rule = FormFactor::points;
    const FoundCorrections whole = system.find(options, 1);
    ASSERT_GT(whole.corrections.column.size(), 0u);
    const FoundCorrections by_three = system.find(options, 3);
    EXPECT_EQ(by_three.corrections.column, whole.corrections.column);
    EXPECT_EQ(by_three.corrections.G, whole.corrections.G);
    EXPECT_EQ(by_three.counts.rays, whole.counts.rays);
    EXPECT_EQ(by_three.counts.near_pairs, whole.counts.near_pairs);
    for (const TileRows owned :
         {TileRows{0, 1}, TileRows{1, 1}, TileRows{1, tiles - 1}, TileRows{tiles - 1, tiles}}) {
      const TileStore store = traced(system.ray_scene, system.mesh.elements, owned);
      const Corrections part =
          find_corrections(system.ray_scene, system.scene, system.mesh, store, options, system.power, 2)
              .corrections;
      for (std::size_t row = 0; row < system.unknowns(); ++row) {
        const bool here = owned.contains(row % system.size() / kTileSize);
        EXPECT_EQ(row_of(part, row), here ? row_of(whole.corrections, row) : std::vector<ColumnAndG>{})
            << row;
      }
    }
  }
}

TEST(FindCorrections, WithoutPartialVisibilityThereAreNoRays) {
  const System system(box(), 0.3);
  const FoundCorrections found = system.find(adaptive(1e-3, false));
  EXPECT_EQ(found.counts.rays, 0u);
  EXPECT_EQ(found.counts.partial_pairs, 0u);
  EXPECT_GT(found.counts.near_pairs, 0u);
  EXPECT_GT(system.find(adaptive(1e-3, true)).counts.rays, 0u);
}

TEST(FindCorrections, PointAndDiscHaveNone) {
  const System system(box(), 0.5);
  for (const FormFactor rule : {FormFactor::point, FormFactor::disc}) {
    FormFactorOptions options = adaptive(1e-3, true);
    options.rule = rule;
    const FoundCorrections found = system.find(options);
    EXPECT_TRUE(found.corrections.column.empty());
    EXPECT_EQ(found.counts.rays, 0u);
  }
}

// Half of what two large elements exchange is hidden; the bit of the centroids says all or nothing.
TEST(FindCorrections, AHalfHiddenPairIsHalf) {
  Scene scene = by_hand::empty_scene(Sides::one);
  by_hand::add(scene, "below", {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
  by_hand::add(scene, "above", {{0, 0, 1}, {0, 1, 1}, {1, 1, 1}, {1, 0, 1}});
  by_hand::add(scene, "blocker", {{0, 0, 0.5}, {0.5, 0, 0.5}, {0.5, 1, 0.5}, {0, 1, 0.5}});
  const System system(test_scenes::finished(std::move(scene)), 2);
  ASSERT_EQ(system.size(), 3u);
  const double half = closed_forms::opposed_rectangles(1, 1, 1) / 2;
  std::size_t below = 0, above = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    if (system.mesh.elements[i].patch == PatchId{0}) below = i;
    if (system.mesh.elements[i].patch == PatchId{1}) above = i;
  }
  EXPECT_NEAR(system.solved(adaptive(1e-3, true))[below][above], half, 0.02 * half);
  const double all_or_nothing = system.solved(adaptive(1e-3, false))[below][above];
  EXPECT_TRUE(std::abs(all_or_nothing) < 1e-6 || std::abs(all_or_nothing - 2 * half) < 1e-4);
}

// Two plates that nothing hides, by the double loop over their points.
TEST(FindCorrections, PointsAreTheirPlainDoubleLoop) {
  Scene scene = by_hand::empty_scene(Sides::one);
  by_hand::add(scene, "below", {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
  by_hand::add(scene, "above", {{0, 0, 0.7}, {0, 1, 0.7}, {1, 1, 0.7}, {1, 0, 0.7}});
  const System system(test_scenes::finished(std::move(scene)), 2);
  for (const PointGrid grid : {PointGrid{1, 1}, PointGrid{3, 3}, PointGrid{5, 5}}) {
    FormFactorOptions options;
    options.rule = FormFactor::points;
    options.points = grid;
    options.tolerance = 1e-5;
    const int n = grid.m;
    double sum = 0;
    for (int a = 0; a < n * n * n * n; ++a) {
      const auto place = [&](int digit) { return (digit % n + 0.5) / n; };
      const double x = place(a) - place(a / n), y = place(a / (n * n)) - place(a / (n * n * n));
      const double r2 = x * x + y * y + 0.49, piece = 1.0 / (n * n);
      sum += piece * piece * 0.49 / (r2 * (std::numbers::pi * r2 + piece));
    }
    EXPECT_NEAR(system.solved(options)[0][1], sum, 1e-6) << n;
    EXPECT_EQ(system.find(options).counts.rays, static_cast<std::uint64_t>(n * n * n * n));
  }
}

}  // namespace
}  // namespace fluxel
