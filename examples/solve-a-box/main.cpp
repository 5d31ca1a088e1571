// The light in a closed cube whose faces all reflect rho and emit E: radiosity is E / (1 - rho) everywhere.
//   solve-a-box [hierarchical | matrix]

#include <cmath>
#include <cstdio>
#include <string_view>

#include "core/options.hpp"
#include "method/load_scene.hpp"
#include "method/solve_scene.hpp"
#include "solver/unknowns.hpp"

using namespace fluxel;

int main(int argc, char** argv) {
  const MpiSession mpi(&argc, &argv);
  const double rho = 0.5, E = 1;  // E in W/m2

  SceneInput box;
  box.groups = {"box"};
  box.materials.resize(1);
  box.materials[0].rho = Rgb(rho);
  box.materials[0].E = Rgb(E);
  const glm::dvec3 axis[] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, far(1);
  for (int k = 0; k < 3; ++k) {  // fronts, about which corners are counter-clockwise, look inwards
    const glm::dvec3 u = axis[k], v = axis[(k + 1) % 3];
    box.polygons.push_back({{u - u, u, u + v, v}});
    box.polygons.push_back({{far, far - v, far - u - v, far - u}});
  }

  Options options;
  options.sides = Sides::one;
  if (argc > 1 && std::string_view(argv[1]) == "matrix") {
    options.method = Method::matrix;
    options.subdivision = Subdivision::uniform;
    options.max_edge = 0.1;
  }

  SilentLog log;
  const Scene scene = load_scene(mpi.world(), options, 1, box);
  const Solution solution = solve_scene(mpi.world(), scene, options, log);
  if (mpi.world().is_root()) {
    const Unknowns unknowns = make_unknowns(solution.subdivided.mesh.elements, scene.materials);
    const Rgb mean = area_mean(unknowns, solution.radiosity->B);
    std::printf("mean radiosity %.6f W/m2, exact %.6f W/m2, estimated error %.2g %%\n", mean.g, E / (1 - rho),
                100 * solution.expected_error.value_or(NAN));
  }
}
