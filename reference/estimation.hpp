#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "core/rgb.hpp"
#include "reference/sensors.hpp"

namespace fluxel {

/// Independent randomisations of every estimate: their means' spread gives the standard error, by Student's t
/// of 15 degrees of freedom.
inline constexpr int kRandomisations = 16;

/// What has been measured of a sensor, in the sensor's unit.
struct SensorEstimate {
  Rgb mean{0};
  Rgb error{0};   ///< standard error of the mean
  Rgb half_a{0};  ///< mean of the first half of the randomisations,
  Rgb half_b{0};  ///< and of the second, independent of it
};

/// Sums over a run of sensors: what error and mean of all are made of.
struct SensorSums {
  double weight = 0;
  Rgb mean{0};           ///< weight times mean
  Rgb squared_error{0};  ///< weight times squared standard error
};

/// Measures some of the sensors, more and more exactly. Every value depends on the sensor's number, the seed
/// and the number of samples alone.
class Estimation {
 public:
  /// `mine` are the sensors to measure, whole blocks of kSensorBlock but for the last; both must outlive
  /// this.
  Estimation(const Sensors& sensors, const std::vector<std::size_t>& mine, std::uint64_t seed);

  /// Adds samples [first, last) of each randomisation; calls `done` with the number of the sensors that are
  /// ready, now and then and one call at a time. Runs in the caller's task arena.
  void add(std::uint32_t first, std::uint32_t last, const std::function<void(std::size_t)>& done);

  /// Of the k-th of the sensors that are measured here.
  [[nodiscard]] SensorEstimate estimate(std::size_t k) const;
  [[nodiscard]] SensorSums sums(std::size_t first, std::size_t last) const;

  [[nodiscard]] std::uint64_t rays() const { return rays_; }

 private:
  /// Samples [first, last) of randomisation `r` of the sensors [from, to) of those that are measured here.
  /// Returns the rays.
  std::uint64_t add_block(std::size_t from, std::size_t to, std::size_t r, std::uint32_t first,
                          std::uint32_t last);

  using Sums = std::array<Rgb, kRandomisations>;

  const Sensors& sensors_;
  const std::vector<std::size_t>& mine_;
  std::uint64_t seed_;
  std::uint32_t samples_ = 0;  ///< of each randomisation
  std::uint64_t rays_ = 0;
  std::vector<Sums> sums_;
};

}  // namespace fluxel
