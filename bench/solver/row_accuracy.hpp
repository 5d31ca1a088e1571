#pragma once

#include <cstddef>
#include <string>

namespace fluxel::bench {

struct AccuracySettings {
  std::size_t along = 408;  ///< elements along the edges of each of the box's six faces, a multiple of 8
  std::size_t rows = 1000;
  std::string csv;
};

/// Rows of F in a closed box, taken by chance: what single precision loses against the same sums in double
/// precision, for every instruction set and rule, beside what the rule itself misses of a row's sum, which is
/// 1. Prints a table; the CSV has a line for each row and rule. Throws InputError.
void run_rows(const AccuracySettings& settings);

}  // namespace fluxel::bench
