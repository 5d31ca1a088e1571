#pragma once

#include <boost/geometry.hpp>
#include <boost/geometry/index/rtree.hpp>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "final_gather/side_point.hpp"

namespace fluxel {

/// What is expected of a pixel between records.
struct PixelError {
  std::uint32_t pixel = 0;
  float over = 0;   ///< its error over what is allowed
  float reach = 0;  ///< of the records around [m]; 0: there are none
};

/// Chooses the pixels whose places become records: those that ask for one, thinned out by diffusion of errors
/// over the picture, and of these one in each neighbourhood of the scene, as large as what is asked lets it
/// be (Frolov et al. 2013: dithering in screen space, clusters in world space). The same for any number of
/// ranks.
class RecordPlaces {
 public:
  /// `seen` by the pixels, row-major, of whole rows of `width`; it must outlive this.
  RecordPlaces(int width, std::span<const SidePoint> seen);

  /// The first ones: evenly over the picture, and along the edges of what it shows, beyond which light need
  /// not go on as it does. Ascending.
  [[nodiscard]] std::vector<std::uint32_t> first();
  /// More of them where errors are too large.
  [[nodiscard]] std::vector<std::uint32_t> more(std::span<const PixelError> errors);

 private:
  using Point = boost::geometry::model::point<double, 3, boost::geometry::cs::cartesian>;
  using Taken = std::pair<Point, std::uint32_t>;

  [[nodiscard]] bool is_seen(std::size_t pixel) const { return seen_[pixel].piece != SidePoint::kNothing; }
  [[nodiscard]] bool goes_on(std::size_t pixel, std::size_t beside) const;
  template <class Visit>
  void visit_beside(std::size_t pixel, const Visit& visit) const;
  [[nodiscard]] double size(std::size_t pixel) const;
  [[nodiscard]] bool is_edge(std::size_t pixel) const;
  [[nodiscard]] double first_spacing(std::size_t pixel) const { return step_ * size(pixel); }
  [[nodiscard]] bool has_neighbour(std::size_t pixel, double spacing) const;
  [[nodiscard]] std::vector<std::uint32_t> thin_out(std::span<const float> wanted,
                                                    std::span<const double> spacing);

  std::size_t width_;
  std::span<const SidePoint> seen_;
  double step_;  // of the first records [pixels]
  boost::geometry::index::rtree<Taken, boost::geometry::index::linear<16>> taken_;
  std::vector<bool> is_taken_;
};

}  // namespace fluxel
