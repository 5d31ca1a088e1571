#include "scene/readers/photometric_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "scene/readers/statements.hpp"

namespace fluxel {
namespace {

constexpr double kMaxCount = 1e9;
constexpr double kMaxIntensity = 1e15;  // as of exitances
constexpr double kMaxLength = 1e4;      // of luminaires [m]

}  // namespace

bool PhotometricText::next_line() {
  line_ = {};
  if (rest_.empty()) return false;
  const std::size_t end = std::min(rest_.find_first_of("\r\n"), rest_.size());
  line_ = rest_.substr(0, end);
  rest_.remove_prefix(end);
  rest_.remove_prefix(rest_.starts_with("\r\n") ? 2 : std::min<std::size_t>(1, rest_.size()));
  ++line_number_;
  return true;
}

std::string_view PhotometricText::line() const { return trim(line_); }

void PhotometricText::require_line(const char* subject) {
  if (!next_line()) throw ends_before(subject);
}

double PhotometricText::length(double metres_per_unit, const char* subject) {
  const double value = number(subject) * metres_per_unit;
  if (!(std::abs(value) <= kMaxLength))
    throw error(fmt::format("{}: {} m is too large", subject, value), fmt::format("at most {}", kMaxLength));
  return value;
}

double PhotometricText::number(const char* subject) {
  const std::string_view word = next_word();
  if (word.empty()) throw ends_before(subject);
  return parse(word, subject);
}

std::size_t PhotometricText::count(const char* subject, std::size_t least) {
  const double value = number(subject);
  if (value != std::floor(value) || value < static_cast<double>(least) || value > kMaxCount)
    throw error(fmt::format("{}: {} is no whole number from {} to {}", subject, value, least, kMaxCount));
  return static_cast<std::size_t>(value);
}

// No place is reserved by a count that only the file vouches for.
std::vector<double> PhotometricText::angles(std::size_t count, double most, const char* subject) {
  std::vector<double> angles;
  while (angles.size() < count) {
    const std::string_view word = next_word();
    if (word.empty()) throw ends_before(fmt::format("{} {} of {}", subject, angles.size() + 1, count));
    const double angle = parse(word, subject);
    if (!(angle >= 0 && angle <= most))
      throw error(fmt::format("{}: {} is not within 0 to {} degrees", subject, angle, most));
    if (!angles.empty() && angle <= angles.back())
      throw error(fmt::format("{}: {} follows {}", subject, angle, angles.back()), "angles must ascend");
    angles.push_back(angle);
  }
  return angles;
}

std::vector<double> PhotometricText::intensities(std::size_t count, double scale) {
  std::vector<double> values;
  while (values.size() < count) {
    const std::string_view word = next_word();
    if (word.empty()) throw ends_before(fmt::format("intensity {} of {}", values.size() + 1, count));
    const double value = parse(word, "intensity");
    if (value < 0) throw error(fmt::format("intensity {} is negative", value));
    if (!(value * scale <= kMaxIntensity)) throw error(fmt::format("intensity {} is too large", value));
    values.push_back(value * scale);
  }
  return values;
}

bool PhotometricText::has_trailing_text() {
  const std::string_view word = next_word();
  double value = 0;
  if (!word.empty() && !read_number(word, value))
    throw error("the file holds more numbers than it promises", "are the counts of angles right?");
  return !word.empty();
}

std::string_view PhotometricText::next_word() {
  const std::string_view separators = comma_ == Comma::separator ? " \t\v\f," : " \t\v\f";
  for (;;) {
    line_.remove_prefix(std::min(line_.find_first_not_of(separators), line_.size()));
    if (!line_.empty()) break;
    if (!next_line()) return {};
  }
  const std::string_view word = line_.substr(0, line_.find_first_of(separators));
  line_.remove_prefix(word.size());
  return word;
}

double PhotometricText::parse(std::string_view word, const char* subject) const {
  std::string digits(word);
  if (comma_ == Comma::decimal_point) std::ranges::replace(digits, ',', '.');
  double value = 0;
  if (const std::optional<std::string> fault = read_number(digits, value))
    throw error(fmt::format("{}: {}", subject, *fault));
  return value;
}

InputError PhotometricText::ends_before(const std::string& what) const {
  return error(fmt::format("the file ends before {}", what));
}

}  // namespace fluxel
