#pragma once

#include <filesystem>
#include <map>
#include <span>
#include <string>

#include "image/exr_writer.hpp"
#include "output/stated_receivers.hpp"

namespace fluxel {

/// receiver-NAME, without an extension.
[[nodiscard]] std::string receiver_stem(const Receiver& receiver);

/// Writes receiver-NAME.exr: the value of every cell, row 0 at the top, and its error. Throws InputError
/// where it cannot.
void write_receiver_picture(const std::filesystem::path& folder, const StatedReceiver& of,
                            std::map<std::string, std::string> attributes);

/// Writes receiver-NAME.png of a grid: its cells in false colours, with legend, isolines and what it comes
/// to. Throws InputError where it cannot.
void write_receiver_map(const std::filesystem::path& folder, const StatedReceiver& of, Units units,
                        const FalseColourScale& scale);

/// Writes all as a table: a line a cell, with its middle [m, world]; of one that is left out nothing more.
void write_receiver_table(const std::filesystem::path& file, const Scene& scene,
                          std::span<const StatedReceiver> receivers);

}  // namespace fluxel
