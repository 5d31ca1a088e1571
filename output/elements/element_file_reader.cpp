#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <optional>

#include "core/input_error_at.hpp"
#include "output/elements/element_file.hpp"
#include "output/elements/element_file_header.hpp"
#include "scene/text_file.hpp"

namespace fluxel {

namespace {

constexpr const char* kHint =
    "give a file of elements: solution.ply of 'fluxel solve' or reference.ply of 'fluxel reference'";

/// What the header says.
struct Header {
  std::size_t vertices = 0;
  std::size_t faces = 0;
  std::vector<std::string> layers;
  bool has_rgb = false;
  std::size_t bytes = 0;  ///< where the vertices begin
};

/// Takes a header's lines one after another.
class Lines {
 public:
  Lines(const std::filesystem::path& file, std::string_view bytes) : file_(file), bytes_(bytes) {}

  [[noreturn]] void refuse(const std::string& what) const { throw input_error_at(file_, line_, what, kHint); }

  /// The next line that is not taken yet.
  [[nodiscard]] std::string_view next() const {
    const std::string_view rest = bytes_.substr(at_);
    const std::size_t end = rest.find('\n');
    if (end == std::string_view::npos) refuse("the header ends too early");
    return rest.substr(0, end);
  }
  void take() {
    at_ += next().size() + 1;
    ++line_;
  }
  void expect(std::string_view text) {
    if (next() != text)
      refuse(fmt::format("is no file of elements that Fluxel has written: '{}' is missing", text));
    take();
  }
  /// What follows the beginning of the next line.
  std::string_view expect_after(std::string_view beginning) {
    if (!next().starts_with(beginning))
      refuse(fmt::format("is no file of elements that Fluxel has written: '{}...' is missing", beginning));
    const std::string_view rest = next().substr(beginning.size());
    take();
    return rest;
  }
  std::size_t expect_count(std::string_view beginning) {
    const std::string_view text = expect_after(beginning);
    std::size_t count = 0;
    const auto [end, failed] = std::from_chars(text.data(), text.data() + text.size(), count);
    if (failed != std::errc{} || end != text.data() + text.size() || count == 0) {
      --line_;
      refuse("is no number of vertices or faces");
    }
    return count;
  }
  [[nodiscard]] std::size_t at() const { return at_; }

 private:
  const std::filesystem::path& file_;
  std::string_view bytes_;
  std::size_t at_ = 0;
  std::size_t line_ = 1;
};

Header read_header(const std::filesystem::path& file, std::string_view bytes) {
  Lines lines(file, bytes);
  Header header;
  lines.expect("ply");
  lines.expect("format binary_little_endian 1.0");
  lines.expect_after(kPlyVersionComment);
  lines.expect(kPlyUnits);
  while (lines.next().starts_with("comment ")) lines.take();
  header.vertices = lines.expect_count(kPlyVertices);
  for (const char* axis : {"x", "y", "z"}) lines.expect(fmt::format("property double {}", axis));
  header.faces = lines.expect_count(kPlyFaces);
  lines.expect(kPlyCorners);
  header.has_rgb = lines.next().starts_with("property uchar ");
  if (header.has_rgb)
    for (const char* colour : {"red", "green", "blue"})
      lines.expect(fmt::format("property uchar {}", colour));
  while (lines.next() != kPlyPatch) {
    std::string_view name = lines.next();
    if (!name.starts_with(kPlyFloat) || !name.ends_with(kPlyColours[0]))
      lines.refuse("is neither a layer's first property nor that of the patch");
    name = name.substr(kPlyFloat.size());
    name.remove_suffix(kPlyColours[0].size());
    if (name.empty() || std::ranges::find(header.layers, name) != header.layers.end())
      lines.refuse("names no new layer");
    for (const std::string_view colour : kPlyColours)
      lines.expect(fmt::format("{}{}{}", kPlyFloat, name, colour));
    header.layers.emplace_back(name);
  }
  if (header.layers.empty()) lines.refuse("no layer stands before the patch");
  lines.take();
  lines.expect("end_header");
  header.bytes = lines.at();
  return header;
}

/// Takes values from the bytes that follow the header.
class Values {
 public:
  Values(const std::filesystem::path& file, std::string_view bytes, std::size_t at)
      : file_(file), bytes_(bytes), at_(at) {}

