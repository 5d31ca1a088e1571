#include "formfactor/tile_examiner.hpp"
#include "core/options.hpp"

#include <gtest/gtest.h>

#include <map>
#include <numbers>

#include "formfactor/pair_rule.hpp"
#include "solver/row_operator.hpp"
#include "tests/closed_forms/closed_forms.hpp"
#include "tests/unit/serial_corrections.hpp"
#include "tests/unit/test_scenes.hpp"

namespace fluxel {
namespace {

using test_scenes::traced;
using test_scenes::uniform_elements;
using Matrix = std::vector<std::vector<double>>;

/// A scene with its elements and bits.
struct ExaminedSystem {
  Scene scene;
  ElementMesh mesh;
  RayScene ray_scene;
  TileStore store;
  bool two_sided;
  PowerEstimate power;

  ExaminedSystem(Scene from, double max_edge)
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

  [[nodiscard]] TileExaminer examiner(const FormFactorOptions& options) const {
    return {ray_scene, scene, mesh, options, power};
  }
  [[nodiscard]] TileExaminer::Found find(const FormFactorOptions& options) const {
    return test_scenes::examine_all(examiner(options), store);
  }
  [[nodiscard]] Corrections corrections(const FormFactorOptions& options) const {
    return compress(CorrectionList(find(options).entries), unknowns());
  }

