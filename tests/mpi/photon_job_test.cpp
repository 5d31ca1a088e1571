#include "mpi_master/steps/photon_job.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "core/progress.hpp"
#include "mpi_master/steps/renewal_job.hpp"
#include "photons/photon_groups.hpp"
#include "small_scenes.hpp"
#include "subdivision/subdivide.hpp"
#include "world.hpp"

namespace fluxel::test {
namespace {

/// A scene of the project, its elements, and what decides on the end.
struct Lit {
  explicit Lit(Scene of) : scene(std::move(of)), rays(scene, 1) {
    SplitCriterion criterion;
    criterion.max_edge = 0.2;
    mesh = subdivide_pieces(scene, 0, scene.pieces.size(), {}, criterion).mesh;
    photons.emplace(rays, mesh, std::span<const Receiver>());
    for (std::size_t k = 0; k < photons->shape(2, false).sides; ++k)
      areas.push_back(static_cast<double>(mesh.elements[k % mesh.elements.size()].area));
    kinds = {{"elements", 0, {0, areas, false}, true}};
  }

  [[nodiscard]] PhotonResult sent(const Communicator& by, const PhotonGoal& goal, PhotonTally& tally,
                                  int threads = 1) const {
    SilentProgress silent;
    return send_photons({by, threads, silent}, *photons, kinds, goal, tally, 1e9, [](const PhotonTally&) {});
  }
  [[nodiscard]] PhotonTally empty(const PhotonGoal& goal) const {
    return PhotonTally(photons->shape(parts_of(goal.points.sequence), false));
  }

