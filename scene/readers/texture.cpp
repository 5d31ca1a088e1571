#include "scene/readers/texture.hpp"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <utility>

#include "core/input_error_at.hpp"

namespace fluxel {
namespace {

constexpr int kBlock = 16;                 // pixels between two sums of a row
constexpr double kMaxCrossings = 1 << 20;  // of pixels, by an outline

/// Of rounding in the integral over an outline's length times the largest sum.
constexpr double kLeastArea = 1e-10;

/// IEC 61966-2-1, 5.2: of a code in 0..1.
double linear_of_srgb(double code) {
  return code <= 0.04045 ? code / 12.92 : std::pow((code + 0.055) / 1.055, 2.4);
}

constexpr int kCodes = 65536;

std::vector<double> make_linear_values() {
  std::vector<double> values(kCodes);
  for (int code = 0; code < kCodes; ++code)
    values[static_cast<std::size_t>(code)] = linear_of_srgb(static_cast<double>(code) / (kCodes - 1));
  return values;
}

/// Of each code of 16 bits.
const std::vector<double>& linear_values() {
  static const std::vector<double> values = make_linear_values();
  return values;
}

bool has_transparent_pixel(const DecodedImage& image) {
  if (image.channels != 4) return false;
  const std::size_t sample = image.deep ? 2 : 1, pixel = 4 * sample;
  for (std::size_t at = 3 * sample; at < image.samples.size(); at += pixel) {
    for (std::size_t byte = at; byte < at + sample; ++byte)
      if (image.samples[byte] != 255) return true;
  }
  return false;
}

/// The place of an index among `count` that repeat.
int wrap(double index, int count) { return static_cast<int>(index - std::floor(index / count) * count); }

}  // namespace

Texture Texture::decode(const std::filesystem::path& file, const std::string& bytes) {
  if (is_png(bytes)) return Texture(decode_png(file, bytes));
  if (is_jpeg(bytes)) return Texture(decode_jpeg(file, bytes));
  throw input_error_at(file, 0, "the image is neither PNG nor JPEG", "convert it to one of them");
}

Texture::Texture(DecodedImage image)
    : image_(std::move(image)),
      has_alpha_(has_transparent_pixel(image_)),
      blocks_(static_cast<std::size_t>(image_.width / kBlock) + 1) {
  sums_.reserve(blocks_ * static_cast<std::size_t>(image_.height));
  for (int row = 0; row < image_.height; ++row) {
    Rgb sum{0};
    for (int column = 0; column < image_.width; ++column) {
      if (column % kBlock == 0) sums_.push_back(sum);
      sum += pixel(row, column);
    }
    if (image_.width % kBlock == 0) sums_.push_back(sum);
    mean_ += sum;
  }
  mean_ /= static_cast<double>(image_.width) * image_.height;
}

Rgb Texture::pixel(int row, int column) const {
  const std::vector<double>& linear = linear_values();
  const std::size_t first = (static_cast<std::size_t>(row) * static_cast<std::size_t>(image_.width) +
                             static_cast<std::size_t>(column)) *
                            static_cast<std::size_t>(image_.channels);
  const std::uint8_t* const samples = image_.samples.data();
  if (!image_.deep) {
    const auto value = [&](std::size_t k) { return linear[std::size_t{257} * samples[first + k]]; };
    return {value(0), value(1), value(2)};
  }
  const auto value = [&](std::size_t k) {
    const std::uint8_t* const sample = samples + 2 * (first + k);
    return linear[std::size_t{256} * sample[0] + sample[1]];
  };
  return {value(0), value(1), value(2)};
}

/// Over the pixels left of column number `columns`.
Rgb Texture::sum_of_row(int row, int columns) const {
  const int block = columns / kBlock;
  Rgb sum = sums_[static_cast<std::size_t>(row) * blocks_ + static_cast<std::size_t>(block)];
  for (int column = block * kBlock; column < columns; ++column) sum += pixel(row, column);
  return sum;
}

/// The integral along a row of repeats, from 0 to x [pixels].
Rgb Texture::sum_to(int row, double x) const {
  const double first = std::floor(x), repeats = std::floor(first / image_.width);
  const int column = wrap(first, image_.width);
  Rgb sum = sum_of_row(row, column) + (x - first) * pixel(row, column);
  if (repeats != 0) sum += repeats * sum_of_row(row, image_.width);
  return sum;
}

/// The mean of sum_to over a part of the row; it is linear within each pixel.
Rgb Texture::mean_sum(int row, double from, double to) const {
  const auto [low, high] = std::minmax(from, to);
  Rgb sum = sum_to(row, low), integral{0};
  if (low == high) return sum;
  for (double x = low; x < high;) {
    const double next = std::min(std::floor(x) + 1, high);
    const Rgb end = sum + (next - x) * pixel(row, wrap(std::floor(x), image_.width));
    integral += 0.5 * (next - x) * (sum + end);
    sum = end;
    x = next;
  }
  return integral / (high - low);
}

/// Of sum_to over y, along an edge that begins at its lower end; rows count from the image's lower edge.
Rgb Texture::integral_along(glm::dvec2 from, glm::dvec2 to) const {
  const double slope = (to.x - from.x) / (to.y - from.y);
  Rgb integral{0};
  double x = from.x;
  for (double y = from.y; y < to.y;) {
    const double next = std::min(std::floor(y) + 1, to.y);
    const double next_x = next < to.y ? from.x + (next - from.y) * slope : to.x;
    const int row = image_.height - 1 - wrap(std::floor(y), image_.height);
    integral += (next - y) * mean_sum(row, x, next_x);
    x = next_x;
    y = next;
  }
  return integral;
}

Rgb Texture::mean_over(std::span<const glm::dvec2> corners) const {
  if (corners.empty()) return mean_;
  // In pixels; from the repeat of the first corner, which keeps digits.
  std::vector<glm::dvec2> outline;
  for (const glm::dvec2& corner : corners)
    outline.push_back((corner - glm::floor(corners.front())) * glm::dvec2(image_.width, image_.height));

  double crossings = 0, area = 0, reach = 0;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const glm::dvec2 &a = outline[i], &b = outline[(i + 1) % outline.size()];
    crossings += std::abs(b.x - a.x) + std::abs(b.y - a.y);
    area += 0.5 * (a.x + b.x) * (b.y - a.y);
    reach = std::max(reach, std::abs(a.x));
  }
  if (!(crossings <= kMaxCrossings)) return mean_;
  if (std::abs(area) <= kLeastArea * reach * crossings) {
    return pixel(image_.height - 1 - wrap(std::floor(outline.front().y), image_.height),
                 wrap(std::floor(outline.front().x), image_.width));
  }

  Rgb integral{0};  // Green 1828: over the area, of the pixels; along the outline, of their sums over dy
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const glm::dvec2 &a = outline[i], &b = outline[(i + 1) % outline.size()];
    if (a.y < b.y) integral += integral_along(a, b);
    if (b.y < a.y) integral -= integral_along(b, a);
  }
  return glm::clamp(integral / area, 0.0, 1.0);
}

}  // namespace fluxel
