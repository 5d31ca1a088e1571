#pragma once

#include <span>
#include <string>
#include <vector>

#include "method/solution.hpp"
#include "mpi_master/steps/photon_job.hpp"
#include "photons/photon_scene.hpp"
#include "scene/scene.hpp"

namespace fluxel {

/// What slots count for: areas of elements' sides and of receivers' cells, 0 where nothing is measured.
struct PhotonAreas {
  PhotonAreas(const ElementView& mesh, std::span<const Receiver> receivers);

  std::vector<double> sides;               ///< [m2]
  std::vector<std::vector<double>> cells;  ///< of each receiver [m2]
};

/// Elements, where there are some, and receivers. `of`: whose error decides, empty: of all. The areas must
/// outlive what is returned.
[[nodiscard]] std::vector<PhotonKind> photon_kinds(const PhotonAreas& areas,
                                                   std::span<const Receiver> receivers,
                                                   const TallyShape& shape, const ErrorLimits& of);

/// What has been measured of each kind: of elements what leaves them evenly (E, what they reflect of the
/// light on the same side and transmit of that on the other) and the irradiance; of receivers the irradiance.
/// `power`: of all photons.
[[nodiscard]] std::vector<SensorLight> photon_light(const Scene& scene, const ElementView& mesh,
                                                    std::span<const PhotonKind> kinds,
                                                    std::span<const Receiver> receivers,
                                                    const PhotonTally& tally, double power);

[[nodiscard]] PhotonStatistics photon_statistics(const PhotonSources& sources, const PhotonTally& tally,
                                                 const PhotonResult& result, const std::string& ending);

}  // namespace fluxel
