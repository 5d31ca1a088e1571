#include "bench/stability/lab.hpp"

#include <algorithm>
#include <stdexcept>

#include "core/progress.hpp"
#include "mpi_master/side_view_job.hpp"
#include "mpi_master/subdivision_job.hpp"
#include "mpi_master/visibility_job.hpp"

namespace fluxel::lab {

namespace {

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
          {"adaptive, Gauss-Seidel", adaptive, Solver::gauss_seidel}};
}

Method method_named(const std::string& name) {
  for (Method& method : methods())
    if (method.name == name) return method;
  throw std::out_of_range("no method is named " + name);
}

double Run::mean_H(const std::string& group) const { return mean_of(*this, group, radiosity.H); }
double Run::mean_B(const std::string& group) const { return mean_of(*this, group, radiosity.B); }

Run run(const Communicator& world, const Setup& setup, const Method& method) {
  constexpr int kThreads = 1;
  Options options;
  options.sides = setup.sides;
  options.cut = setup.cut;
  options.subdivision = setup.subdivision;
  if (setup.subdivision != Subdivision::none) options.max_edge = setup.max_edge;
  options.camera = setup.camera;

  Run result;
  SceneSettings settings{setup.sides, KeMeaning::exitance, setup.cut, std::nullopt};
  if (setup.camera) settings.camera_eye = setup.camera->eye;
  result.scene = build_scene(setup.input, settings);
  result.mesh = subdivide_scene(world, result.scene, options, kThreads).mesh;
  result.unknowns = make_unknowns(result.mesh.elements, result.scene.materials);
  if (setup.adjust) setup.adjust(result.mesh, result.unknowns);
  const RayScene ray_scene(result.scene, kThreads);
  SilentProgress silent;
  const Visibility visibility =
      compute_visibility(world, TileTracer(ray_scene, result.mesh.elements), kThreads, silent);
  result.views =
      gather_side_views(world, ray_scene, result.scene, result.mesh, result.unknowns.two_sided, kThreads);
  FormFactorMatrix matrix(
      world, {ray_scene, result.scene, result.mesh, visibility.store, result.unknowns, result.views},
      method.form_factor, kThreads);
  result.form_factors = matrix.facts();
  // Without the bound of rounding: the lab drives every method as far as single precision goes.
  const RowSums row_sums = find_error_weights(matrix.factors(), result.unknowns);
  result.row_sums = row_sums.sums;
  result.radiosity = solve_radiosity(method.solver, matrix.factors(), result.unknowns, row_sums, setup.stop,
                                     [](int, double) {});
  return result;
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
