#pragma once

#include <vector>

#include "bench/stability/lab.hpp"

/// The situations of each file, in the order in which they are shown.
namespace fluxel::lab {

[[nodiscard]] std::vector<Situation> sliver_situations();
[[nodiscard]] std::vector<Situation> coincidence_situations();
[[nodiscard]] std::vector<Situation> leak_situations();
[[nodiscard]] std::vector<Situation> topology_situations();
[[nodiscard]] std::vector<Situation> contact_situations();
[[nodiscard]] std::vector<Situation> reflectance_situations();
[[nodiscard]] std::vector<Situation> occlusion_situations();
[[nodiscard]] std::vector<Situation> camera_situations();

}  // namespace fluxel::lab
