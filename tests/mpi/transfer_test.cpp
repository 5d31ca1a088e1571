#include "mpi_master/communication/transfer.hpp"
#include "core/options.hpp"

#include <gtest/gtest.h>

#include <tuple>

#include "small_scenes.hpp"
#include "world.hpp"

// A type's members are bound by name, one by one: where one is added these lines no longer compile, so that
// it can be forgotten neither here nor in the transfer.
namespace fluxel {

template <class Vec>
bool operator==(const Outline<Vec>& a, const Outline<Vec>& b) {
  return a.corners == b.corners && a.corner == b.corner;
}

inline auto members(const Camera& c) {
  const auto& [eye, look_at, up, fov, width, height, name] = c;
  return std::tie(eye, look_at, up, fov, width, height, name);
}
inline bool operator==(const Camera& a, const Camera& b) { return members(a) == members(b); }

inline auto members(const Options& o) {
  const auto& [scene, metres_per_unit, out, write, camera, supersample, antialias, median_radius, exposure,
               tone, false_colour, maintenance_factor, sides, ke, textures, specular, thermal, cut, merge,
               every_pair, method, solution, target_error, error_of, block_error, oracle, exchange, picture,
               memory, seconds, subdivision, max_edge, mesh_max_edge, lightmap_texel, subscenes, form_factor,
               solver, tolerance, share, max_iterations, warm_start, preview, error_estimate, audit,
               keep_links, checkpoint, checkpoint_every, resume, visibility_only, reuse_visibility, threads,
               isa, device, verify_device, quiet, live, command, dry_run, timeline] = o;
  return std::tie(scene, metres_per_unit, out, write, camera, supersample, antialias, median_radius, exposure,
                  tone, false_colour.max, false_colour.decades, maintenance_factor, sides, ke, textures,
                  specular, thermal, cut, merge, every_pair, method, solution, target_error, error_of,
                  block_error, oracle, exchange, picture, memory, seconds, subdivision, max_edge,
                  mesh_max_edge, lightmap_texel, subscenes, form_factor, solver, tolerance, share,
                  max_iterations, warm_start, preview, error_estimate, audit, keep_links, checkpoint,
                  checkpoint_every, resume, visibility_only, reuse_visibility, threads, isa, device,
                  verify_device, quiet, live, command, dry_run, timeline);
}

inline auto members(const ViewFactorOptions& o) {
  const auto& [scene, metres_per_unit, out, write, tolerance, sides, specular, cut, merge, threads, quiet,
               command] = o;
  return std::tie(scene, metres_per_unit, out, write, tolerance, sides, specular, cut, merge, threads, quiet,
                  command);
}

inline auto members(const ErrorLimits& l) {
  const auto& [target_error, absolute_error, of] = l;
  return std::tie(target_error, absolute_error, of);
}
inline bool operator==(const ErrorLimits& a, const ErrorLimits& b) { return members(a) == members(b); }

inline auto members(const ReferenceLimits& l) {
  const auto& [error, seconds, rays] = l;
  return std::tie(error, seconds, rays);
}

inline auto members(const PhotonLimits& l) {
  const auto& [error, seconds, photons, received] = l;
  return std::tie(error, seconds, photons, received);
}

inline auto members(const PhotonOptions& o) {
  const auto& [run, elements, only, sequence, limits, seed, changed_from, groups] = o;
  return std::tie(elements, only, sequence, seed, changed_from, groups);
}

inline auto members(const ReferenceOptions& o) {
  const auto& [run, elements, supersample, only, limits, sampling, seed] = o;
  return std::tie(elements, supersample, only, sampling, seed);
}

inline auto members(const Receiver& r) {
  const auto& [name, quantity, origin, u, v, columns, rows, points, unmeasured, direction, facing,
               half_angle] = r;
  return std::tie(name, quantity, origin, u, v, columns, rows, points, unmeasured, direction, facing,
                  half_angle);
}
inline bool operator==(const Receiver& a, const Receiver& b) { return members(a) == members(b); }

inline auto members(const Observer& o) {
  const auto& [name, eye, direction, up] = o;
  return std::tie(name, eye, direction, up);
}
inline bool operator==(const Observer& a, const Observer& b) { return members(a) == members(b); }

inline auto members(const LightingTask& t) {
  const auto& [name, area, surrounding, background, illuminance, U0, UGR, observers] = t;
  return std::tie(name, area, surrounding, background, illuminance, U0, UGR, observers);
}
inline bool operator==(const LightingTask& a, const LightingTask& b) { return members(a) == members(b); }

inline auto members(const Luminaire& l) {
  const auto& [name, position, aim, ahead, size, round, intensity, scale] = l;
  return std::tie(name, position, aim, ahead, size, round, intensity, scale);
}
inline bool operator==(const Luminaire& a, const Luminaire& b) { return members(a) == members(b); }

inline auto members(const IntensityTable& t) {
  const auto& [C, gamma, intensity] = t;
  return std::tie(C, gamma, intensity);
}
inline bool operator==(const IntensityTable& a, const IntensityTable& b) { return members(a) == members(b); }

inline auto members(const Patch& p) {
  const auto& [outline, normal, area, material, group, sides, covers_emitter] = p;
  return std::tie(outline, normal, area, material, group, sides, covers_emitter);
}
inline bool operator==(const Patch& a, const Patch& b) { return members(a) == members(b); }

inline auto members(const Piece& p) {
  const auto& [outline, patch] = p;
  return std::tie(outline, patch);
}
inline bool operator==(const Piece& a, const Piece& b) { return members(a) == members(b); }

inline auto members(const ThermalSurface& s) {
  const auto& [emissivity, temperature, heat_flux, convection_coefficient, air_temperature] = s;
  return std::tie(emissivity, temperature, heat_flux, convection_coefficient, air_temperature);
}
inline bool operator==(const ThermalSurface& a, const ThermalSurface& b) { return members(a) == members(b); }

inline auto members(const SurfaceOptics& o) {
  const auto& [mirror, transmission, diffuse_transmission, refraction_index] = o;
  return std::tie(mirror, transmission, diffuse_transmission, refraction_index);
}

inline auto members(const Material& m) {
  const auto& [name, rho, E, sides, thermal, optics] = m;
  return std::tie(name, rho, E, sides, thermal, optics);
}
inline bool operator==(const Material& a, const Material& b) { return members(a) == members(b); }

inline auto members(const SceneStatistics& f) {
  const auto& [faces_read, degenerate_faces, nonplanar_faces, merged_patches, components, closed_components,
               boundary_edges, nonmanifold_edges, flipped_edges, coplanar_overlaps, cut_patches, sealed_sides,
               covered_area, closed, lit_inside, convex] = f;
  return std::tie(faces_read, degenerate_faces, nonplanar_faces, merged_patches, components,
                  closed_components, boundary_edges, nonmanifold_edges, flipped_edges, coplanar_overlaps,
                  cut_patches, sealed_sides, covered_area, closed, lit_inside, convex);
}
inline bool operator==(const SceneStatistics& a, const SceneStatistics& b) {
  return members(a) == members(b);
}

namespace test {
namespace {

/// Element by element of the tuples, so that a failure names the member's place.
template <std::size_t k = 0, class Tuple>
void expect_equal_members(const Tuple& a, const Tuple& b) {
  if constexpr (k < std::tuple_size_v<Tuple>) {
    EXPECT_TRUE(std::get<k>(a) == std::get<k>(b)) << "member " << k;
    expect_equal_members<k + 1>(a, b);
  }
}

Options unusual_options() {
  Options options;
  options.scene = "folder with space/scène.obj";
  options.metres_per_unit = 0.001;
  options.out = std::string("a\0b", 3);
  options.write = {"vtu", "glb"};
  options.camera = Camera{{1, 2, 3}, {4, 5, 6}, {7, 8, 9}, 10.5, 11, 12, "desk"};
  options.supersample = 3;
  options.antialias = false;
  options.median_radius = 2;
  options.exposure = -1.25;
  options.tone = Tone::reinhard;
  options.sides = Sides::one;
  options.ke = KeMeaning::exitance;
  options.textures = Textures::face;
  options.thermal = true;
  options.specular = Specular::absorb;
  options.cut = false;
  options.merge = false;
  options.subdivision = Subdivision::uniform;
  options.method = Method::hierarchical;
  options.target_error = 0.02;
  options.block_error = 1e-5;
  options.oracle = Oracle::importance;
  options.exchange = ExchangeBy::rays;
  options.picture = PictureFrom::gather;
  options.memory = std::uint64_t{3} << 33;
  options.max_edge = 0.1;
  options.mesh_max_edge = 0.05;
  options.lightmap_texel = 0.02;
  options.false_colour = {500, 2};
  options.maintenance_factor = 0.8;
  options.subscenes = Subscenes::independent;
  options.form_factor = {FormFactor::points, {3, 4}, 1e-5, false, true};
  options.solver = Solver::gauss_seidel;
  options.tolerance = 1e-9;
  options.discretisation_share = 0.25;
  options.max_iterations = 77;
  options.warm_start = "earlier/solution.ply";
  options.solution = "solved/solution.ply";
  options.preview = true;
  options.error_estimate = false;
  options.audit = 0.25;
  options.error_of = ErrorOf::regions;
  options.isa = Isa::avx2;
  options.device = Device::automatic;
  options.verify_device = 0.5;
  options.trace_every_pair = true;
  options.threads = 5;
  options.quiet = true;
  options.live = true;
  options.command = "fluxel solve";
  options.dry_run = true;
  options.timeline = true;
  options.keep_links = true;
  options.checkpoint = "strips";
  options.checkpoint_every = 17;
  options.resume = options.visibility_only = true;
  options.reuse_visibility = "earlier/strips";
  return options;
}

TEST(Transfer, AllOptionsArrive) {
  Options options = world().is_root() ? unusual_options() : Options{};
  broadcast(world(), options);
  expect_equal_members(members(options), members(unusual_options()));
}

TEST(Transfer, OptionsThatAreNotSetStayUnset) {
  // What a rank had before must not shine through.
  Options options = world().is_root() ? Options{} : unusual_options();
  broadcast(world(), options);
  expect_equal_members(members(options), members(Options{}));
}

TEST(Transfer, AllViewFactorOptionsArrive) {
  const ViewFactorOptions unusual{
      "scène.obj", 0.001,   "factors, all.csv", {"mtx"}, 1e-7, Sides::two, Specular::absorb, false, false, 3,
      true,        "fluxel"};
  for (const ViewFactorOptions& expected : {unusual, ViewFactorOptions{}}) {
    ViewFactorOptions options = world().is_root() ? expected : unusual;
    broadcast(world(), options);
    expect_equal_members(members(options), members(expected));
  }
}

TEST(Transfer, AllReferenceOptionsArrive) {
  const ReferenceOptions unusual{unusual_options(),
                                 "earlier/solution.ply",
                                 4,
                                 Measured::receivers,
                                 {{0.125, 7.5, "desk"}, 3600.5, 1ull << 40},
                                 Sampling::even,
                                 0xFEDCBA9876543210ull};
  for (const ReferenceOptions& expected : {unusual, ReferenceOptions{}}) {
    ReferenceOptions options = world().is_root() ? expected : unusual;
    broadcast(world(), options);
    expect_equal_members(members(options), members(expected));
    expect_equal_members(members(options.limits), members(expected.limits));
    expect_equal_members(members(options.run), members(expected.run));
  }
}

TEST(Transfer, AllPhotonOptionsArrive) {
  const PhotonOptions unusual{unusual_options(),
                              "earlier/solution.ply",
                              Measured::receivers,
                              Sequence::scrambled,
                              {{0.125, 7.5, "desk"}, 3600.5, 1ull << 40, 1ull << 33},
                              0xFEDCBA9876543210ull,
                              "before.toml",
                              1000};
  for (const PhotonOptions& expected : {unusual, PhotonOptions{}}) {
    PhotonOptions options = world().is_root() ? expected : unusual;
    broadcast(world(), options);
    expect_equal_members(members(options), members(expected));
    expect_equal_members(members(options.limits), members(expected.limits));
    expect_equal_members(members(options.run), members(expected.run));
  }
}

TEST(Transfer, TheWholeSceneArrives) {
  for (const NamedRequest& named : small_requests()) {
    SCOPED_TRACE(named.name);
    Scene expected = scene_of(named.request);
    expected.materials.front().thermal =
        ThermalSurface{Emissivity({{300, 0.25}, {900, 0.5}}), 300.0, -7, 12, 290};
    expected.materials.front().optics = {Rgb(0.1, 0.2, 0.3), Rgb(0.2), Rgb(0.3), 1.5};
    expected.receivers = {{"desk",
                           Quantity::radiance,
                           {1, 2, 3},
                           {4, 5, 6},
                           {7, 8, 9},
                           10,
                           11,
                           {{12, 13, 14}},
                           {1, 0},
                           {0, 1, 0},
                           {0, 0, 1},
                           0.5},
                          {}};
    expected.observers = {{"reader", {1, 2, 3}, {0, 1, 0}, {0, 0, 1}}, {}};
    expected.tasks = {{"writing", "desk", "around", "room", 500, 0.6, 19, {"reader"}}, {}};
    expected.luminaires = {{"lamp", {1, 2, 3}, {0, 0, 1}, {0, 1, 0}, {0.5, 0.25}, true, 1, {4, 5, 6}}, {}};
    expected.intensities = {{{0}, {0, 1}, {2, 3}}, {{0, 6}, {0, 1}, {2, 3, 4, 5}}};
    expected.units = Units::photometric;
    expected.warnings = {"too near"};
    expected.temperature_unit = TemperatureUnit::celsius;
    Scene scene;
    if (world().is_root()) scene = expected;
    broadcast(world(), scene);
    const auto& [name, origin, extent, patches, pieces, materials, groups, receivers, observers, tasks,
                 luminaires, intensities, units, temperature_unit, statistics, notes, warnings,
                 lost_emitters] = scene;
    EXPECT_EQ(name, expected.name);
    EXPECT_TRUE(origin == expected.origin);
    EXPECT_EQ(extent, expected.extent);
    EXPECT_TRUE(patches == expected.patches);
    EXPECT_TRUE(pieces == expected.pieces);
    EXPECT_TRUE(materials == expected.materials);
    EXPECT_EQ(groups, expected.groups);
    EXPECT_TRUE(receivers == expected.receivers);
    EXPECT_TRUE(observers == expected.observers);
    EXPECT_TRUE(tasks == expected.tasks);
    EXPECT_TRUE(luminaires == expected.luminaires);
    EXPECT_EQ(warnings, expected.warnings);
    EXPECT_TRUE(intensities == expected.intensities);
    EXPECT_EQ(units, expected.units);
    EXPECT_EQ(temperature_unit, expected.temperature_unit);
    expect_equal_members(members(statistics), members(expected.statistics));
    EXPECT_EQ(notes, expected.notes);
    EXPECT_EQ(lost_emitters, expected.lost_emitters);
    EXPECT_FALSE(patches.empty());
  }
}

}  // namespace
}  // namespace test
}  // namespace fluxel
