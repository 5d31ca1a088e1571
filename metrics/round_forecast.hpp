#pragma once

#include <cstdint>
#include <span>

namespace fluxel {

/// What a round of the hierarchical method came to, or may come to.
struct RoundSample {
  double block_error = 0;  ///< what a link may leave; it falls from round to round
  double links = 0;        ///< or rows of rays
  double bytes = 0;        ///< of the largest rank's tree and links
  double seconds = 0;      ///< of the round
};

/// The block error of the next round: what the error, of whose square it is a measure, has to fall to for the
/// target, but not too far at once.
[[nodiscard]] double next_block_error(double block_error, double error, double target);

/// What a round with a smaller block error would come to: powers of the block error, as between the last two
/// rounds; after a single one inversely proportional to it. At least one round is needed.
[[nodiscard]] RoundSample forecast_round(std::span<const RoundSample> rounds, double block_error);

/// What rounds with these block errors, descending, would come to: links and bytes of the last one, seconds
/// of all of them. At least one round is needed.
[[nodiscard]] RoundSample forecast_rounds(std::span<const RoundSample> rounds,
                                          std::span<const double> block_errors);

}  // namespace fluxel
