#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "core/rgb.hpp"

namespace fluxel {

/// Layers of three colours over the same pixels: a picture or a receiver, with what is known of its error.
/// Row-major, row 0 at the top.
struct LayeredImage {
  int width = 0;
  int height = 0;
  /// By name, each of width * height values. The one without a name is the picture itself.
  std::map<std::string, std::vector<Rgb>, std::less<>> layers;

  [[nodiscard]] std::size_t pixels() const {
    return static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  }
};

}  // namespace fluxel