  [[noreturn]] void refuse(const std::string& what) const {
    throw input_error_at(file_, 0, fmt::format("byte {}: {}", at_, what), kHint);
  }
  template <class T>
  T take() {
    static_assert(std::endian::native == std::endian::little, "the file is little endian");
    if (bytes_.size() - at_ < sizeof(T)) refuse("the file ends too early");
    T value;
    std::memcpy(&value, bytes_.data() + at_, sizeof(T));
    at_ += sizeof(T);
    return value;
  }
  template <class T>
  double take_finite(const char* what) {
    const T value = take<T>();
    if (!std::isfinite(value)) {
      at_ -= sizeof(T);
      refuse(fmt::format("a {} that is not finite", what));
    }
    return static_cast<double>(value);
  }
  [[nodiscard]] bool at_end() const { return at_ == bytes_.size(); }

 private:
  const std::filesystem::path& file_;
  std::string_view bytes_;
  std::size_t at_;
};

Outline<glm::dvec3> take_outline(Values& values, const std::vector<glm::dvec3>& vertices) {
  Outline<glm::dvec3> outline;
  outline.corners = values.take<std::uint8_t>();
  if (outline.corners != 3 && outline.corners != 4)
    values.refuse(fmt::format("a face of {} corners", outline.corners));
  for (std::size_t k = 0; k < outline.corners; ++k) {
    const auto vertex = values.take<std::uint32_t>();
    if (vertex >= vertices.size())
      values.refuse(fmt::format("vertex {} of a face, where there are {}", vertex, vertices.size()));
    outline.corner[k] = vertices[vertex];
  }
  return outline;
}

}  // namespace

ElementFile element_file_of_bytes(const std::filesystem::path& file, std::string_view bytes) {
  const Header header = read_header(file, bytes);
  // Nothing is made room for that the file cannot hold.
  const std::size_t body = bytes.size() - header.bytes;
  const std::size_t vertex_bytes = 3 * sizeof(double);
  const std::size_t layer_bytes = header.layers.size() * kChannels * sizeof(float);
  const std::size_t rgb_bytes = header.has_rgb ? kChannels : 0;
  const std::size_t least_face =
      1 + 3 * sizeof(std::uint32_t) + rgb_bytes + layer_bytes + sizeof(std::uint32_t);
  if (header.vertices > body / vertex_bytes ||
      header.faces > (body - header.vertices * vertex_bytes) / least_face)
    throw input_error_at(file, 0,
                         fmt::format("{} bytes cannot hold {} vertices and {} faces: the file is cut off or "
                                     "its header wrong",
                                     bytes.size(), header.vertices, header.faces),
                         kHint);

  Values values(file, bytes, header.bytes);
  std::vector<glm::dvec3> vertices(header.vertices);
  for (glm::dvec3& vertex : vertices)
    for (int axis = 0; axis < 3; ++axis) vertex[axis] = values.take_finite<double>("coordinate");

  ElementFile result;
  std::vector<std::vector<Rgb>*> layers;
  for (const std::string& name : header.layers) {
    layers.push_back(&result.layers[name]);
    layers.back()->reserve(header.faces);
  }
  result.elements.outlines.reserve(header.faces);
  result.elements.patches.reserve(header.faces);
  for (std::size_t face = 0; face < header.faces; ++face) {
    result.elements.outlines.push_back(take_outline(values, vertices));
    for (std::size_t c = 0; c < rgb_bytes; ++c) static_cast<void>(values.take<std::uint8_t>());
    for (std::vector<Rgb>* layer : layers) {
      Rgb& value = layer->emplace_back();
      for (int c = 0; c < kChannels; ++c) value[c] = values.take_finite<float>("value");
    }
    result.elements.patches.push_back(PatchId{values.take<std::uint32_t>()});
  }
  if (!values.at_end()) values.refuse("more bytes than the header announces");
  return result;
}

ElementFile read_element_file(const std::filesystem::path& file) {
  const std::optional<std::string> bytes = read_text_file(file);
  if (!bytes) throw input_error_at(file, 0, "there is no such file", kHint);
  return element_file_of_bytes(file, *bytes);
}

}  // namespace fluxel
