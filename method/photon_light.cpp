#include "method/photon_light.hpp"

#include <algorithm>
#include <glm/exponential.hpp>
#include <glm/geometric.hpp>
#include <utility>

#include "optics/emitters.hpp"
#include "solver/unknowns.hpp"

namespace fluxel {

namespace {

/// Of both sides of elements, from their irradiance.
std::vector<SensorEstimate> radiosity(const Scene& scene, const ElementView& mesh,
                                      std::span<const SensorEstimate> irradiance) {
  const std::size_t elements = mesh.elements.size();
  std::vector<SensorEstimate> found;
  found.reserve(irradiance.size());
  for (std::size_t k = 0; k < irradiance.size(); ++k) {
    const SideLight side = side_light(scene, mesh.elements[k % elements].patch, k < elements);
    const SensorEstimate& H = irradiance[k];
    SensorEstimate& B = found.emplace_back();
    if (!side.active) continue;
    // What falls on the other side.
    const std::size_t other = k < elements ? k + elements : k - elements;
    const SensorEstimate through = other < irradiance.size() ? irradiance[other] : SensorEstimate{};
    const Rgb& of_other = side.optics.diffuse_transmission;
    const auto leaves = [&](const Rgb& on_this, const Rgb& on_other) {
      return side.E + side.rho * on_this + of_other * on_other;
    };
    B.mean = leaves(H.mean, through.mean);
    B.half_a = leaves(H.half_a, through.half_a);
    B.half_b = leaves(H.half_b, through.half_b);
    const Rgb a = side.rho * H.error, b = of_other * through.error;
    B.error = glm::sqrt(a * a + b * b);
  }
  return found;
}

Rgb over(const Rgb& a, const Rgb& b) {
  Rgb ratio(0);
  for (int c = 0; c < kChannels; ++c)
    if (b[c] != 0) ratio[c] = a[c] / b[c];
  return ratio;
}

}  // namespace

PhotonAreas::PhotonAreas(const ElementView& mesh, std::span<const Receiver> receivers) {
  const bool two_sided = count_unknowns(mesh.elements).two_sided;
  for (const std::uint32_t side : {kFront, kBack}) {
    if (side == kBack && !two_sided) break;
    for (const Element& element : mesh.elements)
      sides.push_back((element.sides & side) != 0 ? static_cast<double>(element.area) : 0);
  }
  for (const Receiver& receiver : receivers) {
    const double area =
        glm::length(glm::cross(receiver.u, receiver.v)) / static_cast<double>(receiver.size());
    std::vector<double>& of = cells.emplace_back();
    for (std::size_t cell = 0; cell < receiver.size(); ++cell)
      of.push_back(receiver.measures(cell) ? area : 0);
  }
}

std::vector<PhotonKind> photon_kinds(const PhotonAreas& areas, std::span<const Receiver> receivers,
                                     const TallyShape& shape, const ErrorLimits& of) {
  std::vector<PhotonKind> kinds;
  if (shape.sides > 0) kinds.push_back({"elements", 0, {0, areas.sides, false}, of.is_of("elements")});
  for (std::size_t k = 0; k < receivers.size(); ++k) {
    const std::string& name = receivers[k].name;
    kinds.push_back({"receiver " + name,
                     1 + k,
                     {shape.first_cell(k), areas.cells[k], shape.has_squares},
                     of.is_of("receiver", name)});
  }
  return kinds;
}

std::vector<SensorLight> photon_light(const Scene& scene, const ElementView& mesh,
                                      std::span<const PhotonKind> kinds, std::span<const Receiver> receivers,
                                      const PhotonTally& tally, double power) {
  std::vector<SensorLight> found;
  for (const PhotonKind& kind : kinds) {
    SensorLight& light = found.emplace_back();
    std::vector<SensorEstimate> irradiance = irradiance_estimates(tally, kind.slots, power);
    const IrradianceErrors errors = irradiance_errors(tally, kind.slots, power);
    light.knows_each_error = knows_each_error(tally, kind.slots);
    light.measured.mean = errors.mean;
    light.measured.relative_error = over(errors.error, errors.mean);
    light.measured.quadratic_error = over(errors.error, errors.quadratic_mean);
    light.measured.rays = tally.received(kind.received);
    if (kind.received == 0) {
      light.kind = Measured::elements;
      light.measured.sensors = radiosity(scene, mesh, irradiance);
      light.irradiance = std::move(irradiance);
      continue;
    }
    const Receiver& receiver = receivers[kind.received - 1];
    light.kind = Measured::receivers;
    light.receiver = receiver.name;
    light.columns = receiver.columns;
    light.rows = receiver.rows;
    if (!light.knows_each_error)  // that of all together
      for (SensorEstimate& of : irradiance) of.error = errors.error;
    light.measured.sensors = std::move(irradiance);
  }
  return found;
}

PhotonStatistics photon_statistics(const PhotonSources& sources, const PhotonTally& tally,
                                   const PhotonResult& result, const std::string& ending) {
  PhotonStatistics statistics;
  const auto sent = static_cast<double>(tally.count(PhotonCount::sent));
  const double each = sent > 0 ? sources.power() / sent : 0;
  statistics.sent = tally.count(PhotonCount::sent);
  statistics.restored = result.restored;
  statistics.rays = tally.count(PhotonCount::segments);
  statistics.coordinates = tally.count(PhotonCount::coordinates);
  statistics.power = sources.power();
  statistics.absorbed = each * tally.ended(PhotonFate::absorbed);
  statistics.escaped = each * tally.ended(PhotonFate::escaped);
  statistics.lost = each * tally.ended(PhotonFate::lost);
  statistics.ending = ending;
  statistics.turns = result.turns;
  return statistics;
}

}  // namespace fluxel
