#pragma once

#include <cstddef>
#include <string>

namespace fluxel::bench {

struct OperatorSettings {
  std::string large_scenes;  ///< folder
  std::string only;          ///< this scene alone; empty: the project's two rooms and room-12 where it is
  std::size_t elements = 16384;
  int repetitions = 5;
  std::string csv;
};

/// N^2 pairs a second of RowOperator::apply with the tiles that a scene has, one-sided: all light, and as in
/// the first product of a solve, where only the luminaires send; three channels and one. One thread,
/// processor time; and how many times as fast two threads are, wall-clock time, which needs two idle cores.
/// All take turns. Prints a table. Throws InputError.
void run_operator(const OperatorSettings& settings);

}  // namespace fluxel::bench
