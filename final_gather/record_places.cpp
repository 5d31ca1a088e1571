#include "final_gather/record_places.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "final_gather/error_diffusion.hpp"
#include "final_gather/irradiance_cache.hpp"

namespace fluxel {

namespace {

namespace bg = boost::geometry;

/// Pixels from one of the first records to the next: so many of them across a picture, and no more than are
/// worth telling apart.
constexpr double kAcross = 48, kLeastStep = 4;

/// Of pixels that ask: candidates, of which most have a neighbour.
constexpr float kCandidates = 0.3F, kOfEdges = 0.5F;
constexpr double kFirstCandidates = 4;  // for each record

/// At most so many times as dense in a pass.
constexpr double kDenser = 4;

/// What is allowed over what is aimed at.
constexpr double kMargin = 1.5;

/// Of the spacing of an even pattern: how near others may be.
constexpr double kNearest = 0.8;

/// Records side by side differ in distance over pixels' by at most this in depth.
constexpr double kSteep = 0.2;

}  // namespace

RecordPlaces::RecordPlaces(int width, std::span<const SidePoint> seen)
    : width_(static_cast<std::size_t>(width)),
      seen_(seen),
      step_(std::max(kLeastStep, std::sqrt(static_cast<double>(seen.size())) / kAcross)),
      is_taken_(seen.size(), false) {}

/// Whether two pixels side by side see one surface.
bool RecordPlaces::goes_on(std::size_t pixel, std::size_t beside) const {
  if (!is_seen(beside) || agreement(seen_[pixel], seen_[beside]) <= 0) return false;
  return off_plane(seen_[pixel], seen_[beside]) <=
         kSteep * glm::distance(seen_[pixel].position, seen_[beside].position);
}

/// Calls `visit(other, along)` for each of the four pixels beside one that see its surface; `along`: 0 in the
/// row, 1 in the column.
template <class Visit>
void RecordPlaces::visit_beside(std::size_t pixel, const Visit& visit) const {
  const std::size_t x = pixel % width_;
  if (x > 0 && goes_on(pixel, pixel - 1)) visit(pixel - 1, 0);
  if (x + 1 < width_ && goes_on(pixel, pixel + 1)) visit(pixel + 1, 0);
  if (pixel >= width_ && goes_on(pixel, pixel - width_)) visit(pixel - width_, 1);
  if (pixel + width_ < seen_.size() && goes_on(pixel, pixel + width_)) visit(pixel + width_, 1);
}

/// Of what it shows of its surface: the side of a square of its area, about; 0 where no other shows more [m].
double RecordPlaces::size(std::size_t pixel) const {
  constexpr double kNone = std::numeric_limits<double>::infinity();
  std::array<double, 2> sides{kNone, kNone};
  visit_beside(pixel, [&](std::size_t other, std::size_t along) {
    sides[along] = std::min(sides[along], glm::distance(seen_[pixel].position, seen_[other].position));
  });
  const auto [least, most] = std::minmax(sides[0], sides[1]);
  return least == kNone ? 0 : most == kNone ? least : std::sqrt(least * most);
}

bool RecordPlaces::is_edge(std::size_t pixel) const {
  int beside = 0;
  visit_beside(pixel, [&beside](std::size_t, std::size_t) { ++beside; });
  return beside < 4;
}

std::vector<std::uint32_t> RecordPlaces::first() {
  std::vector<float> wanted(seen_.size(), 0);
  std::vector<double> spacing(seen_.size(), 0);
  const auto even = static_cast<float>(kFirstCandidates / (step_ * step_));
  for (std::size_t pixel = 0; pixel < seen_.size(); ++pixel) {
    if (!is_seen(pixel)) continue;
    wanted[pixel] = is_edge(pixel) ? kOfEdges : even;
    spacing[pixel] = first_spacing(pixel);
  }
  return thin_out(wanted, spacing);
}

std::vector<std::uint32_t> RecordPlaces::more(std::span<const PixelError> errors) {
  std::vector<float> wanted(seen_.size(), 0);
  std::vector<double> spacing(seen_.size(), 0);
  for (const PixelError& error : errors) {
    if (!(error.over > 1) || is_taken_[error.pixel]) continue;
    wanted[error.pixel] = kCandidates;
    // Errors of linear functions fall with the square of the spacing.
    const double denser = std::min(kDenser, kMargin * static_cast<double>(error.over));
    spacing[error.pixel] = error.reach > 0 ? spacing_of(static_cast<double>(error.reach)) / std::sqrt(denser)
                                           : first_spacing(error.pixel);
  }
  return thin_out(wanted, spacing);
}

/// Whether there is a record of the surface so near.
bool RecordPlaces::has_neighbour(std::size_t pixel, double spacing) const {
  const SidePoint& here = seen_[pixel];
  const glm::dvec3 low = here.position - spacing, high = here.position + spacing;
  const bg::model::box<Point> around({low.x, low.y, low.z}, {high.x, high.y, high.z});
  return std::any_of(taken_.qbegin(bg::index::intersects(around)), taken_.qend(), [&](const Taken& taken) {
    const SidePoint& there = seen_[taken.second];
    return glm::distance(here.position, there.position) < spacing && agreement(here, there) > 0 &&
           off_plane(here, there) <= kSurfaceOffPlane * spacing;
  });
}

/// Candidates, as long as no other is near.
std::vector<std::uint32_t> RecordPlaces::thin_out(std::span<const float> wanted,
                                                  std::span<const double> spacing) {
  std::vector<std::uint32_t> candidates = diffuse_errors(static_cast<int>(width_), wanted);
  std::erase_if(candidates, [&](std::uint32_t pixel) { return wanted[pixel] == 0 || is_taken_[pixel]; });
  std::stable_partition(candidates.begin(), candidates.end(),
                        [this](std::uint32_t pixel) { return is_edge(pixel); });
  std::vector<std::uint32_t> chosen;
  for (const std::uint32_t pixel : candidates) {
    if (has_neighbour(pixel, kNearest * spacing[pixel])) continue;
    const glm::dvec3& x = seen_[pixel].position;
    taken_.insert({Point(x.x, x.y, x.z), pixel});
    is_taken_[pixel] = true;
    chosen.push_back(pixel);
  }
  std::ranges::sort(chosen);
  return chosen;
}

}  // namespace fluxel
