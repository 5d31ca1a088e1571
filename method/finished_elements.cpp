#include "method/finished_elements.hpp"

#include <algorithm>
#include <utility>

#include "core/sampling.hpp"
#include "scene/polygon.hpp"

namespace fluxel {

FinishedElements::FinishedElements(const ElementFinder& finder, const ElementView& mesh,
                                   std::vector<Rgb> reflected)
    : finder_(finder), mesh_(mesh), reflected_(std::move(reflected)) {
  double sum = 0;
  for (std::size_t k = 0; k < reflected_.size(); ++k)
    ends_.push_back(sum += brightness(k) * area(corners(widen(mesh_.outlines[k % mesh_.elements.size()]))));
}

Rgb FinishedElements::reflected(PatchId patch, bool front, const glm::dvec3& point) const {
  const std::size_t unknown = unknown_at(patch, front, point);
  return unknown < reflected_.size() ? reflected_[unknown] : Rgb(0);
}

std::optional<DrawnPoint> FinishedElements::draw(double u, double v) const {
  if (ends_.empty() || !(ends_.back() > 0)) return std::nullopt;
  const double at = u * ends_.back();
  const auto k = std::min(static_cast<std::size_t>(std::ranges::upper_bound(ends_, at) - ends_.begin()),
                          ends_.size() - 1);
  const double start = k > 0 ? ends_[k - 1] : 0;
  // What the choice of the element has left of u is uniform again.
  const double rest = ends_[k] > start ? std::clamp((at - start) / (ends_[k] - start), 0.0, 1.0) : 0.5;
  const std::size_t element = k % mesh_.elements.size();
  return DrawnPoint{surface_point(mesh_.outlines[element], rest, v), mesh_.elements[element].patch,
                    k < mesh_.elements.size()};
}

double FinishedElements::density(PatchId patch, bool front, const glm::dvec3& point) const {
  const std::size_t unknown = unknown_at(patch, front, point);
  return unknown < reflected_.size() && ends_.back() > 0 ? brightness(unknown) / ends_.back() : 0;
}

std::size_t FinishedElements::unknown_at(PatchId patch, bool front, const glm::dvec3& point) const {
  const std::size_t element = finder_.find(patch, point);
  if (element == ElementFinder::kNone) return ElementFinder::kNone;
  return front ? element : mesh_.elements.size() + element;
}

std::vector<Rgb> reflected_light(const Scene& scene, const ElementView& mesh, std::span<const Rgb> H) {
  std::vector<Rgb> reflected(H.begin(), H.end());
  for (std::size_t k = 0; k < reflected.size(); ++k)
    reflected[k] *= scene.material(scene.patch(mesh.elements[k % mesh.elements.size()].patch)).rho;
  return reflected;
}

}  // namespace fluxel
