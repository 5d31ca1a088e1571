#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace fluxel {

/// The pixels that are chosen where each asks to be one of so many, 0 to 1: as many as all ask for together,
/// spread evenly (error diffusion: Floyd & Steinberg 1976, in rows of alternating direction). Row-major, of
/// whole rows of `width`; ascending.
[[nodiscard]] std::vector<std::uint32_t> diffuse_errors(int width, std::span<const float> wanted);

}  // namespace fluxel
