#include "method/subdivide.hpp"

#include <fmt/format.h>

#include "core/element.hpp"
#include "core/options.hpp"
#include "method/handle_signals.hpp"

namespace fluxel {

void subdivide(const Problem& problem, const BytesOfElements& bytes_to_follow, Solution& solution) {
  Stopwatch watch;
  problem.progress.begin("subdivision");
  solution.subdivided =
      subdivide_scene(problem.world, problem.scene, problem.options, problem.threads, bytes_to_follow);
  problem.progress.end();
  const std::span<const Element> elements = solution.subdivided.mesh.elements;
  if (problem.options.subdivision != Subdivision::transport)
    problem.log.say(fmt::format("subdivision: {} elements, {} unknowns", elements.size(),
                                count_unknowns(elements).active));
  solution.time.subdivision = watch.lap();
  handle_signals(problem.world, problem.options, problem.log);
}

}  // namespace fluxel
