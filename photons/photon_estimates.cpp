#include "photons/photon_estimates.hpp"

#include <algorithm>
#include <array>
#include <glm/common.hpp>
#include <glm/exponential.hpp>

namespace fluxel {

namespace {

/// Of one slot.
class SlotEstimator {
 public:
  SlotEstimator(const PhotonTally& tally, const SlotRange& slots, double power)
      : tally_(tally), slots_(slots), power_(power) {
    for (std::size_t part = 0; part < tally.shape().parts; ++part) {
      const auto sent = static_cast<double>(tally.sent(part));
      sent_.push_back(sent);
      half_sent_[half_of(part)] += sent;
    }
  }

  [[nodiscard]] SensorEstimate of(std::size_t k) const {
    const double area = slots_.areas[k];
    if (!(area > 0)) return {};
    const std::size_t slot = slots_.first + k;
    std::array<Rgb, 2> halves{};
    for (std::size_t part = 0; part < sent_.size(); ++part) halves[half_of(part)] += tally_.sum(slot, part);
    const double unit = power_ / area, all = half_sent_[0] + half_sent_[1];
    SensorEstimate estimate;
    if (!(all > 0)) return estimate;
    estimate.mean = unit / all * (halves[0] + halves[1]);
    estimate.half_a = mean_of(halves[0], half_sent_[0], unit);
    estimate.half_b = mean_of(halves[1], half_sent_[1], unit);
    if (slots_.has_squares) {
      const Rgb mean = (halves[0] + halves[1]) / all;
      estimate.error = unit * glm::sqrt(glm::max(tally_.sum_of_squares(slot) / all - mean * mean, 0.0) / all);
    } else if (sent_.size() > 2) {
      estimate.error = error_of_parts(slot, unit);
    }
    return estimate;
  }

 private:
  [[nodiscard]] std::size_t half_of(std::size_t part) const { return 2 * part / tally_.shape().parts; }
  [[nodiscard]] static Rgb mean_of(const Rgb& sum, double sent, double unit) {
    return sent > 0 ? unit / sent * sum : Rgb(0);
  }
  /// Standard error of the mean of the parts that have photons, of which each has about as many; of one part
  /// alone as large as its mean.
  [[nodiscard]] Rgb error_of_parts(std::size_t slot, double unit) const {
    Rgb sum(0), squares(0);
    double parts = 0;
    for (std::size_t part = 0; part < sent_.size(); ++part) {
      if (!(sent_[part] > 0)) continue;
      const Rgb mean = mean_of(tally_.sum(slot, part), sent_[part], unit);
      sum += mean;
      squares += mean * mean;
      ++parts;
    }
    if (parts < 2) return sum;
    return glm::sqrt(glm::max(squares - sum * sum / parts, 0.0) / (parts * (parts - 1)));
  }

  const PhotonTally& tally_;
  const SlotRange& slots_;
  double power_;
  std::vector<double> sent_;  // of each part
  std::array<double, 2> half_sent_{};
};

}  // namespace

std::vector<SensorEstimate> irradiance_estimates(const PhotonTally& tally, const SlotRange& slots,
                                                 double power) {
  const SlotEstimator estimator(tally, slots, power);
  std::vector<SensorEstimate> estimates;
  estimates.reserve(slots.areas.size());
  for (std::size_t k = 0; k < slots.areas.size(); ++k) estimates.push_back(estimator.of(k));
  return estimates;
}

IrradianceErrors irradiance_errors(const PhotonTally& tally, const SlotRange& slots, double power) {
  const SlotEstimator estimator(tally, slots, power);
  const bool knows_each = knows_each_error(tally, slots);
  IrradianceErrors errors;
  Rgb squares(0);
  double area = 0;
  for (std::size_t k = 0; k < slots.areas.size(); ++k) {
    const double weight = slots.areas[k];
    if (!(weight > 0)) continue;
    const SensorEstimate of = estimator.of(k);
    const Rgb apart = 0.5 * (of.half_a - of.half_b);
    area += weight;
    errors.mean += weight * of.mean;
    squares += weight * of.half_a * of.half_b;
    errors.error += weight * (knows_each ? of.error * of.error : apart * apart);
  }
  if (!(area > 0)) return errors;
  errors.mean /= area;
  errors.quadratic_mean = glm::sqrt(glm::max(squares / area, 0.0));
  errors.error = glm::sqrt(errors.error / area);
  return errors;
}

}  // namespace fluxel
