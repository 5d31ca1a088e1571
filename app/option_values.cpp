#include "app/option_values.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <optional>
#include <sstream>
#include <string_view>
#include <vector>

#include "core/nearest_name.hpp"
#include "core/option_names.hpp"
#include "core/options.hpp"

namespace fluxel {

namespace {

/// A median costs the square of its radius a pixel, on one rank: this is some seconds for a large picture.
constexpr int kLargestMedianRadius = 50;

/// AxB, both from 1 to `most`.
std::optional<std::pair<int, int>> parse_pair(const std::string& text, int most) {
  const std::size_t cross = text.find('x');
  const auto parse = [&text, most](std::size_t first, std::size_t last, int& value) {
    const auto [end, failed] = std::from_chars(text.data() + first, text.data() + last, value);
    return failed == std::errc{} && end == text.data() + last && value >= 1 && value <= most;
  };
  std::pair<int, int> values;
  if (cross == std::string::npos || !parse(0, cross, values.first) ||
      !parse(cross + 1, text.size(), values.second))
    return std::nullopt;
  return values;
}

}  // namespace

double parse_number(const std::string& text) {
  double value = 0;
  const auto [end, failed] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (failed != std::errc{} || end != text.data() + text.size() || !std::isfinite(value))
    throw CLI::ValidationError(fmt::format("'{}' is no finite number", text));
  return value;
}

double parse_above_zero(const std::string& text) {
  const double value = parse_number(text);
  if (!(value > 0)) throw CLI::ValidationError(fmt::format("'{}' must be above 0", text));
  return value;
}

std::uint64_t parse_count(const std::string& text) {
  const double value = parse_number(text);
  if (value < 1 || value > 1e18 || value != std::floor(value))
    throw CLI::ValidationError(fmt::format("'{}' is no whole number from 1 to 1e18", text));
  return static_cast<std::uint64_t>(value);
}

std::uint64_t parse_bytes(const std::string& text) {
  constexpr std::string_view kUnits = "KMG";
  const std::size_t unit = text.empty() ? std::string_view::npos : kUnits.find(text.back());
  if (unit == std::string_view::npos) return parse_count(text);
  const double value =
      parse_number(text.substr(0, text.size() - 1)) * std::ldexp(1.0, 10 * static_cast<int>(unit + 1));
  if (!(value >= 1 && value <= 1e18))
    throw CLI::ValidationError(fmt::format("'{}' is no number of bytes from 1 to 1e18", text));
  return static_cast<std::uint64_t>(value);
}

glm::dvec3 parse_vector(const std::string& text) {
  std::vector<double> values;
  std::istringstream stream(text);
  for (std::string part; std::getline(stream, part, ',');) values.push_back(parse_number(part));
  if (values.size() != 3) throw CLI::ValidationError(fmt::format("'{}' is not x,y,z", text));
  return {values[0], values[1], values[2]};
}

std::pair<int, int> parse_resolution(const std::string& text) {
  const auto size = parse_pair(text, 65536);
  if (!size) throw CLI::ValidationError(fmt::format("'{}' is not WxH with 1 to 65536 pixels a side", text));
  return *size;
}

int parse_median_radius(const std::string& text) {
  if (text == "none") return 0;
  if (text.starts_with("gaussian"))
    throw CLI::ValidationError(
        "the Gaussian filter is gone, as it made every picture worse: leave it out, and for less noise give "
        "a "
        "smaller --target-error, for smoother edges --supersample");
  const std::string kind = "median:";
  if (!text.starts_with(kind))
    throw CLI::ValidationError(fmt::format("'{}' is neither none nor median:R", text));
  const double radius = parse_number(text.substr(kind.size()));
  if (!(radius >= 0 && radius <= kLargestMedianRadius && radius == std::floor(radius)))
    throw CLI::ValidationError(
        fmt::format("'{}': R is a whole number of pixels from 0 to {}", text, kLargestMedianRadius));
  return static_cast<int>(radius);
}

std::vector<std::string> parse_names(const std::string& text, std::span<const std::string> known) {
  std::vector<std::string> names;
  std::istringstream parts(text + ',');
  for (std::string name; std::getline(parts, name, ',');) {
    if (std::ranges::find(known, name) == known.end()) {
      const std::string nearest = nearest_name(name, known);
      throw CLI::ValidationError(
          fmt::format("'{}' is none of {}{}", name, fmt::join(known, ", "),
                      nearest.empty() ? "" : fmt::format(": did you mean '{}'?", nearest)));
    }
    if (std::ranges::find(names, name) == names.end()) names.push_back(name);
  }
  return names;
}

void parse_form_factor(const std::string& text, FormFactorOptions& options) {
  if (const auto rule = kRuleNames.find(text); rule != kRuleNames.end()) {
    options.rule = rule->second;
    return;
  }
  constexpr int kMaxPoints = 64;
  const std::string kind = "points:";
  const auto grid = text.starts_with(kind) ? parse_pair(text.substr(kind.size()), kMaxPoints) : std::nullopt;
  if (!grid)
    throw CLI::ValidationError(
        fmt::format("'{}' is none of adaptive|disc|point|points:MxN (M, N from 1 to {})", text, kMaxPoints));
  options.rule = FormFactor::points;
  options.points = {grid->first, grid->second};
}

void parse_tolerance(const std::string& text, Options& options) {
  const std::string automatic = "auto", with_share = "auto:";
  options.tolerance.reset();
  options.discretisation_share = Options{}.discretisation_share;
  if (text == automatic) return;
  const bool is_share = text.starts_with(with_share);
  const double value = parse_number(is_share ? text.substr(with_share.size()) : text);
  if (is_share) {
    if (!(value > 0 && value <= 1))
      throw CLI::ValidationError(fmt::format("'{}': SHARE is above 0 and at most 1", text));
    options.discretisation_share = value;
  } else {
    if (!(value > 0)) throw CLI::ValidationError(fmt::format("'{}' must be above 0", text));
    options.tolerance = value;
  }
}

}  // namespace fluxel
