#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace fluxel {

/// What was measured of one colour: for each place, one after another, the difference of what is stated and
/// what each of some independent randomisations finds. The errors of one randomisation at different places
/// may depend on each other.
struct AuditSamples {
  std::span<const double> differences;  ///< `randomisations` entries a place [W/m2]
  std::size_t randomisations = 0;       ///< at least 3

  [[nodiscard]] std::size_t places() const { return differences.size() / randomisations; }
};

/// A mean and its standard error, in the unit of what it is of.
struct AuditedValue {
  double value = 0;
  double of_paths = 0;   ///< standard error, by the spread between randomisations
  double of_places = 0;  ///< what the choice of the places adds to that of all they were drawn from
};

/// The mean difference over some of the places.
[[nodiscard]] AuditedValue audited_bias(const AuditSamples& samples, std::span<const std::uint32_t> places);

/// The mean square difference over all places without the noise of what was measured, and so below 0 now and
/// then: from products of different randomisations, whose expectation is the square of the true difference.
/// `of_paths` is by the jackknife (Efron & Stein 1981).
[[nodiscard]] AuditedValue audited_square(const AuditSamples& samples);

/// By how many standard errors an interval reaches to each side that holds the truth with this chance, or
/// each of several that hold all theirs with it (Bonferroni 1936), where the error is told by so many
/// randomisations (Student 1908).
[[nodiscard]] double interval_width(double chance, std::size_t intervals, std::size_t randomisations);

}  // namespace fluxel
