#include "app/option_values.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <charconv>
#include <cmath>
#include <sstream>
#include <vector>

namespace fluxel {

double parse_number(const std::string& text) {
  double value = 0;
  const auto [end, failed] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (failed != std::errc{} || end != text.data() + text.size() || !std::isfinite(value))
    throw CLI::ValidationError(fmt::format("'{}' is no finite number", text));
  return value;
}

glm::dvec3 parse_vector(const std::string& text) {
  std::vector<double> values;
  std::istringstream stream(text);
  for (std::string part; std::getline(stream, part, ',');) values.push_back(parse_number(part));
  if (values.size() != 3) throw CLI::ValidationError(fmt::format("'{}' is not x,y,z", text));
  return {values[0], values[1], values[2]};
}

std::pair<int, int> parse_resolution(const std::string& text) {
  const std::size_t cross = text.find('x');
  int width = 0, height = 0;
  const auto parse = [&text](std::size_t first, std::size_t last, int& value) {
    const auto [end, failed] = std::from_chars(text.data() + first, text.data() + last, value);
    return failed == std::errc{} && end == text.data() + last && value >= 1 && value <= 65536;
  };
  if (cross == std::string::npos || !parse(0, cross, width) || !parse(cross + 1, text.size(), height))
    throw CLI::ValidationError(fmt::format("'{}' is not WxH with 1 to 65536 pixels a side", text));
  return {width, height};
}

PictureFilter parse_filter(const std::string& text) {
  const std::size_t colon = text.find(':');
  const std::string kind = text.substr(0, colon);
  if (colon == std::string::npos || (kind != "gaussian" && kind != "median"))
    throw CLI::ValidationError(fmt::format("'{}' is neither gaussian:SIGMA nor median:R", text));
  const double size = parse_number(text.substr(colon + 1));
  if (size < 0 || size > 1000 || (kind == "median" && size != std::floor(size)))
    throw CLI::ValidationError(
        fmt::format("'{}': SIGMA is 0 to 1000 pixels, R a whole number of them", text));
  return {kind == "median" ? PictureFilter::Kind::median : PictureFilter::Kind::gaussian, size};
}

}  // namespace fluxel
