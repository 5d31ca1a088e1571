#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include <array>
#include <cmath>
#include <cstring>
#include <memory>
#include <numbers>
#include <numeric>

#include "core/error.hpp"
#include "core/hash.hpp"
#include "photons/photon_estimates.hpp"
#include "photons/photon_groups.hpp"
#include "photons/photon_numbers.hpp"
#include "photons/photon_renewal.hpp"
#include "photons/photon_scene.hpp"
#include "photons/tally_file.hpp"
#include "photons/trace_photons.hpp"
#include "tests/closed_forms/points.hpp"
#include "tests/unit/messages.hpp"
#include "tests/unit/test_scenes.hpp"

namespace fluxel {
namespace {

constexpr std::array kSequences{Sequence::sobol, Sequence::halton, Sequence::scrambled, Sequence::random};

/// A scene, its elements and receivers, ready for photons.
struct PhotonCase {
  explicit PhotonCase(Scene of, double max_edge = 0.5, std::vector<Receiver> with = {})
      : scene(std::move(of)),
        receivers(std::move(with)),
        mesh(test_scenes::uniform_elements(scene, max_edge)),
        rays(scene, 1),
        photons(rays, mesh, receivers) {
    const TallyShape shape = photons.shape(2, false);
    for (std::size_t k = 0; k < shape.sides; ++k) {
      const Element& element = mesh.elements[k % mesh.elements.size()];
      const bool active = (element.sides & (k < mesh.elements.size() ? kFront : kBack)) != 0;
      areas.push_back(active ? static_cast<double>(element.area) : 0);
    }
  }

  [[nodiscard]] PhotonTally traced(const PhotonPoints& points, std::uint64_t count) const {
    PhotonTally tally(photons.shape(parts_of(points.sequence), points.sequence == Sequence::random));
    trace_photons(photons, points, {0, count}, tally);
    return tally;
  }
  [[nodiscard]] SlotRange elements() const { return {0, areas, false}; }
  [[nodiscard]] std::vector<SensorEstimate> irradiance(const PhotonTally& tally) const {
    return irradiance_estimates(tally, elements(), photons.sources().power());
  }

