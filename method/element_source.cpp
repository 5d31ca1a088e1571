#include "method/element_source.hpp"

#include "core/options.hpp"
#include "core/second_moments.hpp"
#include "method/handle_signals.hpp"
#include "mpi_master/communication/agreement.hpp"
#include "mpi_master/communication/communicator_ranks.hpp"
#include "solver/unknowns.hpp"

namespace fluxel {

ElementSource::ElementSource(const Problem& problem, const ElementView& mesh, std::span<const Rgb> irradiance,
                             VerifiedHits* device)
    : problem_(problem),
      device_(device),
      ranks_(ranks_of(problem.world)),
      threads_(problem.threads),
      tree_(problem.scene, problem.threads, ranks_),
      emitted_(problem.ray_scene, tree_, problem.threads, ranks_),
      elements_(tree_, mesh, irradiance),
      rays_(emitted_, elements_, Rgb(1), device) {
  const Unknowns unknowns = make_unknowns(mesh.elements, problem.scene.materials);
  std::vector<Rgb> B = unknowns.E;
  for (std::size_t k = 0; k < B.size(); ++k) B[k] += unknowns.rho[k] * irradiance[k];
  mean_radiosity_ = area_mean(unknowns, B);
  handle_signals_by([&problem] { fluxel::handle_signals(problem.world, problem.options, problem.log); });
}

EndLight ElementSource::Elements::at(NodeId leaf, const glm::dvec3& point) const {
  const Node& face = tree_[leaf];
  const std::size_t element = finder_.find(tree_.scene().pieces[face.piece].patch, point);
  if (element == ElementFinder::kNone) return {};
  const Element& found = mesh_.elements[element];
  const SecondMoments moments{static_cast<double>(found.minor_variance), glm::dvec3(found.elongation)};
  const Rgb& H = irradiance_[face.front ? element : mesh_.elements.size() + element];
  return {tree_.material(leaf).rho * H, moments.trace()};
}

std::array<std::vector<Rgb>, 2> ElementSource::gather_halves(std::span<const GatherPoint> points,
                                                             const GatherGoal& goal, Progress& progress) {
  return rays_.gather(points, goal,
                      {ranks_, threads_, [this] { return is_stopped(); }, [this] { between_parts(); }},
                      progress);
}

/// Collective.
void ElementSource::between_parts() {
  handle_signals();
  agree(problem_.world, [this] {
    if (device_ != nullptr && !device_->failure().empty() && problem_.options.device == Device::cuda)
      throw InputError(device_->failure() + " (--device auto goes on without)");
  });
}

std::vector<Rgb> ElementSource::gather(std::span<const GatherPoint> points, const GatherGoal& goal,
                                       Progress& progress) {
  return mean_of_halves(gather_halves(points, goal, progress));
}

}  // namespace fluxel
