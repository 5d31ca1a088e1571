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

/// N^2 pairs a second of RowOperator::apply with the tiles that a scene has: all light, and as the first
/// product of a solve, where only the luminaires send. One-sided; three channels and one, one thread and two,
/// all in turns, wall-clock time. Prints a table. Throws InputError.
void run_operator(const OperatorSettings& settings);

}  // namespace fluxel::bench
