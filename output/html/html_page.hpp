#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "core/options.hpp"
#include "core/units.hpp"

namespace fluxel {

/// A picture of a page.
struct PagePicture {
  enum class Of { camera, map, receiver };

  std::string caption;
  std::string png;  ///< its bytes
  Of of = Of::map;  ///< of the camera: regions of the audit can be marked in it
};

/// What a page shows: one file without any other, nothing of which is read from a network.
struct HtmlPage {
  std::string kind;       ///< the command: solve, view, reference, photons, compare, viewfactors
  std::string name;       ///< of the scene
  std::string command;    ///< that repeats it
  std::string unreached;  ///< what was asked for and has not been reached, as a sentence; empty: nothing
  std::string error_of = "picture";  ///< what a stated error is of
  UnitNames units{"", "", "", ""};
  std::string temperature_unit = "K";
  nlohmann::ordered_json report;                    ///< as in the file beside it
  nlohmann::ordered_json matrix = {};               ///< of view factors: see view_factor_page
  std::vector<PagePicture> pictures = {};           ///< of receivers no more than some are shown
  std::optional<nlohmann::ordered_json> mesh = {};  ///< see shown_mesh
  bool is_dry = false;                              ///< nothing was solved
  bool is_live = false;  ///< the run lasts: the page is read again every few seconds
};

/// Throws InputError where the file cannot be written.
void write_html_page(const std::filesystem::path& file, const HtmlPage& page);

}  // namespace fluxel
