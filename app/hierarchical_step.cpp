#include "app/hierarchical_step.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "app/heed_signals.hpp"
#include "app/hierarchy_rounds.hpp"
#include "app/stopwatch.hpp"
#include "core/hash.hpp"
#include "mpi_master/communicator_ranks.hpp"
#include "mpi_master/machine.hpp"
#include "mpi_master/node_gather.hpp"
#include "mpi_master/side_view_job.hpp"
#include "subdivision/camera_raster.hpp"
#include "subdivision/subdivide.hpp"
#include "visibility/instruction_set.hpp"

namespace fluxel {

namespace {

/// Of the picture's pixels so many show how good it is.
constexpr std::size_t kProbes = 2048;

/// Tree and blocks may take this part of the memory that there is.
constexpr double kMemoryShare = 0.8;

/// What the raster's pixels see, as points of whole pieces; without a face where nothing is seen or no
/// unknown.
std::vector<GatherPoint> seen_points_of(const NodeTree& tree, const Options& options, const Raster& raster) {
  std::vector<GatherPoint> points(raster.pixels());
  if (!options.camera) return points;
  const Scene& scene = tree.scene();
  const PieceFinder finder(scene);
  for (const SeenPoint& seen : seen_points(scene, *options.camera, options.supersample, raster)) {
    const std::size_t piece = finder.find(seen.patch, seen.point);
    points[seen.pixel] = {tree.face(piece, raster.front[seen.pixel] != 0), seen.point};
  }
  return points;
}

/// Some of the points that reflect and do not emit, from all parts of the picture.
std::vector<GatherPoint> choose_probes(const NodeTree& tree, std::span<const GatherPoint> points) {
  const Scene& scene = tree.scene();
  std::vector<GatherPoint> dark;
  for (const GatherPoint& point : points) {
    if (point.face == kNoNode) continue;
    const PatchId patch = scene.pieces[tree[point.face].piece].patch;
    if (!scene.emits(patch) && scene.material(scene.patch(patch)).rho != Rgb(0)) dark.push_back(point);
  }
  if (dark.size() <= kProbes) return dark;
  // Steps of the golden ratio meet every part of the raster alike.
  std::vector<GatherPoint> chosen;
  for (std::size_t k = 0; k < kProbes; ++k) {
    const double at = 0.6180339887498949 * static_cast<double>(k);
    chosen.push_back(
        dark[static_cast<std::size_t>((at - std::floor(at)) * static_cast<double>(dark.size()))]);
  }
  return chosen;
}

/// Collective: the leaves as the elements of the run, and each pixel's.
void take_leaves(const Communicator& world, const Hierarchy& hierarchy, std::span<const GatherPoint> points,
                 SubdividedScene& subdivided) {
  const NodeTree& tree = hierarchy.tree();
  ElementMesh mesh = tree.elements();
  if (!world.is_root()) mesh = {};
  subdivided.elements = gather_on_nodes(world, std::span<const Element>(mesh.elements));
  subdivided.outlines = gather_on_nodes(world, std::span<const Outline<glm::vec3>>(mesh.outlines));
  subdivided.mesh = {subdivided.elements.items(), subdivided.outlines.items()};
  subdivided.hash = hash_bytes(std::as_bytes(subdivided.outlines.items()),
                               hash_bytes(std::as_bytes(subdivided.elements.items())));
  const std::span<const NodeId> nodes = hierarchy.leaves().nodes();
  const std::size_t elements = subdivided.mesh.elements.size();
  std::vector<std::uint32_t> element_of(tree.size());
  for (std::size_t k = 0; k < nodes.size(); ++k)
    if (nodes[k] != kNoNode) element_of[nodes[k]] = static_cast<std::uint32_t>(k % elements);
  for (std::size_t pixel = 0; pixel < points.size(); ++pixel)
    if (const NodeId leaf = leaf_below(tree, points[pixel].face, points[pixel].position); leaf != kNoNode)
      subdivided.raster.element[pixel] = ElementId{element_of[leaf]};
}

/// Light of the elements that --subdivision has made: means of what the tree has below them, or gathered at
/// their centroids where the tree is coarser.
Radiosity light_of_elements(Hierarchy& hierarchy, const ElementView& mesh, const GatherGoal& goal,
                            Progress& progress) {
  const NodeTree& tree = hierarchy.tree();
  const Scene& scene = tree.scene();
  Radiosity light = hierarchy.radiosity();
  const std::vector<Rgb> H = hierarchy.irradiance_of_nodes();
  const Unknowns unknowns = make_unknowns(mesh.elements, scene.materials);
  light.B.assign(unknowns.size(), Rgb(0));
  light.H.assign(unknowns.size(), Rgb(0));
  std::vector<GatherPoint> points;
  std::vector<std::size_t> of_point;
  const PieceFinder finder(scene);
  for (std::size_t k = 0; k < unknowns.size(); ++k) {
    if (!(unknowns.area[k] > 0)) continue;
    const Element& element = mesh.elements[k % mesh.elements.size()];
    const glm::dvec3 centroid(element.centroid);
    NodeId id = tree.face(finder.find(element.patch, centroid), k < mesh.elements.size());
    constexpr double kSameArea = 1.2;  // parts of a piece are halves of halves
    while (tree[id].shape.area > kSameArea * unknowns.area[k] && !tree[id].is_leaf())
      id = tree[id].child[tree.in_first_child(id, centroid) ? 0 : 1];
    if (tree[id].shape.area <= kSameArea * unknowns.area[k]) {
      light.H[k] = H[id];
    } else {
      points.push_back({id, centroid});
      of_point.push_back(k);
    }
  }
  progress.begin("gathering for elements");
  const std::vector<Rgb> gathered = hierarchy.gather(points, goal, progress);
  progress.end();
  for (std::size_t k = 0; k < points.size(); ++k) light.H[of_point[k]] = gathered[k];
  for (std::size_t k = 0; k < unknowns.size(); ++k) light.B[k] = unknowns.E[k] + unknowns.rho[k] * light.H[k];
  return light;
}

/// Collective: where the power of the leaves goes.
void balance_energy(const Communicator& world, const Scene& scene, const RayScene& ray_scene, int threads,
                    const Hierarchy& hierarchy, RunReport& report) {
  const ElementMesh mesh = hierarchy.tree().elements();
  const Unknowns& unknowns = hierarchy.leaves().unknowns();
  const NodeArray<SideView> views =
      gather_side_views(world, ray_scene, scene, mesh, unknowns.two_sided, threads);
  report.closed = is_closed(views.items());
  report.energy = energy_balance(unknowns, hierarchy.radiosity(), views.items());
  report.row_sums = hierarchy.row_sums();
  report.form_factors.row_sum_max = hierarchy.row_sums().largest;
  report.form_factors.closure_defect_rms =
      closure_defect_rms(unknowns.area, hierarchy.row_sums().sums, views.items());
  if (report.options.thermal)
    report.thermal =
        thermal_rows(scene, mesh.elements, unknowns, hierarchy.radiosity(), hierarchy.row_sums());
}

/// Collective.
void sum_counts(const Communicator& world, const Hierarchy& hierarchy, HierarchyFacts& facts) {
  const RefinementCounts& counts = hierarchy.counts();
  std::array<std::uint64_t, 5> sums{counts.pairs, counts.shafts, counts.contours, counts.rays,
                                    hierarchy.gather_rays()};
  world.all_sum(sums);
  facts.pairs = sums[0], facts.shafts = sums[1], facts.contours = sums[2], facts.rays = sums[3];
  facts.gather_rays = sums[4];
  auto bytes = static_cast<double>(hierarchy.bytes());
  world.all_max(std::span(&bytes, 1));
  facts.bytes = static_cast<std::uint64_t>(bytes);
}

OracleParts oracle_parts(const Options& options) {
  const Oracle oracle = options.oracle;
  return {oracle == Oracle::all || oracle == Oracle::power,
          oracle == Oracle::all || oracle == Oracle::importance, options.thermal};
}

/// All that the rounds depend on of what was chosen.
std::array<double, 6> choices_of(const Options& options, const RoundsGoal& goal) {
  return {goal.target,
          goal.block_error,
          options.tolerance.value_or(0),
          static_cast<double>(options.max_iterations),
          static_cast<double>(options.solver),
          static_cast<double>(options.oracle)};
}

}  // namespace

bool hierarchical_step(const Communicator& world, const Scene& scene, int threads,
                       SubdividedScene& subdivided, std::vector<Rgb>& picture_irradiance,
                       const Teller& teller, Progress& progress, RunReport& report) {
  const Options& options = report.options;
  Stopwatch watch;
  const RayScene ray_scene(scene, threads);
  Hierarchy hierarchy(ranks_of(world), scene, ray_scene, threads, oracle_parts(options));
  const std::vector<GatherPoint> points = seen_points_of(hierarchy.tree(), options, subdivided.raster);
  // The table of heat is of all surfaces, whatever a camera sees.
  const std::vector<GatherPoint> probes =
      options.thermal ? std::vector<GatherPoint>{} : choose_probes(hierarchy.tree(), points);
  hierarchy.set_importance_points(probes);
  hierarchy.handle_signals_by([&] { heed_signals(world, options); });
  // What each rank finds is its own; where to end all must agree.
  std::uint64_t available = available_bytes(world.node().size());
  world.all_min(std::span(&available, 1));
  const RoundsGoal goal{
      options.block_error ? 0 : options.target_error.value_or(kTargetError), options.block_error.value_or(0),
      options.memory.value_or(static_cast<std::uint64_t>(kMemoryShare * static_cast<double>(available)))};
  RoundFolder folder(world, options,
                     rounds_identity(ray_scene, hierarchy.tree(), hierarchy.leaves().unknowns(), probes,
                                     choices_of(options, goal)),
                     [&](const std::string& sentence) { teller.warn(report, sentence); });
  run_rounds(world, hierarchy, probes, goal, folder, teller, progress, report);
  if (!options.checkpoint.empty()) {
    report.checkpoint = folder.counts();
    describe_checkpoint(teller, report);
  }
  report.time.solve = watch.lap();
  balance_energy(world, scene, ray_scene, threads, hierarchy, report);
  report.time.form_factors = watch.lap();

  const GatherGoal gather_goal{report.hierarchy->ray_error, hierarchy.mean_radiosity()};
  report.radiosity = options.subdivision == Subdivision::transport
                         ? hierarchy.radiosity()
                         : light_of_elements(hierarchy, subdivided.mesh, gather_goal, progress);
  if (options.subdivision == Subdivision::transport) take_leaves(world, hierarchy, points, subdivided);
  const std::span<const Element> elements = subdivided.mesh.elements;
  report.elements = elements.size();
  report.unknowns = count_unknowns(elements).active;
  report.elements_hash = subdivided.hash;
  if (options.camera) {
    heed_signals(world, options);
    progress.begin("gathering the picture");
    picture_irradiance = hierarchy.gather(points, gather_goal, progress);
    progress.end();
  }
  report.time.gather = watch.lap();
  sum_counts(world, hierarchy, *report.hierarchy);
  report.instruction_set = instruction_set_in_use();
  return hierarchy.radiosity().converged;
}

}  // namespace fluxel
