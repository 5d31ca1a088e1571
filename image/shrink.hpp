#pragma once

#include "image/tone_map.hpp"

namespace fluxel {

/// The picture with no more than so many columns and rows: squares of pixels by their mean, as it is shown.
[[nodiscard]] DisplayPicture shrunk(const DisplayPicture& picture, int most);

}  // namespace fluxel
