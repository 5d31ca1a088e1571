#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "bench/visibility/measure.hpp"

namespace fluxel::bench {

/// Which scenes, and how they are made.
struct Choice {
  std::string large_scenes;  ///< folder
  std::string only;          ///< this scene alone; empty: all of the run
  bool triangles = false;    ///< cut all polygons into triangles first
};

// Each run prints a table and throws InputError for bad choices. Large scenes that are not there are skipped
// with a message; CSV files have a line a scene and value.

/// Speed and memory of the engine against the number of elements.
void run_visibility(const Choice& choice, const std::vector<std::size_t>& sizes,
                    const MeasureSettings& settings, const std::string& csv);

/// Time of camera subdivision against resolution [pixels a side].
void run_subdivision(const Choice& choice, const std::vector<int>& resolutions, int repetitions,
                     const std::string& csv);

/// The engine alone, once, over the scene that the choice names, for a profiler; prints the hash of all bits,
/// which any change of the engine must keep.
void run_trace(const Choice& choice, std::size_t size);

}  // namespace fluxel::bench