  Scene scene;
  RayScene rays;
  ElementMesh mesh;
  std::optional<PhotonScene> photons;
  std::vector<double> areas;
  std::vector<PhotonKind> kinds;
};

Lit lit() { return Lit(scene_of(scene_request("cornell-box", {"--resolution", "8x8"}))); }

PhotonGoal goal_of(Sequence sequence, std::optional<std::uint64_t> photons) {
  PhotonGoal goal;
  goal.points = {sequence, 3};
  goal.limits.photons = photons;
  return goal;
}

Communicator alone() { return world().split(world().rank()).ordered_by_hosts(0); }

TEST(PhotonJob, EqualsOneRankAlone) {
  const Lit of = lit();
  const Communicator one = alone();
  for (const Sequence sequence : {Sequence::sobol, Sequence::halton, Sequence::scrambled, Sequence::random})
    for (const std::uint64_t photons : {1u, 5u, 70'001u}) {
      const PhotonGoal goal = goal_of(sequence, photons);
      PhotonTally expected = of.empty(goal), tally = of.empty(goal);
      const PhotonResult result = of.sent(world(), goal, tally, 2);
      EXPECT_EQ(of.sent(one, goal, expected).turns.size(), result.turns.size());
      EXPECT_EQ(tally.count(PhotonCount::sent), photons);
      EXPECT_EQ(result.ending, PhotonEnding::photons);
      EXPECT_TRUE(std::ranges::equal(tally.values(), expected.values()));
    }
}

TEST(PhotonJob, EndsAtTheTargetErrorAndGoesOn) {
  const Lit of = lit();
  PhotonGoal goal = goal_of(Sequence::sobol, {});
  goal.limits.error.target_error = 0.05;
  PhotonTally tally = of.empty(goal);
  const PhotonResult result = of.sent(world(), goal, tally);
  EXPECT_TRUE(result.reached);
  EXPECT_EQ(result.ending, PhotonEnding::target);
  EXPECT_LE(relative_error(result.turns.back().errors[0]), 0.05);
  const std::uint64_t sent = tally.count(PhotonCount::sent);
  EXPECT_EQ(of.sent(world(), goal, tally).turns.size(), 1u) << "what has been restored will do";
  EXPECT_EQ(tally.count(PhotonCount::sent), sent);
  goal.limits.error.target_error = 0.03;
  const PhotonResult more = of.sent(world(), goal, tally);
  EXPECT_EQ(more.restored, sent);
  PhotonTally expected = of.empty(goal);
  static_cast<void>(of.sent(world(), goal_of(Sequence::sobol, tally.count(PhotonCount::sent)), expected));
  EXPECT_TRUE(std::ranges::equal(tally.values(), expected.values()));
}

TEST(PhotonJob, EndsWhenSoManyHaveCome) {
  const Lit of = lit();
  PhotonGoal goal = goal_of(Sequence::halton, {});
  goal.limits.received = 1'000'000;
  PhotonTally tally = of.empty(goal);
  const PhotonResult result = of.sent(world(), goal, tally);
  EXPECT_EQ(result.ending, PhotonEnding::received);
  EXPECT_GE(tally.received(0), 1'000'000u);
  EXPECT_LT(tally.received(0), 1'300'000u);
}

// Of the backs of a one-sided scene nothing is known, however often it is looked at.
TEST(PhotonJob, WaitsInVainForWhatIsNotLit) {
  Lit of = lit();
  const std::vector<double> unlit(of.areas.size(), 0.0);
  of.kinds.push_back({"unlit", 1, {0, unlit, false}, true});
  PhotonGoal goal = goal_of(Sequence::sobol, {});
  goal.limits.error.target_error = 0.1;
  PhotonTally tally(TallyShape{2, of.areas.size(), {1}, false});
  const PhotonResult both = of.sent(world(), goal, tally);
  EXPECT_EQ(both.ending, PhotonEnding::target);
  EXPECT_FALSE(both.reached) << "what is asked of one of both is not known";
}

TEST(PhotonJob, EndsInTime) {
  const Lit of = lit();
  PhotonGoal goal = goal_of(Sequence::sobol, {});
  goal.limits.seconds = 1e-3;
  PhotonTally tally = of.empty(goal);
  EXPECT_EQ(of.sent(world(), goal, tally).ending, PhotonEnding::time);
  EXPECT_LT(tally.count(PhotonCount::sent), 20'000u);
}

TEST(PhotonJob, RefusesMoreThanSumsHaveRoomFor) {
  EXPECT_EQ(refused_photons(goal_of(Sequence::sobol, PhotonTally::kMostPhotons)), "");
  EXPECT_NE(refused_photons(goal_of(Sequence::sobol, PhotonTally::kMostPhotons + 1)), "");
  EXPECT_NE(refused_photons(goal_of(Sequence::scrambled, PhotonTally::kMostPhotons)), "");
}

// The light of another reflectance, from photons of this one.
TEST(RenewalJob, EndsWithTheNewScene) {
  const Lit before = lit();
  Scene changed = before.scene;
  changed.materials[index(changed.patch(PatchId{2}).material)].rho *= 0.5;
  const Lit after(std::move(changed));
  const PhotonGoal goal = goal_of(Sequence::halton, 50'000);
  PhotonTally old = before.empty(goal), expected = after.empty(goal);
  static_cast<void>(before.sent(world(), goal, old));
  static_cast<void>(after.sent(world(), goal, expected));
  const PhotonRenewal renewal(
      *before.photons, *after.photons,
      PhotonRenewal::same_slots(before.mesh, old.shape(), after.mesh, expected.shape()));
  for (const std::uint64_t most : {1u, 60u, 3'000u, 100'000u}) {
    PhotonTally tally = renewal.taken_over(old);
    SilentProgress silent;
    const RenewalResult result =
        renew_photons({world(), 2, silent}, renewal, {50'000, coherent_groups(most), {}, {}}, tally,
                      [](const PhotonTally&) {});
    EXPECT_TRUE(result.complete());
    EXPECT_EQ(result.turns.back().renewed, 50'000u);
    EXPECT_EQ(result.turns.back().left, 0);
    // Of those that are left as many are expected as there turn out to be, by what pilots can tell of all.
    const double pilots = static_cast<double>(result.pilots), all = static_cast<double>(result.photons);
    for (const RenewalTurn& turn : most > 1 ? result.turns : std::vector<RenewalTurn>())
      EXPECT_NEAR(turn.left, static_cast<double>(result.turns.back().changed - turn.changed),
                  4 * 0.5 * all / std::sqrt(pilots))
          << most << " groups, after " << turn.groups;
    EXPECT_TRUE(std::ranges::equal(tally.values(), expected.values()));
  }
}

}  // namespace
}  // namespace fluxel::test
