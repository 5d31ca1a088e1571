#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "hierarchy/hierarchy.hpp"
#include "method/round_limit.hpp"

namespace fluxel {

/// What is known of the probes after the last round.
struct ProbedLight {
  std::vector<Rgb> B;  ///< radiosity without what they emit [W/m2]
  Rgb noise{0};        ///< mean square of what rays make of it [W2/m4]
  Rgb mean{0};         ///< what errors are relative to [W/m2]
};

/// Rays of a picture.
struct SettledRays {
  double error = 0;             ///< that is asked of a point's
  std::optional<double> noise;  ///< what they then make of the picture: root mean square over the mean
};

/// The radiosity of a hierarchy after each round, where an error matters: at probes, by rays, or without any
/// in all leaves. Of heat, which black surfaces take too, the irradiance of the leaves. All calls are
/// collective.
class RoundSamples {
 public:
  /// What is referred to must outlive this. `probes`: points of faces.
  RoundSamples(Hierarchy& hierarchy, std::span<const GatherPoint> probes, bool of_heat, RoundLimit& limit)
      : hierarchy_(hierarchy), probes_(probes), of_heat_(of_heat), limit_(limit) {}

  [[nodiscard]] std::span<const GatherPoint> probes() const { return probes_; }

  /// After a round: at probes by rays with this error, two sequences of them.
  void take(double ray_error, std::uint64_t seed);
  /// Multiplies what the last one takes of reflected light from the solution, and sets that scale for all
  /// gathering.
  void scale_reflected(const Rgb& scale);
  /// Between the last two: root mean square over the mean, without the noise of rays; none where there are no
  /// two, or all is dark.
  [[nodiscard]] std::optional<double> change() const;
  /// Of the last: what errors are relative to. Where it is dark, of the scene, so that nothing is not refined
  /// for ever.
  [[nodiscard]] Rgb mean() const;
  [[nodiscard]] ProbedLight probed() const { return {last_.B, last_.noise, mean()}; }

  /// Of a point's rays: what makes this noise, as far as the two sequences of the last sample tell; none
  /// where they do not.
  [[nodiscard]] std::optional<double> ray_error_for(double noise) const;
  /// Rays with an error of at most this that make no more noise than is allowed, if that is said and there is
  /// time to see to it.
  [[nodiscard]] SettledRays settle(double ray_error, std::optional<double> allowed) const;

 private:
  struct Sample {
    std::vector<NodeId> nodes;  // that were leaves; of probes none
    std::vector<Rgb> B;
    Rgb noise{0};  // mean square of what rays make of it [W2/m4]
    double ray_error = 0;
  };

  [[nodiscard]] std::vector<Rgb> of_all_nodes() const;
  [[nodiscard]] std::vector<Rgb> gather(std::span<const GatherPoint> probes, double ray_error,
                                        std::uint64_t seed) const;

  Hierarchy& hierarchy_;
  std::span<const GatherPoint> probes_;
  bool of_heat_;
  RoundLimit& limit_;
  Sample before_, last_;
};

}  // namespace fluxel
