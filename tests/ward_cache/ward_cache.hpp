#pragma once

#include <boost/geometry.hpp>
#include <boost/geometry/index/rtree.hpp>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "tests/ward_cache/hemisphere.hpp"

namespace fluxel::ward_cache {

/// What a record knows.
struct WardRecord {
  SidePoint at;
  Rgb irradiance{0};       ///< [W/m2]
  Gradient rotation{};     ///< see HemisphereLight
  Gradient translation{};  ///< likewise
  double radius = 0;       ///< R of Ward, Rubinstein & Clear 1988 [m]
};

/// Irradiance by records that are made where none reaches: the cache of Ward, Rubinstein & Clear (1988) with
/// the gradients of Ward & Heckbert (1992) and the radii of Krivanek, Bouatouch, Pattanaik & Zara (2006). One
/// thread; neither fast nor thrifty.
class WardCache {
 public:
  /// `acceptance`: the a of Ward, Rubinstein & Clear, which records are used where their weight is above 1/a.
  explicit WardCache(double acceptance) : acceptance_(acceptance) {}

  void add(const WardRecord& record);
  /// None where no record reaches.
  [[nodiscard]] std::optional<Rgb> at(const SidePoint& point) const;
  [[nodiscard]] std::size_t size() const { return records_.size(); }

 private:
  using Point = boost::geometry::model::point<double, 3, boost::geometry::cs::cartesian>;
  using Entry = std::pair<boost::geometry::model::box<Point>, std::uint32_t>;

  void clamp_radii(WardRecord& added);
  [[nodiscard]] double reach(const WardRecord& record) const { return acceptance_ * record.radius; }

  double acceptance_;
  std::vector<WardRecord> records_;
  boost::geometry::index::rtree<Entry, boost::geometry::index::linear<16>> places_;  // by first reaches
};

}  // namespace fluxel::ward_cache
