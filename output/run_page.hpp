#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "output/output_table.hpp"

namespace fluxel {

/// Pixels along a side of a picture in a page.
inline constexpr int kMostPagePixels = 1280;

/// The picture of the camera, small enough for a page, and its false colours.
[[nodiscard]] std::vector<PagePicture> shown_pictures(const OutputSource& source);

/// Writes the run as a page, report.html: its report, pictures, receivers and mesh. Throws InputError where
/// it cannot.
void write_run_page(const std::filesystem::path& file, const OutputSource& source);

/// The command that has been given, and how many ranks ran it.
[[nodiscard]] std::string command_text(const std::string& command, std::size_t ranks);

/// Pictures of receivers that have been written into the folder.
void add_plans(const std::filesystem::path& folder, std::span<const Receiver> receivers,
               std::vector<PagePicture>& pictures);

}  // namespace fluxel
