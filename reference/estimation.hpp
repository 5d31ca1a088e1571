#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "core/choices.hpp"
#include "core/rgb.hpp"
#include "core/sensor_estimate.hpp"
#include "reference/block_samples.hpp"
#include "reference/device_batch.hpp"
#include "reference/path_sum.hpp"
#include "reference/sensor_blocks.hpp"
#include "reference/sensors.hpp"

namespace fluxel {

/// Sums over a run of sensors: what error and mean of all are made of.
struct SensorSums {
  double weight = 0;
  Rgb mean{0};           ///< weight times mean
  Rgb square{0};         ///< weight times the product of both halves: the square without noise
  Rgb squared_error{0};  ///< weight times squared standard error
  Rgb fourth_power{0};   ///< the square of weight times squared standard error
};

/// What errors have beyond the spread of the randomisations.
struct ErrorRule {
  /// Whether a sensor's error is looked at alone. k contributions of one size have the variance k, estimated
  /// by their number, which may be too small: one more counts. In the mean of many errors it would be one too
  /// many.
  bool of_each = false;
  /// Of a sensor where no path has brought anything: what one may have brought. Infinite: nobody knows.
  Rgb contribution{0};
  double selection = 1;  ///< all are so many times as large, see selection_of in reference_job.cpp
};

/// Measures some of the sensors, more and more exactly, by kRandomisations randomisations; where samples are
/// dealt to blocks their errors have 14 degrees of freedom. Every value depends on the sensor's number, the
/// seed and the number of samples alone.
class Estimation {
 public:
  /// `mine` are the sensors to measure; all must outlive this. `device`: of these sensors, takes their paths;
  /// null: the processor follows them. Values are the same but for what the device finds.
  Estimation(const Sensors& sensors, const BlockedSensors& mine, std::uint64_t seed, Sampling sampling,
             DeviceBatch* device = nullptr);

  /// Measures until each block has so many samples, or has them already; calls `done` with the part of this
  /// work that is ready, now and then and one call at a time. Runs in the caller's task arena. Throws
  /// InputError where a device that is required fails.
  void add(std::span<const HalfSamples> until, const std::function<void(double)>& done);

  /// Of the k-th of the sensors that are measured here, with the error of the randomisations' means.
  [[nodiscard]] SensorEstimate estimate(std::size_t k, const ErrorRule& rule = {}) const;
  /// Of a block, counted among those that are measured here.
  [[nodiscard]] SensorSums sums(std::size_t block, const ErrorRule& rule = {}) const;
  /// What all paths of a block have found.
  [[nodiscard]] PathSum found(std::size_t block) const;
  /// As the first `pilot` samples tell: a power of two from kMinSamples on, that both halves have.
  [[nodiscard]] BlockSpread spread(std::size_t block, std::uint32_t pilot) const;

  [[nodiscard]] std::uint64_t rays() const { return rays_; }

 private:
  using Sums = std::array<PathSum, kRandomisations>;

  [[nodiscard]] std::size_t first_of(std::size_t block) const {
    return block == 0 ? 0 : mine_.ends[block - 1];
  }
  [[nodiscard]] std::size_t block_of(std::size_t k) const;
  [[nodiscard]] double sample_count(std::size_t block, std::uint32_t first, std::uint32_t last) const;
  [[nodiscard]] std::vector<HalfSamples> next_stage(std::span<const HalfSamples> until) const;
  void add_stage(std::span<const HalfSamples> next, const std::function<void(double)>& count);
  void add_by_device(std::span<const HalfSamples> next, const std::function<void(double)>& count);
  struct SampleRange {
    std::uint32_t first, last;
  };
  template <class Batch>
  void add_samples(std::size_t block, std::size_t randomisation, const SampleRange& range, Batch& batch);
  void keep_spread(std::size_t block, std::size_t half);

  const Sensors& sensors_;
  const BlockedSensors& mine_;
  std::uint64_t seed_;
  Sampling sampling_;
  DeviceBatch* device_;
  std::vector<HalfSamples> samples_;  ///< of each block
  std::uint64_t rays_ = 0;
  std::vector<Sums> sums_;
  /// Of each block and half. See BlockSpread: `light_` after kMinSamples samples, an entry of `variances_`
  /// then, after twice as many, and so on.
  std::vector<std::array<Rgb, 2>> light_;
  std::vector<std::vector<std::array<Rgb, 2>>> variances_;
};

}  // namespace fluxel
