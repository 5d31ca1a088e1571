#include "mpi_master/communication/transfer.hpp"

#include <algorithm>
#include <cereal/archives/binary.hpp>
#include <cereal/types/array.hpp>
#include <cereal/types/optional.hpp>
#include <cereal/types/string.hpp>
#include <cereal/types/vector.hpp>
#include <cstdint>
#include <span>
#include <sstream>
#include <type_traits>
#include <vector>

#include "core/options.hpp"
#include "mpi_master/communication/communicator_ranks.hpp"

// cereal finds these by their arguments' namespaces.
namespace glm {
template <class Archive>
void serialize(Archive& archive, dvec3& v) {
  archive(v.x, v.y, v.z);
}
}  // namespace glm

namespace fluxel {

template <class Archive>
void serialize(Archive& archive, Camera& c) {
  archive(c.eye, c.look_at, c.up, c.fov, c.width, c.height, c.name);
}

template <class Archive>
void serialize(Archive& archive, FormFactorOptions& o) {
  archive(o.rule, o.points.m, o.points.n, o.tolerance, o.partial_visibility, o.closure);
}

template <class Archive>
void serialize(Archive& archive, Options& o) {
  archive(o.scene, o.metres_per_unit, o.out, o.write, o.camera, o.supersample, o.antialias, o.median_radius,
          o.exposure, o.tone, o.false_colour.max, o.false_colour.decades, o.maintenance_factor, o.sides, o.ke,
          o.textures, o.specular, o.thermal, o.cut, o.merge, o.method, o.solution, o.target_error, o.error_of,
          o.block_error, o.oracle, o.exchange, o.picture, o.memory, o.seconds, o.subdivision, o.max_edge,
          o.mesh_max_edge, o.lightmap_texel, o.subscenes, o.form_factor, o.solver, o.tolerance,
          o.discretisation_share, o.max_iterations, o.warm_start, o.preview, o.error_estimate, o.audit,
          o.keep_links, o.checkpoint, o.checkpoint_every, o.resume, o.visibility_only, o.reuse_visibility,
          o.isa, o.device, o.verify_device, o.threads, o.quiet, o.live, o.command, o.dry_run,
          o.trace_every_pair, o.timeline);
}

template <class Archive>
void serialize(Archive& archive, ErrorLimits& l) {
  archive(l.target_error, l.absolute_error, l.of);
}

template <class Archive>
void serialize(Archive& archive, ReferenceLimits& l) {
  archive(l.error, l.seconds, l.rays);
}

template <class Archive>
void serialize(Archive& archive, PhotonLimits& l) {
  archive(l.error, l.seconds, l.photons, l.received);
}

template <class Archive>
void serialize(Archive& archive, PhotonOptions& o) {
  archive(o.run, o.elements, o.only, o.sequence, o.limits, o.seed, o.changed_from, o.groups);
}

template <class Archive>
void serialize(Archive& archive, ReferenceOptions& o) {
  archive(o.run, o.elements, o.supersample, o.only, o.limits, o.sampling, o.seed);
}

template <class Archive>
void serialize(Archive& archive, ViewFactorOptions& o) {
  archive(o.scene, o.metres_per_unit, o.out, o.write, o.tolerance, o.sides, o.specular, o.cut, o.merge,
          o.threads, o.quiet, o.command);
}

template <class Archive>
void serialize(Archive& archive, EmissivityPoint& p) {
  archive(p.temperature, p.emissivity);
}

template <class Archive>
void serialize(Archive& archive, Emissivity& e) {
  archive(e.points);
}

template <class Archive>
void serialize(Archive& archive, ThermalSurface& s) {
  archive(s.emissivity, s.temperature, s.heat_flux, s.convection_coefficient, s.air_temperature);
}

template <class Archive>
void serialize(Archive& archive, SurfaceOptics& o) {
  archive(o.mirror, o.transmission, o.diffuse_transmission, o.refraction_index);
}

template <class Archive>
void serialize(Archive& archive, Material& m) {
  archive(m.name, m.rho, m.E, m.sides, m.thermal, m.optics);
}

template <class Archive>
void serialize(Archive& archive, SceneStatistics& f) {
  archive(f.faces_read, f.degenerate_faces, f.nonplanar_faces, f.merged_patches, f.components,
          f.closed_components, f.boundary_edges, f.nonmanifold_edges, f.flipped_edges, f.coplanar_overlaps,
          f.cut_patches, f.sealed_sides, f.covered_area, f.closed, f.lit_inside, f.convex);
}

template <class Archive>
void serialize(Archive& archive, Receiver& r) {
  archive(r.name, r.quantity, r.origin, r.u, r.v, r.columns, r.rows, r.points, r.unmeasured, r.direction,
          r.facing, r.half_angle);
}

template <class Archive>
void serialize(Archive& archive, Observer& o) {
  archive(o.name, o.eye, o.direction, o.up);
}

template <class Archive>
void serialize(Archive& archive, LightingTask& t) {
  archive(t.name, t.area, t.surrounding, t.background, t.illuminance, t.U0, t.UGR, t.observers);
}

template <class Archive>
void serialize(Archive& archive, Luminaire& l) {
  archive(l.name, l.position, l.aim, l.ahead, l.size.x, l.size.y, l.round, l.intensity, l.scale);
}

template <class Archive>
void serialize(Archive& archive, IntensityTable& t) {
  archive(t.C, t.gamma, t.intensity);
}

/// Without patches and pieces.
template <class Archive>
void serialize(Archive& archive, Scene& s) {
  archive(s.name, s.origin, s.extent, s.materials, s.groups, s.receivers, s.observers, s.tasks, s.luminaires,
          s.intensities, s.units, s.temperature_unit, s.statistics, s.notes, s.warnings, s.lost_emitters);
}

namespace {

template <class T>
void broadcast_archive(const Communicator& communicator, T& object) {
  if (communicator.size() == 1) return;
  Bytes bytes;
  if (communicator.is_root()) {
    std::ostringstream stream(std::ios::binary);
    cereal::BinaryOutputArchive archive(stream);
    archive(object);
    const std::string_view text = stream.view();
    const auto raw = std::as_bytes(std::span(text));
    bytes.assign(raw.begin(), raw.end());
  }
  communicator.broadcast(bytes);
  if (!communicator.is_root()) {
    std::istringstream stream(std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size()),
                              std::ios::binary);
    cereal::BinaryInputArchive archive(stream);
    archive(object);
  }
}

/// As it lies in memory, to one rank of each host, which hold it together.
template <class T>
void broadcast_once_a_host(const Communicator& world, std::vector<T>& items) {
  static_assert(std::is_trivially_copyable_v<T>);
  if (world.is_leader()) {
    std::uint64_t count = items.size();
    broadcast_archive(world.leaders(), count);
    items.resize(count);
    const auto all = std::as_writable_bytes(std::span(items));
    constexpr std::size_t kPart = std::size_t{1} << 22;
    Bytes part;
    for (std::size_t first = 0; world.leaders().size() > 1 && first < all.size(); first += kPart) {
      const auto some = all.subspan(first, std::min(kPart, all.size() - first));
      part.assign(some.begin(), some.end());
      world.leaders().broadcast(part);
      if (!world.is_root()) std::ranges::copy(part, some.begin());
    }
  }
  ranks_of(world).share(items);
}

}  // namespace

void broadcast(const Communicator& communicator, Options& options) {
  broadcast_archive(communicator, options);
}

void broadcast(const Communicator& communicator, ReferenceOptions& options) {
  broadcast_archive(communicator, options);
}

void broadcast(const Communicator& communicator, PhotonOptions& options) {
  broadcast_archive(communicator, options);
}

void broadcast(const Communicator& communicator, ViewFactorOptions& options) {
  broadcast_archive(communicator, options);
}

void broadcast(const Communicator& communicator, Scene& scene) {
  broadcast_archive(communicator, scene);
  broadcast_once_a_host(communicator, scene.patches);
  broadcast_once_a_host(communicator, scene.pieces);
}

}  // namespace fluxel
