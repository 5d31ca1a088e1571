#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "output/html/html_page.hpp"
#include "output/pictures.hpp"
#include "output/run_record.hpp"

namespace fluxel {

/// What files are written from: made once a run.
struct OutputSource {
  const RunRecord& record;
  std::optional<RunPicture> picture = {};  ///< with a camera, until it is written
  std::optional<double> exposure = {};     ///< of the picture [stops]
  std::optional<double> noise = {};        ///< likewise: see seen_noise
  std::vector<PagePicture> shown = {};     ///< of the camera, for the page of the run
  std::string light_map_png = {};          ///< its bytes; empty: there is no light map
};

/// When a file is written.
enum class OutputTime {
  under_way,  ///< by the run itself, while it works
  solution,   ///< as soon as there is a solution
  end         ///< when all is known that a run comes to, the report last
};

/// A file, or a family of files, that a run may write into its folder.
struct OutputRow {
  std::string_view name;  ///< a `*` stands for the name of a receiver, a `#` for the number of a round
  OutputTime when;
  /// Whether a run writes it that has come as far as the record says.
  bool (*wanted)(const RunRecord&);
  /// Null where the run itself does. Throws InputError where the file cannot be written.
  void (*write)(const std::filesystem::path& file, const OutputSource&);
  std::string_view asked = {};  ///< the name by which --write asks for it; empty: nobody has to
};

/// Whether the run writes the row's files.
[[nodiscard]] bool is_wanted(const OutputRow& row, const RunRecord& record);

/// What --write knows.
[[nodiscard]] std::vector<std::string> asked_names();

/// One row a kind of file: a new one is a function and a row.
[[nodiscard]] std::span<const OutputRow> output_table();

}  // namespace fluxel