  Scene scene;
  std::vector<Receiver> receivers;
  ElementMesh mesh;
  RayScene rays;
  PhotonScene photons;
  std::vector<double> areas;
};

/// The inside of the unit cube of one material.
Scene room(const Material& material) {
  Scene scene = by_hand::empty_scene(Sides::one);
  scene.materials[0] = material;
  by_hand::add_box(scene, "room", glm::dvec3(-0.5), glm::dvec3(0.5), false);
  return test_scenes::finished(std::move(scene));
}

Material emitting(const Rgb& rho, const SurfaceOptics& optics, Sides sides = Sides::one) {
  Material material{"all", rho, Rgb(0), sides};
  material.optics = optics;
  material.E = Rgb(1) - material.kept();
  return material;
}

/// That every side receives 1, within what the halves say.
void expect_furnace(const PhotonCase& of, const PhotonTally& tally, double most_error) {
  const IrradianceErrors errors = irradiance_errors(tally, of.elements(), of.photons.sources().power());
  for (int c = 0; c < kChannels; ++c) EXPECT_LT(errors.error[c], most_error);
  for (const SensorEstimate& side : of.irradiance(tally))
    for (int c = 0; c < kChannels; ++c)
      EXPECT_NEAR(side.mean[c], 1, 6 * errors.error[c] + 1e-3) << side.half_a[c] << " " << side.half_b[c];
}

// All even points of these sequences have a first coordinate below a half: halves by even and odd indices
// are no halves of the light.
TEST(PhotonHalves, EvenIndicesAreOneSidedAndHalvesAreNot) {
  SobolSequence sobol;
  HaltonSequence halton;
  constexpr std::uint64_t kPoints = 1 << 12;
  std::array<std::array<std::size_t, 64>, 2> counts{};
  for (std::uint64_t i = 0; i < kPoints; ++i) {
    sobol.start(i);
    halton.start(i);
    const double q = sobol.next();
    EXPECT_EQ(q < 0.5, i % 2 == 0);
    EXPECT_EQ(halton.next() < 0.5, i % 2 == 0);
    const HalvedCoordinate of = halved(q);
    ASSERT_TRUE(of.coordinate >= 0 && of.coordinate < 1);
    ++counts[of.half][static_cast<std::size_t>(64 * of.coordinate)];
  }
  for (const auto& half : counts)
    for (const std::size_t count : half) EXPECT_NEAR(static_cast<double>(count), kPoints / 128.0, 1);
}

TEST(PhotonHalves, TheSecondHalfIsMoved) {
  EXPECT_EQ(halved(0.0).half, 0u);
  EXPECT_DOUBLE_EQ(halved(0.0).coordinate, 1.0 / 3);
  EXPECT_DOUBLE_EQ(halved(0.45).coordinate, 0.9 + 1.0 / 3 - 1);
  EXPECT_EQ(halved(0.5).half, 1u);
  EXPECT_DOUBLE_EQ(halved(0.75).coordinate, 0.5);
}

TEST(Photons, AreTheSameForAnyThreadsAndParts) {
  const PhotonCase of(room(emitting(Rgb(0.5, 0.3, 0.1), {})));
  for (const Sequence sequence : kSequences) {
    const PhotonPoints points{sequence, 7};
    const PhotonTally once = of.traced(points, 20'000);
    PhotonTally parts(once.shape());
    tbb::task_arena arena(3);
    for (const PhotonRange range : {PhotonRange{12'345, 20'000}, PhotonRange{0, 1}, PhotonRange{1, 12'345}})
      arena.execute([&] { trace_photons(of.photons, points, range, parts); });
    EXPECT_TRUE(std::ranges::equal(once.values(), parts.values()));
  }
}

TEST(Photons, WhiteFurnace) {
  const PhotonCase of(room(emitting(Rgb(0.7, 0.5, 0.2), {})));
  for (const Sequence sequence : kSequences) expect_furnace(of, of.traced({sequence, 1}, 1 << 17), 0.02);
}

TEST(Photons, WhiteFurnaceOfMirrors) {
  const PhotonCase of(room(emitting(Rgb(0.2, 0.1, 0.3), {.mirror = Rgb(0.6, 0.5, 0.4)})));
  for (const Sequence sequence : kSequences) expect_furnace(of, of.traced({sequence, 1}, 1 << 17), 0.02);
}

// Of a coordinate of 0 each choice leaves 0: a photon would go on between mirrors for ever.
template <class Sequence>
void expect_no_zeros() {
  PlainPoints<Sequence> points(1);
  for (std::uint64_t index = 0; index < 1000; ++index) {
    static_cast<void>(points.start(index));
    for (std::size_t k = 0; k < Sequence::kDimensions; ++k) ASSERT_GT(points.next(), 0) << index << " " << k;
  }
}

TEST(PhotonNumbers, PlainPointsHaveNoZeros) {
  expect_no_zeros<SobolSequence>();
  expect_no_zeros<HaltonSequence>();
}

TEST(Photons, TheFirstIsAbsorbedAsAllOthers) {
  const PhotonCase of(room(emitting(Rgb(0), {.mirror = Rgb(0.9)})));
  for (const Sequence sequence : kSequences) {
    const PhotonTally first = of.traced({sequence, 1}, 1), some = of.traced({sequence, 1}, 1000);
    EXPECT_LT(first.count(PhotonCount::segments), 100u);
    EXPECT_NEAR(static_cast<double>(some.count(PhotonCount::segments)), 10'000, 1'000);
    EXPECT_EQ(some.ended(PhotonFate::lost), Rgb(0));
  }
}

// What is absorbed has the colour that surfaces do not send on, not that of the light that has come.
TEST(Photons, AbsorbedLightHasItsOwnColour) {
  Scene scene = by_hand::empty_scene(Sides::one);
  scene.materials[0].rho = Rgb(0.8, 0.5, 0.2);
  scene.materials[1] = {"light", Rgb(0), Rgb(1, 2, 3), Sides::one};
  by_hand::add_box(scene, "room", glm::dvec3(-0.5), glm::dvec3(0.5), false);
  scene.patches[1].material = by_hand::kLight;
  const PhotonCase of(test_scenes::finished(std::move(scene)));
  constexpr std::uint64_t kCount = 1 << 18;
  const Rgb absorbed = of.traced({Sequence::sobol}, kCount).ended(PhotonFate::absorbed) / double{kCount};
  for (int c = 0; c < kChannels; ++c)
    EXPECT_NEAR(absorbed[c], Rgb(0.5, 1, 1.5)[c], 3e-3) << "nothing escapes";
}

// A panel that transmits both ways stands in the room, and a body of clear glass.
TEST(Photons, WhiteFurnaceWithPanelAndGlass) {
  Scene scene = by_hand::empty_scene(Sides::one);
  scene.materials = {emitting(Rgb(0.5), {}),
                     emitting(Rgb(0.2), {Rgb(0.1), Rgb(0.4), Rgb(0.3), 0}, Sides::two),
                     {"glass", Rgb(0), Rgb(0), Sides::two}};
  scene.materials[2].optics.refraction_index = 1.5;
  by_hand::add_box(scene, "room", glm::dvec3(-0.5), glm::dvec3(0.5), false);
  by_hand::add(scene, "panel", {{-0.3, -0.3, -0.3}, {-0.3, 0.3, -0.3}, {-0.3, 0.3, 0.3}, {-0.3, -0.3, 0.3}},
               MaterialId{1});
  by_hand::add_box(scene, "glass", glm::dvec3(0, -0.2, -0.2), glm::dvec3(0.3, 0.2, 0.3), true, MaterialId{2});
  const PhotonCase of(test_scenes::finished(std::move(scene)));
  const PhotonTally tally = of.traced({Sequence::sobol}, 1 << 18);
  const std::vector<SensorEstimate> sides = of.irradiance(tally);
  for (std::size_t k = 0; k < sides.size(); ++k) {
    if (of.areas[k] == 0) continue;
    const Element& element = of.mesh.elements[k % of.mesh.elements.size()];
    // Within glass light is denser by the square of the index, where it can come in.
    const bool is_glass = of.scene.material(of.scene.patch(element.patch)).optics.bounds_clear_body();
    const double expected = is_glass && k >= of.mesh.elements.size() ? 1.5 * 1.5 : 1;
    if (is_glass && expected > 1) {
      EXPECT_GT(sides[k].mean.g, 0.9);
      EXPECT_LT(sides[k].mean.g, expected);
    } else {
      EXPECT_NEAR(sides[k].mean.g, 1, 0.04) << k;
    }
  }
}

// Power is neither lost nor made: what was sent has left the scene or been absorbed.
TEST(Photons, EndAsManyAsWereSent) {
  Scene scene = by_hand::empty_scene(Sides::one);
  scene.materials[1] = {"light", Rgb(0.1), Rgb(3, 2, 1), Sides::one};
  by_hand::add_box(scene, "room", glm::dvec3(-0.5), glm::dvec3(0.5), false);
  scene.patches.erase(scene.patches.begin() + 2);
  scene.patches[0].material = by_hand::kLight;
  const PhotonCase of(test_scenes::finished(std::move(scene)));
  constexpr std::uint64_t kCount = 1 << 14;
  const PhotonTally tally = of.traced({Sequence::sobol}, kCount);
  const Rgb escaped = tally.ended(PhotonFate::escaped), absorbed = tally.ended(PhotonFate::absorbed);
  EXPECT_GT(escaped.g, 0.05 * kCount);
  EXPECT_NEAR(mean_of_colours(escaped + absorbed), kCount, 0.01) << "the scalar power of each is constant";
  EXPECT_EQ(tally.ended(PhotonFate::lost), Rgb(0));
  EXPECT_LT(tally.count(PhotonCount::met), tally.count(PhotonCount::sent)) << "some leave at once";
  EXPECT_GT(tally.count(PhotonCount::met), tally.count(PhotonCount::sent) / 2);
}

// Mirrors and glass take no coordinate: the next choice has what theirs has left (equation 13).
TEST(Photons, CoordinatesAreSpared) {
  Scene scene = by_hand::empty_scene(Sides::two);
  scene.materials[0] = {"half", Rgb(0), Rgb(0), Sides::two};
  scene.materials[0].optics.transmission = Rgb(0.5);
  by_hand::add(scene, "lamp", {{0, 0, 9}, {0, 1, 9}, {1, 1, 9}, {1, 0, 9}}, by_hand::kLight);
  for (int k = 0; k < 5; ++k) {
    const double z = k;
    by_hand::add(scene, "plate", {{-99, -99, z}, {99, -99, z}, {99, 99, z}, {-99, 99, z}});
  }
  const PhotonCase of(test_scenes::finished(std::move(scene)), 1000);
  const PhotonTally tally = of.traced({Sequence::halton}, 1 << 12);
  EXPECT_GT(tally.count(PhotonCount::segments), 3u * 1900);
  EXPECT_LE(tally.count(PhotonCount::coordinates), 5u << 12)
      << "four of the emission, one of the first plate";
}

// A half is a whole number of a point's digits: what a choice leaves of it is 0, and the direction of 0 lies
// in the surface.
TEST(Photons, LeaveTheSurface) {
  for (const double u : {0.0, 0.5, 1.0})
    for (const double v : {0.0, 0.5, 1.0})
      EXPECT_GT(even_direction(u, v, {0, 0, 1}).z, 1e-5) << u << " " << v;
}

// An open grid under a lamp: what goes through its cells is what falls there, by the closed form.
TEST(Photons, ReceiversHaveTheIrradianceOfTheirCells) {
  Scene scene = by_hand::empty_scene(Sides::one);
  by_hand::add(scene, "lamp", {{0, 0, 1}, {0, 1, 1}, {1, 1, 1}, {1, 0, 1}}, by_hand::kLight);
  Receiver grid;
  grid.name = "grid";
  grid.origin = {-0.5, 0, 0.25};
  grid.u = {2, 0, 0};
  grid.v = {0, 0.5, 0};
  grid.columns = 40;
  grid.rows = 10;
  grid.unmeasured.assign(grid.size(), 0);
  grid.unmeasured[3] = 1;
  const PhotonCase of(test_scenes::finished(std::move(scene)), 1, {grid});
  for (const Sequence sequence : kSequences) {
    const PhotonTally tally = of.traced({sequence, 3}, 1 << 18);
    std::vector<double> areas(grid.size(), 1.0 / static_cast<double>(grid.size()));
    areas[3] = 0;
    const SlotRange cells{tally.shape().first_cell(0), areas, sequence == Sequence::random};
    const auto found = irradiance_estimates(tally, cells, of.photons.sources().power());
    const IrradianceErrors errors = irradiance_errors(tally, cells, of.photons.sources().power());
    double squares = 0;
    for (std::size_t cell = 0; cell < grid.size(); ++cell) {
      if (areas[cell] == 0) {
        EXPECT_EQ(found[cell].mean.g, 0);
        continue;
      }
      const glm::dvec3 at = grid.place(cell, 0.5, 0.5);
      const double exact =
          closed_forms::point_to_parallel_rectangle({0 - at.x, 1 - at.x, 0 - at.y, 1 - at.y}, 0.75);
      squares += std::pow(found[cell].mean.g - exact, 2);
      if (knows_each_error(tally, cells)) {
        EXPECT_NEAR(found[cell].mean.g, exact, 5.5 * found[cell].error.g + 1e-3);
      }
    }
    // The errors' root mean square is what is said of them.
    const double actual = std::sqrt(squares / static_cast<double>(grid.size() - 1));
    EXPECT_NEAR(errors.error.g / actual, 1, 0.25) << static_cast<int>(sequence);
    EXPECT_LT(errors.error.g, 0.03);
  }
}

/// A tally file and what it belongs to.
struct KeptTally {
  KeptTally()
      : of(room(emitting(Rgb(0.5), {}))),
        key{photon_identity(of.rays, of.mesh, {}), {Sequence::scrambled, 5}},
        tally(of.traced(key.points, 1000)),
        bytes(tally_file(key, tally)) {}

  [[nodiscard]] std::string defect(const std::string& read, const TallyKey& with) const {
    return read_tally_file(std::as_bytes(std::span(read)), with, tally.shape()).defect;
  }

  PhotonCase of;
  TallyKey key;
  PhotonTally tally;
  std::string bytes;
};

TEST(TallyFile, GoesOnWhereItWas) {
  const KeptTally kept;
  TallyFileResult read = read_tally_file(std::as_bytes(std::span(kept.bytes)), kept.key, kept.tally.shape());
  ASSERT_TRUE(read.tally) << read.defect;
  trace_photons(kept.of.photons, kept.key.points, {1000, 3000}, *read.tally);
  EXPECT_TRUE(std::ranges::equal(read.tally->values(), kept.of.traced(kept.key.points, 3000).values()));
}

TEST(TallyFile, SaysWhatItDoesNotBelongTo) {
  const KeptTally kept;
  TallyKey other = kept.key;
  other.points.seed = 6;
  EXPECT_EQ(kept.defect(kept.bytes, other), "is of another --seed");
  other = kept.key;
  other.points.sequence = Sequence::sobol;
  EXPECT_EQ(kept.defect(kept.bytes, other), "is of another --sequence");
  other = kept.key;
  other.identity ^= 1;
  EXPECT_TRUE(kept.defect(kept.bytes, other).starts_with("is of another scene"));
  EXPECT_EQ(kept.defect("", kept.key), "is too short to be a tally of photons");
}

// A header that is whole, of a format to come.
TEST(TallyFile, SaysThatItIsOfAnotherVersion) {
  const KeptTally kept;
  std::string other = kept.bytes;
  constexpr std::size_t kVersion = 8, kCheck = 56;
  other[kVersion] = 7;
  const std::uint64_t check = hash_bytes(std::as_bytes(std::span(other)).first(kCheck));
  std::memcpy(other.data() + kCheck, &check, sizeof check);
  EXPECT_EQ(kept.defect(other, kept.key), "is of another version of the format (7 where 1 is needed)");
}

TEST(TallyFile, EveryDamageIsSeen) {
  const KeptTally kept;
  EXPECT_EQ(kept.defect(kept.bytes.substr(0, kept.bytes.size() - 1), kept.key), "is damaged or cut off");
  EXPECT_EQ(kept.defect(kept.bytes + "x", kept.key), "is damaged or cut off");
  for (std::size_t at = 0; at < kept.bytes.size(); at += at < 100 ? 1 : 997) {
    std::string damaged = kept.bytes;
    damaged[at] = static_cast<char>(damaged[at] ^ 0x10);
    EXPECT_NE(kept.defect(damaged, kept.key), "") << at;
  }
}

TEST(TallyFile, IdentityIsOfAllThatPhotonsMeet) {
  const auto identity = [](const Material& material, double max_edge,
                           const std::vector<Receiver>& receivers) {
    const PhotonCase of(room(material), max_edge, receivers);
    return photon_identity(of.rays, of.mesh, of.receivers);
  };
  const Material plain = emitting(Rgb(0.5), {});
  const std::uint64_t same = identity(plain, 0.5, {});
  EXPECT_EQ(identity(plain, 0.5, {}), same);
  EXPECT_NE(identity(plain, 0.25, {}), same);
  EXPECT_NE(identity(emitting(Rgb(0.4), {}), 0.5, {}), same);
  Material other = plain;
  other.E = Rgb(2);
  EXPECT_NE(identity(other, 0.5, {}), same);
  other = plain;
  other.optics.mirror = Rgb(0.1);
  EXPECT_NE(identity(other, 0.5, {}), same);
  Receiver grid;
  grid.u = {1, 0, 0}, grid.v = {0, 1, 0};
  EXPECT_NE(identity(plain, 0.5, {grid}), same);
}

TEST(PhotonTally, HasRoomForSixtyTwoBits) {
  PhotonTally tally(TallyShape{2, 1, {}, false});
  EXPECT_TRUE(tally.has_room_for(PhotonTally::kMostPhotons));
  tally.add(PhotonCount::sent, 1'000'000);
  tally.add(0, 0, Rgb(1e11));
  EXPECT_TRUE(tally.has_room_for(1'000'000));
  EXPECT_FALSE(tally.has_room_for(100'000'000));
}

// After a change of the scene: what is renewed photon by photon is in the end what the new scene has.
TEST(PhotonRenewal, EndsWithTheNewScene) {
  const auto furnished = [](double x, double rho) {
    Scene scene = by_hand::empty_scene(Sides::two);
    by_hand::add_box(scene, "room", glm::dvec3(-2), glm::dvec3(2), false);
    scene.patches[1].material = by_hand::kLight;
    scene.materials.push_back({"thing", Rgb(rho), Rgb(0), Sides::two});
    by_hand::add_box(scene, "box", glm::dvec3(x, -0.5, -1), glm::dvec3(x + 0.7, 0.5, 0.5), true,
                     MaterialId{2});
    return test_scenes::finished(std::move(scene));
  };
  Receiver grid;
  grid.origin = {-1.5, -1.5, -1.5};
  grid.u = {3, 0, 0}, grid.v = {0, 3, 0};
  grid.columns = grid.rows = 5;
  const PhotonCase before(furnished(-1, 0.5), 0.6, {grid}), after(furnished(0.2, 0.3), 0.6, {grid});
  constexpr std::uint64_t kCount = 20'000;
  const PhotonPoints points{Sequence::halton};
  const PhotonTally old = before.traced(points, kCount), expected = after.traced(points, kCount);
  const PhotonRenewal renewal(
      before.photons, after.photons,
      PhotonRenewal::same_slots(before.mesh, old.shape(), after.mesh, expected.shape()));
  PhotonTally tally = renewal.taken_over(old);
  EXPECT_FALSE(std::ranges::equal(tally.values(), expected.values()));
  const std::uint64_t groups = coherent_groups(100).back();
  std::uint64_t changed = 0;
  for (std::uint64_t group = 0; group < groups; ++group)
    changed += renewal.renew({group, kCount, groups}, tally, [](std::uint64_t) {});
  EXPECT_GT(changed, kCount / 100);
  EXPECT_LT(changed, kCount * 9 / 10);
  EXPECT_TRUE(std::ranges::equal(tally.values(), expected.values()));
}

TEST(PhotonRenewal, NothingChangesWhereNothingHas) {
  const PhotonCase of(room(emitting(Rgb(0.5), {})));
  const PhotonTally tally = of.traced({Sequence::halton}, 5000);
  const PhotonRenewal renewal(of.photons, of.photons,
                              PhotonRenewal::same_slots(of.mesh, tally.shape(), of.mesh, tally.shape()));
  PhotonTally same = renewal.taken_over(tally);
  EXPECT_EQ(renewal.renew({0, 5000, 1}, same, [](std::uint64_t) {}), 0u);
  EXPECT_TRUE(std::ranges::equal(same.values(), tally.values()));
}

// Equation 17: the coordinates of a group's points lie in one cell of the emission.
TEST(PhotonGroups, SetOutAlike) {
  EXPECT_EQ(coherent_groups(1), std::vector<std::uint64_t>{1});
  EXPECT_EQ(coherent_groups(209), (std::vector<std::uint64_t>{1, 2, 6, 30})) << "sevenths would make 210";
  EXPECT_EQ(coherent_groups(420).back(), 420u);
  const std::uint64_t groups = coherent_groups(10'000).back();
  std::uint64_t rest = groups;
  std::array<double, 4> widths{};
  constexpr std::array<std::uint64_t, 4> kBases{2, 3, 5, 7};
  for (std::size_t k = 0; k < 4; ++k) {
    widths[k] = 1;
    for (; rest % kBases[k] == 0; rest /= kBases[k]) widths[k] /= static_cast<double>(kBases[k]);
  }
  EXPECT_EQ(rest, 1u);
  HaltonSequence halton;
  for (const std::uint64_t first : {0u, 1u, 4711u})
    for (std::size_t k = 0; k < 4; ++k) {
      double low = 1, high = 0;
      for (std::uint64_t m = 0; m < 200; ++m) {
        halton.start(first + m * groups);
        double q = 0;
        for (std::size_t c = 0; c <= k; ++c) q = halton.next();
        low = std::min(low, q);
        high = std::max(high, q);
      }
      EXPECT_LT(high - low, widths[k]);
      EXPECT_GT(high - low, 0.5 * widths[k]);
    }
}

// A group of which little is known is expected to be like those that set out nearly alike.
TEST(PhotonGroups, ExpectWhatTheirNeighboursSay) {
  const std::vector<std::uint64_t> partings{1, 2, 6};
  GroupCounts counts{std::vector<std::uint64_t>(6, 10), {10, 0, 10, 0, 0, 0}};
  counts.gone[4] = 0;
  const std::vector<double> shares = expected_shares(partings, counts);
  EXPECT_GT(shares[0], 0.8);
  EXPECT_GT(shares[4], 0.7) << "of which nothing is known but that 0 and 2 set out like it";
  EXPECT_LT(shares[1], 0.15);
  counts.gone[4] = 1;
  EXPECT_GT(expected_shares(partings, counts)[4], 0.4) << "one photon says less than its neighbours";
  counts.gone[4] = 1000;
  EXPECT_LT(expected_shares(partings, counts)[4], 0.01) << "its own photons count";
}

// Heat that is drawn is no power that photons could bring.
TEST(PhotonSources, RefuseNegativePower) {
  Scene scene = room(emitting(Rgb(0.5), {}));
  scene.materials[0].E = Rgb(-1);
  const RayScene rays(scene, 1);
  try {
    const PhotonSources sources(rays);
    FAIL() << "no error";
  } catch (const InputError& error) {
    test_messages::expect_words(error.what(), {"'all'", "draws heat"});
  }
}

}  // namespace
}  // namespace fluxel
