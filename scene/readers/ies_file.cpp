#include "scene/readers/ies_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <utility>

#include "scene/readers/c_planes.hpp"
#include "scene/readers/photometric_text.hpp"
#include "scene/readers/statements.hpp"

namespace fluxel {
namespace {

constexpr double kMetresPerFoot = 0.3048;

std::string in_capitals(std::string_view text) {
  std::string capitals(text);
  std::ranges::transform(capitals, capitals.begin(),
                         [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  return capitals;
}

/// The year of the standard by a file's first line: "IESNA91", "IESNA:LM-63-2002"; those of 1986 have none.
int year_of_standard(std::string_view line) {
  const std::size_t start = line.find("IES");
  if (start > 3) return 1986;  // but for a byte order mark, it begins the line
  const std::string_view name = trim(line.substr(start));
  const std::size_t before = name.find_last_not_of("0123456789");
  double year = 0;
  if (read_number(name.substr(before + 1), year)) return 1986;
  return static_cast<int>(std::min(year < 50 ? 2000 + year : year < 100 ? 1900 + year : year, 9999.0));
}

/// What the lines before the numbers say.
struct IesHeader {
  int year = 1986;                   ///< of the standard
  Units units = Units::photometric;  ///< of the intensities
  double intensity_unit = 1;         ///< [cd] or [W/sr]
  std::string tilt;                  ///< in capitals, of "TILT=..."
};

/// Of a line `[_INTENSITYUNITS] UNIT`.
void read_intensity_unit(const PhotometricText& text, const std::string& unit, IesHeader& header) {
  if (unit == "CD" || unit == "CANDELA") return;
  if (unit != "W/SR" && unit != "MW/SR")
    throw text.error(fmt::format("intensities in {} are unknown", in_quotes(unit)), "cd, W/sr or mW/sr");
  header.units = Units::radiometric;
  header.intensity_unit = unit == "W/SR" ? 1 : 1e-3;
}

IesHeader read_ies_header(PhotometricText& text) {
  const std::string keyword = "[_INTENSITYUNITS]", tilt = "TILT=";
  IesHeader header;
  for (bool first = true; text.next_line(); first = false) {
    if (first) header.year = year_of_standard(text.line());
    const std::string line = in_capitals(text.line());
    if (line.starts_with(keyword))
      read_intensity_unit(text, std::string(trim(std::string_view(line).substr(keyword.size()))), header);
    if (!line.starts_with(tilt)) continue;
    header.tilt = trim(std::string_view(line).substr(tilt.size()));
    if (header.tilt != "NONE" && header.tilt != "INCLUDE")
      throw text.error(fmt::format("TILT={}: other files of lamp tilt are not read", header.tilt),
                       "known: TILT=NONE, and TILT=INCLUDE followed by that file's numbers");
    text.skip_line();
    return header;
  }
  throw text.error("this is no IES file of photometric data", "no line begins with TILT=");
}

/// Passes over the factors by which the flux changes where the luminaire is tilted.
void pass_tilt(PhotometricText& text, std::vector<std::string>& notes) {
  static_cast<void>(text.count("lamp to luminaire geometry", 1));
  const std::size_t count = text.count("number of tilt angles", 0);
  static_cast<void>(text.angles(count, 180, "tilt angle"));
  for (std::size_t k = 0; k < count; ++k) static_cast<void>(text.number("tilt factor"));
  notes.emplace_back("TILT factors are left out: the lamp burns as it was measured");
}

/// The luminous opening by its width (along C = 90 degrees), length (along C = 0) and height, whose signs and
/// zeros say its shape: table 1 of LM-63-2002, and before the list of LM-63-1991 and 1995, where -d, 0, 0 is
/// a circle. What stands upright is reduced to its outline from below.
void set_opening(int year, double width, double length, double height, PhotometricFile& result) {
  const bool since_2002 = year >= 2002;
  if (width == 0 && length > 0 && height < 0) width = -height;  // horizontal cylinders
  if (length == 0 && width > 0 && height < 0) length = -height;
  const bool is_lying_or_facing_aside = since_2002 && height < 0 && width * length <= 0;
  result.round = (width < 0 || length < 0) && !is_lying_or_facing_aside;
  if (result.round && length == 0) length = width;
  if (result.round && width == 0) width = length;
  result.size = {std::abs(length), std::abs(width)};
  if (height != 0)
    result.notes.push_back(
        fmt::format("the luminous opening's height is left out: it is flat, {:.4g} m by {:.4g} m",
                    result.size.x, result.size.y));
}

/// The planes of all C by those that symmetry leaves.
void expand_planes(const PhotometricText& text, std::vector<CPlane>& planes,
                   std::vector<std::string>& notes) {
  const double first = planes.front().C, last = planes.back().C;
  if (planes.size() == 1) {
    if (first != 0)
      notes.push_back(fmt::format("the horizontal angle {} stands alone and is taken for all", first));
    return;
  }
  if (first == 0 && last == 90) {
    mirror_planes(planes);
    mirror_planes(planes);
  } else if ((first == 0 && last == 180) || (first == 90 && last == 270)) {
    mirror_planes(planes);
  } else if (first == 0 && last > 180) {
    if (last < 360)
      notes.push_back(
          fmt::format("from the last horizontal angle, {}, to 360 degrees is interpolated", last));
    else if (planes.back().intensity != planes.front().intensity)
      notes.emplace_back("the intensities at 0 and 360 degrees differ: those at 0 count");
  } else {
    throw text.error(fmt::format("horizontal angles go from {} to {} degrees", first, last),
                     "known: 0 alone, 0 to 90, 0 to 180, 90 to 270, 0 to 360");
  }
}

void require_type_c(const PhotometricText& text, std::size_t type) {
  if (type == 1) return;
  if (type > 3)
    throw text.error(fmt::format("photometric type {} is unknown", type), "1 (C), 2 (B) or 3 (A)");
  throw text.error(fmt::format("photometry of type {} is not read", type == 2 ? 'B' : 'A'),
                   "only type C: convert the file");
}

double positive_number(PhotometricText& text, const char* subject) {
  const double value = text.number(subject);
  if (!(value > 0)) throw text.error(fmt::format("{} {} is not greater than 0", subject, value));
  return value;
}

}  // namespace

PhotometricFile read_ies_text(const std::filesystem::path& file, const std::string& bytes) {
  PhotometricText text(file, bytes, Comma::separator);
  PhotometricFile result;
  const IesHeader header = read_ies_header(text);
  result.units = header.units;
  if (header.tilt == "INCLUDE") pass_tilt(text, result.notes);

  // Intensities are those of the luminaire, whether its lamps' lumens are stated or, by -1, absolute.
  static_cast<void>(text.number("number of lamps"));
  static_cast<void>(text.number("lumens per lamp"));
  double scale = header.intensity_unit * positive_number(text, "candela multiplier");
  const std::size_t gammas = text.count("number of vertical angles", 2);
  const std::size_t planes = text.count("number of horizontal angles", 1);
  require_type_c(text, text.count("photometric type", 1));
  const std::size_t unit = text.count("units type", 1);
  if (unit > 2) throw text.error(fmt::format("units type {} is unknown", unit), "1 (feet) or 2 (metres)");
  const double metres = unit == 1 ? kMetresPerFoot : 1;
  const double width = text.length(metres, "width of the luminous opening");
  const double length = text.length(metres, "length of the luminous opening");
  const double height = text.length(metres, "height of the luminous opening");
  set_opening(header.year, width, length, height, result);
  scale *= positive_number(text, "ballast factor");
  // It is for future use since 1995, and since 2019 says how the file was made.
  const double lamp_factor = text.number("ballast-lamp photometric factor");
  if (header.year < 1995) {
    if (!(lamp_factor > 0)) throw text.error("the ballast-lamp photometric factor is not greater than 0");
    scale *= lamp_factor;
  }
  static_cast<void>(text.number("input watts"));

  const std::vector<double> gamma = text.angles(gammas, 180, "vertical angle");
  std::vector<CPlane> measured;
  note_dark_angles(gamma, result.notes);
  for (const double C : text.angles(planes, 360, "horizontal angle")) measured.push_back({C, {}});
  for (CPlane& plane : measured) plane.intensity = text.intensities(gammas, scale);
  if (text.has_trailing_text()) result.notes.emplace_back("what follows the last intensity is left out");
  expand_planes(text, measured, result.notes);
  result.table = make_intensity_table(std::move(measured), gamma);
  if (!(flux(result.table) >= kLeastFlux))
    throw text.error("the luminaire has no flux", "its intensities are all 0 or nearly so");
  return result;
}

}  // namespace fluxel
