#include "scene/readers/eulumdat_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "scene/readers/c_planes.hpp"
#include "scene/readers/photometric_text.hpp"

namespace fluxel {
namespace {

constexpr double kMetresPerMillimetre = 1e-3;
constexpr std::size_t kMaxLampSets = 1000;

/// The lines of the file up to its angles, as far as they matter.
struct EulumdatHeader {
  std::size_t symmetry = 0;  ///< Isym
  std::size_t C_planes = 0;  ///< Mc, of the whole turn
  std::size_t gammas = 0;    ///< Ng
  double light_output = 0;   ///< LORL: flux of the luminaire per flux of its lamps [%]
  double lamp_flux = 0;      ///< of the first set [lm]
  double scale = 0;          ///< intensities [cd] per number of the file
};

void skip_lines(PhotometricText& text, std::size_t count, const char* subject) {
  for (std::size_t k = 0; k < count; ++k) text.require_line(subject);
  text.skip_line();
}

/// Goes to a line that is not to be blank.
void require_value(PhotometricText& text, const char* subject) {
  text.require_line(subject);
  if (text.line().empty()) throw text.error(fmt::format("{}: the line is empty", subject));
}

double number_of_line(PhotometricText& text, const char* subject) {
  require_value(text, subject);
  return text.number(subject);
}

std::size_t count_of_line(PhotometricText& text, const char* subject, std::size_t least) {
  require_value(text, subject);
  return text.count(subject, least);
}

double length_of_line(PhotometricText& text, const char* subject) {
  require_value(text, subject);
  return text.length(kMetresPerMillimetre, subject);
}

/// The luminous area: its length lies along C = 90 degrees, its width along C = 0, across the lamps; a width
/// of 0 stands for a circle.
void read_area(PhotometricText& text, PhotometricFile& result) {
  const double length = length_of_line(text, "length of the luminous area");
  const double width = length_of_line(text, "width of the luminous area");
  if (length < 0 || width < 0) throw text.error("the size of the luminous area is negative");
  result.round = width == 0 && length > 0;
  result.size = {result.round ? length : width, length};
  double height = 0;
  for (const char* subject : {"height of the luminous area at C0", "height of the luminous area at C90",
                              "height of the luminous area at C180", "height of the luminous area at C270"})
    height = std::max(height, std::abs(length_of_line(text, subject)));
  if (height > 0)
    result.notes.push_back(
        fmt::format("the luminous area's height, up to {} m, is left out: it is flat", height));
}

/// The sets of lamps, of which each has six lines: number, type, flux, colour, colour rendering, power.
void read_lamps(PhotometricText& text, EulumdatHeader& header, std::vector<std::string>& notes) {
  const std::size_t sets = count_of_line(text, "number of sets of lamps", 1);
  if (sets > kMaxLampSets) throw text.error(fmt::format("{} sets of lamps are too many", sets));
  skip_lines(text, 2, "the lamps' flux");
  header.lamp_flux = number_of_line(text, "flux of the lamps");
  if (!(header.lamp_flux > 0))
    throw text.error(fmt::format("flux of the lamps {} is not greater than 0", header.lamp_flux));
  skip_lines(text, 3 + 6 * (sets - 1), "the last set of lamps");
  if (sets > 1)
    notes.push_back(fmt::format("the first of {} sets of lamps is taken, of {} lm", sets, header.lamp_flux));
}

EulumdatHeader read_eulumdat_header(PhotometricText& text, PhotometricFile& result) {
  EulumdatHeader header;
  skip_lines(text, 2, "the symmetry");  // company, type
  header.symmetry = count_of_line(text, "symmetry", 0);
  if (header.symmetry > 4) throw text.error(fmt::format("symmetry {} is unknown", header.symmetry), "0 to 4");
  header.C_planes = count_of_line(text, "number of C planes", 1);
  skip_lines(text, 1, "the number of intensities");  // distance of C planes
  header.gammas = count_of_line(text, "number of intensities of a C plane", 2);
  skip_lines(text, 9,
             "the luminous area");  // distance of intensities, report, names, date, size of the luminaire
  read_area(text, result);
  skip_lines(text, 1, "the light output ratio");  // downward flux fraction
  header.light_output = number_of_line(text, "light output ratio");
  const double factor = number_of_line(text, "conversion factor of intensities");
  if (!(factor > 0))
    throw text.error(fmt::format("conversion factor of intensities {} is not greater than 0", factor));
  const double tilt = number_of_line(text, "tilt of measurement");
  if (tilt != 0)
    result.notes.push_back(
        fmt::format("the luminaire was measured with a tilt of {} degrees, which is left out", tilt));
  read_lamps(text, header, result.notes);
  header.scale = factor * header.lamp_flux / 1000;  // from cd of 1000 lm of the lamps
  skip_lines(text, 10, "the C angles");             // direct ratios
  return header;
}

/// The planes whose intensities the file has.
struct MeasuredPlanes {
  std::size_t first = 0, count = 1;  ///< of the planes of the whole turn, which go on from the start
  int mirrors = 0;                   ///< that expand them
  double from = 0, to = 0;           ///< the planes at which they begin and end [degrees]
};

MeasuredPlanes measured_planes(const PhotometricText& text, std::size_t symmetry,
                               const std::vector<double>& C) {
  const std::size_t all = C.size();
  const std::size_t parts = symmetry == 4 || symmetry == 3 ? 4 : symmetry == 2 ? 2 : 1;
  if (all % parts != 0)
    throw text.error(fmt::format("symmetry {} of {} C planes", symmetry, all),
                     fmt::format("their number must be divisible by {}", parts));
  switch (symmetry) {
    case 0:
      return {0, all, 0, C.front(), C.back()};
    case 1:
      return {0, 1, 0, C.front(), C.front()};
    case 2:
      return {0, all / 2 + 1, 1, 0, 180};
    case 3:
      return {3 * all / 4, all / 2 + 1, 1, 270, 90 + 360};
    default:
      return {0, all / 4 + 1, 2, 0, 90};
  }
}

/// The measured planes, without intensities yet; they ascend, beyond 360 degrees where they pass C = 0.
std::vector<CPlane> place_planes(const PhotometricText& text, const MeasuredPlanes& measured,
                                 const std::vector<double>& C) {
  std::vector<CPlane> planes;
  for (std::size_t k = measured.first; k < measured.first + measured.count; ++k)
    planes.push_back({k < C.size() ? C[k] : C[k - C.size()] + 360, {}});
  if (planes.front().C != measured.from || planes.back().C != measured.to)
    throw text.error(fmt::format("intensities go from C {} to C {}", planes.front().C, planes.back().C),
                     fmt::format("by the symmetry from C {} to C {}", measured.from, measured.to));
  return planes;
}

}  // namespace

PhotometricFile read_eulumdat_text(const std::filesystem::path& file, const std::string& bytes) {
  PhotometricText text(file, bytes, Comma::decimal_point);
  PhotometricFile result;
  const EulumdatHeader header = read_eulumdat_header(text, result);
  const std::vector<double> C = text.angles(header.C_planes, 360, "C angle");
  const std::vector<double> gamma = text.angles(header.gammas, 180, "gamma angle");
  note_dark_angles(gamma, result.notes);
  const MeasuredPlanes measured = measured_planes(text, header.symmetry, C);
  std::vector<CPlane> planes = place_planes(text, measured, C);
  for (CPlane& plane : planes) plane.intensity = text.intensities(header.gammas, header.scale);
  if (text.has_trailing_text()) result.notes.emplace_back("what follows the last intensity is left out");
  for (int k = 0; k < measured.mirrors; ++k) mirror_planes(planes);
  result.table = make_intensity_table(std::move(planes), gamma);

  const double sent = flux(result.table), stated = header.light_output / 100 * header.lamp_flux;
  if (!(sent >= kLeastFlux))
    throw text.error("the luminaire has no flux", "its intensities are all 0 or nearly so");
  if (stated > 0 && std::abs(sent - stated) > 0.05 * stated)
    result.notes.push_back(fmt::format(
        "intensities are of {:.6g} lm, the light output ratio of {} % of {} lm; the intensities count", sent,
        header.light_output, header.lamp_flux));
  return result;
}

}  // namespace fluxel
