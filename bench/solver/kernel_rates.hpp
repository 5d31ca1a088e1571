#pragma once

#include <cstddef>
#include <string>

namespace fluxel::bench {

struct KernelSettings {
  std::size_t elements = 16384;
  std::size_t rows = 256;
  int repetitions = 7;
  std::string csv;
};

/// Pairs a second of the row kernel, for every instruction set of this processor, rule and number of
/// channels, beside the plain loop's and what the multipliers could do. One thread, processor time; all take
/// turns in every repetition, and ratios are medians of the repetitions' ratios. Prints a table.
void run_kernel(const KernelSettings& settings);

}  // namespace fluxel::bench
