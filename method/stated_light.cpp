#include "method/stated_light.hpp"

#include "method/relative_error.hpp"
#include "subdivision/piece_finder.hpp"

namespace fluxel {

std::vector<GatherPoint> points_of(const NodeTree& tree, const AuditSubject& subject) {
  const PieceFinder finder(tree.scene());
  std::vector<GatherPoint> points;
  for (const SurfacePlace& place : subject.places)
    points.push_back(
        {tree.face(finder.find(place.patch, place.at.position), place.front), place.at.position});
  return points;
}

StatedLight reflected_at(IrradianceSource& source, std::span<const GatherPoint> points,
                         const AuditSubject& subject, double ray_error) {
  SilentProgress silent;
  auto [B, other] = source.gather_halves(points, {ray_error, source.mean_radiosity()}, silent);
  for (std::size_t k = 0; k < B.size(); ++k) {
    B[k] *= subject.places[k].rho;
    other[k] *= subject.places[k].rho;
  }
  StatedLight stated;
  stated.noise = mean_square(B, other) / 4.0;
  for (std::size_t k = 0; k < B.size(); ++k) stated.B.push_back(0.5 * (B[k] + other[k]));
  return stated;
}

void add_emission(const AuditSubject& subject, StatedLight& stated) {
  for (std::size_t k = 0; k < stated.B.size(); ++k) stated.B[k] += subject.places[k].E;
}

}  // namespace fluxel
