#include "bench/stability/lab.hpp"

#include <algorithm>
#include <stdexcept>

#include "core/options.hpp"
#include "core/progress.hpp"
#include "mpi_master/steps/side_view_job.hpp"
#include "mpi_master/steps/subdivision_job.hpp"

namespace fluxel::lab {

namespace {

constexpr int kThreads = 1;

Unknowns adjusted_unknowns(const Setup& setup, const Scene& scene, const ElementMesh& mesh) {
  Unknowns unknowns = make_unknowns(mesh.elements, scene.materials);
  if (setup.adjust) setup.adjust(mesh, unknowns);
  return unknowns;
}

std::vector<SideView> views_of(const Communicator& world, const RayScene& ray_scene, const Scene& scene,
                               const ElementMesh& mesh, const Unknowns& unknowns) {
  const SharedArray<SideView> views =
      gather_side_views(world, ray_scene, scene, mesh, unknowns.two_sided, kThreads);
  return {views.items().begin(), views.items().end()};
}

Visibility trace(const Communicator& world, const RayScene& ray_scene, const ElementMesh& mesh) {
  SilentProgress silent;
  return compute_visibility({world, kThreads, silent}, TileTracer(ray_scene, mesh.elements),
                            RowCosts::even(tile_count(mesh.elements.size()), 1e-4));
}

FormFactorMatrix make_matrix(const Communicator& world, const FormFactorParts& parts,
                             const FormFactorOptions& options) {
  SilentProgress silent;
  return {{world, kThreads, silent}, parts, options};
}

/// Area-weighted mean over the fronts of a group.
double mean_of(const Run& run, const std::string& group, const std::vector<Rgb>& values) {
  double sum = 0, area = 0;
  for (std::size_t i = 0; i < run.mesh.elements.size(); ++i) {
    const Patch& patch = run.scene.patch(run.mesh.elements[i].patch);
    if (run.scene.groups[index(patch.group)] != group) continue;
    sum += run.unknowns.area[i] * values[i].r;
    area += run.unknowns.area[i];
  }
  return sum / area;
}

}  // namespace

std::vector<Method> methods() {
  FormFactorOptions point, disc, points, closed;
  point.rule = FormFactor::point;
  disc.rule = FormFactor::disc;
  points.rule = FormFactor::points;
  closed.closure = true;
  const FormFactorOptions adaptive;
  return {{"point", point},
          {"disc", disc},
          {"points:2x2", points},
          {"adaptive", adaptive},
          {"adaptive, closure", closed},
          {"adaptive, Gauss-Seidel", adaptive, Solver::gauss_seidel},
          {"adaptive, conjugate gradients", adaptive, Solver::conjugate_gradients},
          {"adaptive, Southwell", adaptive, Solver::southwell}};
}

Method method_named(const std::string& name) {
  for (Method& method : methods())
    if (method.name == name) return method;
  throw std::out_of_range("no method is named " + name);
}

double Run::mean_H(const std::string& group) const { return mean_of(*this, group, radiosity.H); }
double Run::mean_B(const std::string& group) const { return mean_of(*this, group, radiosity.B); }

Scene build(const Setup& setup) {
  SceneSettings settings{setup.sides, KeMeaning::exitance, setup.cut, std::nullopt};
  if (setup.camera) settings.camera_eye = setup.camera->eye;
  settings.merge = false;  // how surfaces are divided is what some situations are about
  return build_scene(setup.input, settings);
}

ElementMesh subdivide(const Communicator& world, const Setup& setup, const Scene& scene) {
  Options options;
  options.sides = setup.sides;
  options.cut = setup.cut;
  options.subdivision = setup.subdivision;
  if (setup.subdivision != Subdivision::none) options.max_edge = setup.max_edge;
  options.camera = setup.camera;
  const SubdividedScene subdivided = subdivide_scene(world, scene, options, kThreads);
  const ElementView& mesh = subdivided.mesh;
  return {{mesh.elements.begin(), mesh.elements.end()}, {mesh.outlines.begin(), mesh.outlines.end()}};
}

Prepared::Prepared(const Communicator& world, const Setup& setup, const FormFactorOptions& form_factor)
    : scene(build(setup)),
      mesh(subdivide(world, setup, scene)),
      unknowns(adjusted_unknowns(setup, scene, mesh)),
      ray_scene(scene, kThreads),
      visibility(trace(world, ray_scene, mesh)),
      views(views_of(world, ray_scene, scene, mesh, unknowns)),
      matrix(make_matrix(world, {ray_scene, scene, mesh, visibility, unknowns.two_sided, unknowns, views},
                         form_factor)) {}

Run run(const Communicator& world, const Setup& setup, const Method& method) {
  Prepared prepared(world, setup, method.form_factor);
  RadiosityOperator& F = prepared.matrix.factors();
  // Without the bound of rounding: the lab drives every method as far as single precision goes.
  const RowSums row_sums = find_error_weights(F, prepared.unknowns);
  Radiosity radiosity = solve_radiosity(method.solver, {F, prepared.unknowns, row_sums}, setup.stop,
                                        [](const IterationState&) {});
  return {std::move(prepared.scene),
          std::move(prepared.mesh),
          std::move(prepared.unknowns),
          std::move(radiosity),
          prepared.matrix.statistics(),
          std::move(prepared.views),
          row_sums.sums};
}

void add_polygon(SceneInput& input, const std::string& group, double rho, double E,
                 const std::vector<glm::dvec3>& corners) {
  const auto place = [](auto& list, const auto& is_it, auto make) {
    const auto found = std::ranges::find_if(list, is_it);
    const auto at = static_cast<std::uint32_t>(found - list.begin());
    if (found == list.end()) list.push_back(make());
    return at;
  };
  const std::uint32_t material = place(
      input.materials,
      [&](const InputMaterial& known) { return known.rho == Rgb(rho) && known.Ke == Rgb(E); },
      [&] {
        InputMaterial made;
        made.name = "material " + std::to_string(input.materials.size());
        made.rho = Rgb(rho);
        made.Ke = Rgb(E);
        return made;
      });
  const std::uint32_t number = place(
      input.groups, [&](const std::string& known) { return known == group; }, [&] { return group; });
  input.polygons.push_back({corners, MaterialId{material}, GroupId{number}});
}

}  // namespace fluxel::lab
