#pragma once

#include <filesystem>
#include <span>

#include "image/picture.hpp"
#include "image/tone_map.hpp"
#include "output/run_record.hpp"

namespace fluxel {

/// A run's picture, filtered, and as it is shown.
struct RunPicture {
  Picture picture;
  DisplayPicture display;
};

/// Of a run with a camera.
[[nodiscard]] RunPicture make_run_picture(const RunRecord& record);

/// Writes an early radiosity (an entry an unknown) as a PNG. Throws InputError where it cannot.
void write_early_picture(const std::filesystem::path& file, const Options& options, const Scene& scene,
                         const SubdividedScene& subdivided, std::span<const Rgb> B);

/// Writes what a round of the hierarchical method has come to, likewise, but without Options::median_radius,
/// whose size is in pixels of the whole picture.
void write_early_picture(const std::filesystem::path& file, const Options& options,
                         const EarlyPicture& early);

/// An entry an unknown, by sides.
[[nodiscard]] SurfaceLight split_sides(std::span<const Rgb> B, std::span<const Rgb> H, std::size_t elements);

}  // namespace fluxel
