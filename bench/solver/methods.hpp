#pragma once

#include <string>

namespace fluxel::bench {

struct MethodSettings {
  std::string only;  ///< this room alone; empty: all
  std::size_t elements = 5000;
  double limit_seconds = 60;  ///< of processor time; a solve that takes longer is given up
  int repetitions = 3;
  std::string csv;
};

/// Iterations, products with F and seconds (median, of wall clock and of the thread's processor time, which
/// leaves out what other programs take) of every solver to bounds of 1e-3 and 1e-6, in three closed rooms
/// over reflectances; then warm starts. Three channels, one thread, solvers in turns. The bound is that of
/// the iteration alone, without what rounding may do. Prints a table. Throws InputError.
void run_methods(const MethodSettings& settings);

}  // namespace fluxel::bench
