#include "reference/sensor_starts.hpp"

#include <glm/geometric.hpp>
#include <numbers>

namespace fluxel {

void SurfaceSensors::start(std::span<const SensorPath> paths, std::vector<SensorStart>& started,
                           std::uint64_t& /*rays*/) const {
  for (std::size_t k = 0; k < paths.size(); ++k) {
    OwenSobol numbers = paths[k].numbers;
    const std::array<double, 4> even = numbers.next();
    started.push_back(start_at(paths[k].sensor, even, numbers));
    started.back().number = k;
  }
}

void SightSensors::start(std::span<const SensorPath> paths, std::vector<SensorStart>& started,
                         std::uint64_t& rays) const {
  std::vector<PathStart> starts;
  std::vector<Ray> sights;
  starts.reserve(paths.size());
  sights.reserve(paths.size());
  for (const SensorPath& path : paths) {
    OwenSobol numbers = path.numbers;
    const auto [s, t, u, v] = numbers.next();
    sights.push_back(sight(path.sensor, s, t, numbers));
    starts.push_back({{}, {u, v}, numbers});
  }
  std::vector<LightPaths::Seen> seen(paths.size());
  light_paths().first_seen(sights, seen);
  rays += sights.size();
  for (std::size_t k = 0; k < paths.size(); ++k) {
    if (!seen[k].is_active()) continue;
    PathStart& path = starts[k];
    if (seen[k].side->is_diffuse()) {
      path.at = seen[k].at;
      started.push_back({path, seen[k].side->E, seen[k].side->rho, std::numbers::pi, k});
    } else {
      path.at.position = sights[k].origin;
      path.sight = glm::normalize(sights[k].direction);
      started.push_back({path, Rgb(0), Rgb(1), std::numbers::pi, k});
    }
  }
}

}  // namespace fluxel
