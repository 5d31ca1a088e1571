#include "mpi_master/steps/subdivision_job.hpp"
#include "core/options.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cstring>
#include <fstream>
#include <map>

#include "core/hash.hpp"
#include "host_shapes.hpp"
#include "mpi_master/communication/agreement.hpp"
#include "mpi_master/steps/forecast.hpp"
#include "small_scenes.hpp"
#include "subdivision/camera_raster.hpp"
#include "subdivision/subdivide.hpp"
#include "world.hpp"

namespace fluxel::test {
namespace {

template <class A, class B>
bool same_bytes(const A& a, const B& b) {
  return std::ranges::equal(std::as_bytes(std::span(a)), std::as_bytes(std::span(b)));
}

struct SerialSubdivision {
  SubdividedPieces pieces;
  Raster raster;
};

/// The whole scene on one rank, without merging.
SerialSubdivision subdivide_serially(const Scene& scene, const Options& options) {
  SerialSubdivision serial;
  std::vector<SeenPoint> points;
  if (options.camera) {
    const RayScene all(scene, 1);
    const auto nearest = nearest_depths(all, scene, *options.camera, options.supersample, 1);
    const auto claims = claim_pixels(all, scene, *options.camera, options.supersample, nearest, 1);
    serial.raster = make_raster(scene, *options.camera, options.supersample, claims);
    points = seen_points(scene, *options.camera, options.supersample, serial.raster);
  }
  SplitCriterion criterion;
  if (options.subdivision == Subdivision::camera) {
    criterion.max_pixels = 1;
    criterion.max_edge = options.max_edge.value_or(default_max_edge(scene, points.size()));
  } else if (options.subdivision == Subdivision::uniform) {
    criterion.max_edge = *options.max_edge;
  }
  serial.pieces = subdivide_pieces(scene, 0, scene.pieces.size(), points, criterion);
  return serial;
}

TEST(SubdivisionJob, EqualsTheSubdivisionOfTheWholeScene) {
  for (const NamedRequest& named : small_requests()) {
    const Scene scene = scene_of(named.request);
    const SerialSubdivision serial = subdivide_serially(scene, named.request.options);
    for (const HostShape& shape : host_shapes()) {
      SCOPED_TRACE(shape.name + ", " + named.name);
      const SubdividedScene result = subdivide_scene(shape.world, scene, named.request.options, 1);
      EXPECT_TRUE(same_bytes(result.mesh.elements, serial.pieces.mesh.elements));
      EXPECT_TRUE(same_bytes(result.mesh.outlines, serial.pieces.mesh.outlines));
      EXPECT_EQ(result.max_depth, serial.pieces.max_depth);
      EXPECT_TRUE(same_bytes(result.raster.patch, serial.raster.patch));
      EXPECT_TRUE(same_bytes(result.raster.depth, serial.raster.depth));
      EXPECT_TRUE(same_bytes(result.raster.front, serial.raster.front));
      std::vector<ElementId> element(serial.raster.pixels(), kNoElement);
      for (std::size_t k = 0; k < serial.pieces.pixels.size(); ++k)
        element[serial.pieces.pixels[k]] = ElementId{serial.pieces.pixel_element[k]};
      EXPECT_TRUE(same_bytes(result.raster.element, element));
      EXPECT_EQ(result.hash, hash_bytes(std::as_bytes(std::span(serial.pieces.mesh.outlines)),
                                        hash_bytes(std::as_bytes(std::span(serial.pieces.mesh.elements)))));
    }
  }
}

TEST(SubdivisionJob, AnElementOwnsAtMostOnePixelAndLiesOnThePatchThatThePixelSees) {
  const SolveRequest request = scene_request("cornell-box", {"--resolution", "24x24"});
  const Scene scene = scene_of(request);
  for (const Subscenes subscenes : {Subscenes::merged, Subscenes::independent}) {
    Options options = request.options;
    options.subscenes = subscenes;
    const SubdividedScene result = subdivide_scene(world(), scene, options, 1);
    std::map<ElementId, int> owners;
    std::size_t wrong_patch = 0, seen = 0;
    for (std::size_t pixel = 0; pixel < result.raster.pixels(); ++pixel) {
      const ElementId id = result.raster.element[pixel];
      ASSERT_EQ(id == kNoElement, result.raster.patch[pixel] == kNoPatch) << "pixel " << pixel;
      if (id == kNoElement) continue;
      ++seen;
      ++owners[id];
      if (result.mesh.elements[index(id)].patch != result.raster.patch[pixel]) ++wrong_patch;
    }
    EXPECT_GT(seen, result.raster.pixels() / 2);
    EXPECT_EQ(wrong_patch, 0u);
    EXPECT_TRUE(std::ranges::all_of(owners, [](const auto& entry) { return entry.second == 1; }));
  }
}

TEST(SubdivisionJob, IndependentSubscenesSplitAtLeastAsMuch) {
  const SolveRequest request = scene_request("cornell-box", {"--resolution", "24x24"});
  const Scene scene = scene_of(request);
  Options options = request.options;
  const SubdividedScene merged = subdivide_scene(world(), scene, options, 1);
  options.subscenes = Subscenes::independent;
  const SubdividedScene independent = subdivide_scene(world(), scene, options, 1);
  EXPECT_TRUE(same_bytes(independent.raster.patch, merged.raster.patch)) << "the picture is the same";
  if (world().size() == 1) {
    EXPECT_EQ(independent.hash, merged.hash);
  } else {
    // The blocks hide floor and walls, and belong to other ranks' sub-scenes than all of these.
    EXPECT_GT(independent.mesh.elements.size(), merged.mesh.elements.size());
  }
}

TEST(SubdivisionJob, ACameraThatSeesNothingIsEverybodysError) {
  const SolveRequest request =
      scene_request("cornell-box", {"--resolution", "8x8", "--look-at", "0.278,0.273,-9"});
  EXPECT_THROW(static_cast<void>(subdivide_scene(world(), scene_of(request), request.options, 1)),
               AgreedError);
}

TEST(SubdivisionJob, WhatFollowsIsRefusedBeforeTheElementsAreMade) {
  // Some four million.
  const SolveRequest request =
      scene_request("cornell-box", {"--subdivision", "uniform", "--max-edge", "1e-3"});
  const auto too_much = [](std::size_t elements) { return std::uint64_t{elements} << 40; };
  try {
    static_cast<void>(subdivide_scene(world(), scene_of(request), request.options, 1, too_much));
    FAIL() << "there is no such memory";
  } catch (const AgreedError& error) {
    EXPECT_NE(std::string(error.what()).find("not enough memory: the visibility of the elements"),
              std::string::npos)
        << error.what();
  }
}

/// Leaves this process so much more memory than it has, as long as this lives.
class LimitedMemory {
 public:
  explicit LimitedMemory(std::uint64_t more) {
    getrlimit(RLIMIT_AS, &before_);
    rlimit limit = before_;
    std::ifstream pages("/proc/self/statm");
    pages >> limit.rlim_cur;
    limit.rlim_cur = limit.rlim_cur * static_cast<rlim_t>(sysconf(_SC_PAGESIZE)) + more;
    setrlimit(RLIMIT_AS, &limit);
  }
  ~LimitedMemory() { setrlimit(RLIMIT_AS, &before_); }
  LimitedMemory(const LimitedMemory&) = delete;
  LimitedMemory& operator=(const LimitedMemory&) = delete;

 private:
  rlimit before_{};
};

TEST(SubdivisionJob, NeedsRoomForItsElementsAlone) {
  // Of one rank: a sanitizer maps more than any limit, and shares of several are smaller.
  if (ranks() != 1) return;
  const SolveRequest request = scene_request("cornell-box", {"--resolution", "512x512"});
  const Scene scene = scene_of(request);
  constexpr std::uint64_t kRoom = 220'000'000;
  const LimitedMemory limited(kRoom);
  const std::size_t elements = subdivide_scene(world(), scene, request.options, 1).mesh.elements.size();
  EXPECT_GT(least_bytes(world(), elements), kRoom) << "a matrix would not fit";
}

}  // namespace
}  // namespace fluxel::test