  /// Kernel and corrections as the solver applies them.
  [[nodiscard]] Matrix solved(const FormFactorOptions& options) const {
    const Corrections found = corrections(options);
    RowOperator F(mesh.elements, store, found, kernel_rule(options), two_sided, 1);
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

TEST(TileExaminer, AClosedBoxIsAsExactAsAskedFor) {
  const ExaminedSystem system(box(), 0.3);
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
TEST(TileExaminer, ElementsThatCrossPlanes) {
  for (const double max_edge : {4.0, 0.5}) {
    const ExaminedSystem system(crossing_plates(), max_edge);
    ASSERT_TRUE(system.two_sided);
    const Matrix exact = system.exact();
    EXPECT_LT(largest_difference(system.solved(adaptive(1e-3, false)), exact), 1e-3) << max_edge;
    double backs = 0;
    for (std::size_t i = 0; i < system.size(); ++i)
      for (std::size_t j = system.size(); j < system.unknowns(); ++j) backs = std::max(backs, exact[i][j]);
    EXPECT_GT(backs, 1e-3) << "fronts see backs";
  }
}

TEST(TileExaminer, AreSymmetricAndAscending) {
  for (const bool two : {false, true}) {
    const ExaminedSystem system(two ? crossing_plates() : box(), 0.3);
    const Corrections corrections = system.corrections(adaptive(1e-3, true));
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

/// Rule, tolerance and rays of every kind.
std::vector<FormFactorOptions> all_options() {
  FormFactorOptions by_points = adaptive(3e-3, true);
  by_points.rule = FormFactor::points;
  return {adaptive(3e-3, true), adaptive(3e-3, false), by_points};
}

ExaminedSystem plates() { return {test_scenes::random_plates(25, 0.7, Sides::two, 3), 0.3}; }

TEST(TileExaminer, ATileInPartsGivesTheSame) {
  const ExaminedSystem system = plates();
  ASSERT_GT(system.store.tiles(), 3u);
  for (const FormFactorOptions& options : all_options()) {
    const TileExaminer::Found whole = system.find(options);
    TileExaminer::Found in_parts;
    const TileExaminer examiner = system.examiner(options);
    for (const auto& [first, last] : {std::pair{40u, 64u}, std::pair{0u, 1u}, std::pair{1u, 40u}}) {
      for (std::size_t row = 0; row < system.store.tiles(); ++row) {
        for (std::size_t column = row; column < system.store.tiles(); ++column) {
          TileBits bits;
          system.store.read(row, column, bits);
          examiner.examine(row, column, bits, first, last, in_parts);
        }
      }
    }
    const Corrections expected = compress(CorrectionList(whole.entries), system.unknowns());
    const Corrections found = compress(CorrectionList(in_parts.entries), system.unknowns());
    ASSERT_GT(expected.column.size(), 0u);
    EXPECT_EQ(found.start, expected.start);
    EXPECT_EQ(found.column, expected.column);
    EXPECT_EQ(found.G, expected.G);
    EXPECT_EQ(in_parts.counts.rays, whole.counts.rays);
    EXPECT_EQ(in_parts.counts.near_pairs, whole.counts.near_pairs);
    EXPECT_EQ(in_parts.counts.partial_pairs, whole.counts.partial_pairs);
    EXPECT_EQ(in_parts.counts.clipped_pairs, whole.counts.clipped_pairs);
  }
}

// Small plates in a large room: many tiles have nothing to correct, and are told quickly.
TEST(TileExaminer, TilesWithoutWorkHaveNoCorrections) {
  const ExaminedSystem system(test_scenes::random_plates(40, 0.3, Sides::one, 5), 0.04);
  for (const FormFactorOptions& options : {adaptive(1e-2, true), adaptive(1e-3, false)}) {
    const TileExaminer examiner = system.examiner(options);
    std::size_t without = 0, corrected = 0;
    for (std::size_t row = 0; row < system.store.tiles(); ++row) {
      for (std::size_t column = row; column < system.store.tiles(); ++column) {
        TileBits bits;
        system.store.read(row, column, bits);
        TileExaminer::Found found;
        examiner.examine(row, column, bits, 0, kTileSize, found);
        if (!found.entries.empty()) ++corrected;
        if (examiner.has_work(row, column)) continue;
        ++without;
        EXPECT_TRUE(found.entries.empty()) << row << ' ' << column;
        EXPECT_EQ(found.counts.rays, 0u);
      }
    }
    EXPECT_GT(without, 10u);
    EXPECT_GT(corrected, 10u);
  }
}

// What many rays will be spent on is known before.
TEST(TileExaminer, TilesWithMoreRaysArePredictedToTakeLonger) {
  const ExaminedSystem system = plates();
  for (const FormFactorOptions& options : all_options()) {
    if (!options.partial_visibility) continue;
    const TileExaminer examiner = system.examiner(options);
    std::vector<std::pair<double, double>> rays_and_seconds;
    for (std::size_t row = 0; row < system.store.tiles(); ++row) {
      for (std::size_t column = row; column < system.store.tiles(); ++column) {
        TileBits bits;
        system.store.read(row, column, bits);
        TileExaminer::Found found;
        examiner.examine(row, column, bits, 0, kTileSize, found);
        const double clipped = kRaysOfAnOccluder * static_cast<double>(found.counts.clipped_pairs);
        rays_and_seconds.emplace_back(static_cast<double>(found.counts.rays) + clipped,
                                      examiner.predicted_seconds(row, column, system.store.tag(row, column)));
      }
    }
    std::ranges::sort(rays_and_seconds);
    double lower = 0, upper = 0;
    const std::size_t half = rays_and_seconds.size() / 2;
    for (std::size_t k = 0; k < half; ++k) {
      lower += rays_and_seconds[k].second;
      upper += rays_and_seconds[rays_and_seconds.size() - 1 - k].second;
    }
    EXPECT_GT(upper, 1.2 * lower);
  }
}

TEST(TileExaminer, WithoutPartialVisibilityThereAreNoRays) {
  const ExaminedSystem system(box(), 0.3);
  const TileExaminer::Found found = system.find(adaptive(1e-3, false));
  EXPECT_EQ(found.counts.rays, 0u);
  EXPECT_EQ(found.counts.partial_pairs, 0u);
  EXPECT_GT(found.counts.near_pairs, 0u);
  EXPECT_GT(system.find(adaptive(1e-3, true)).counts.rays, 0u);
}

TEST(TileExaminer, PointAndDiscHaveNothingToCorrect) {
  FormFactorOptions options;
  for (const FormFactor rule : {FormFactor::point, FormFactor::disc}) {
    options.rule = rule;
    EXPECT_FALSE(has_corrections(options));
  }
  for (const FormFactor rule : {FormFactor::adaptive, FormFactor::points}) {
    options.rule = rule;
    EXPECT_TRUE(has_corrections(options));
  }
}

// Half of what two large elements exchange is hidden; the bit of the centroids says all or nothing.
TEST(TileExaminer, AHalfHiddenPairIsHalf) {
  Scene scene = by_hand::empty_scene(Sides::one);
  by_hand::add(scene, "below", {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
  by_hand::add(scene, "above", {{0, 0, 1}, {0, 1, 1}, {1, 1, 1}, {1, 0, 1}});
  by_hand::add(scene, "blocker", {{0, 0, 0.5}, {0.5, 0, 0.5}, {0.5, 1, 0.5}, {0, 1, 0.5}});
  const ExaminedSystem system(test_scenes::finished(std::move(scene)), 2);
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
TEST(TileExaminer, PointsAreTheirPlainDoubleLoop) {
  Scene scene = by_hand::empty_scene(Sides::one);
  by_hand::add(scene, "below", {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
  by_hand::add(scene, "above", {{0, 0, 0.7}, {0, 1, 0.7}, {1, 1, 0.7}, {1, 0, 0.7}});
  const ExaminedSystem system(test_scenes::finished(std::move(scene)), 2);
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
