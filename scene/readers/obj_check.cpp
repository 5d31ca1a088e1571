#include "scene/readers/obj_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <map>
#include <string_view>

#include "core/input_error_at.hpp"
#include "scene/list_names.hpp"
#include "scene/readers/statements.hpp"

namespace fluxel {
namespace {

constexpr std::size_t kMaxCorners = 4096;         // triangulation takes the square of it
constexpr std::size_t kMaxVertices = 2147483647;  // the parser counts in int
constexpr double kMaxMagnitude = 1e15;            // far above any scene, far below the parser's limits

void append_number(std::string& out, double value) {
  char digits[32];
  const auto end = std::to_chars(std::begin(digits), std::end(digits), value).ptr;
  out.append(digits, end).push_back(' ');
}

void append_integer(std::string& out, std::int64_t value) {
  char digits[24];
  const auto end = std::to_chars(std::begin(digits), std::end(digits), value).ptr;
  out.append(digits, end);
}

/// Statements of smoothing and of what a face's corners have beside their place.
bool is_passed_over(std::string_view keyword) { return keyword == "vn" || keyword == "vt" || keyword == "s"; }

/// One pass over an OBJ file.
class ObjCheck {
 public:
  ObjCheck(const std::filesystem::path& file, const std::string& text, const TextLookup& lookup)
      : file_(file), text_(text), lookup_(lookup), at_(file, text) {}

  CheckedObj run() {
    read_all_libraries();
    while (at_.next()) {
      std::string_view rest = at_.statement();
      const std::string_view keyword = next_word(rest);
      if (keyword == "v") {
        check_vertex(rest);
      } else if (keyword == "f") {
        check_face(rest);
      } else if (keyword == "g" || keyword == "o") {
        const std::string_view name = trim(rest);
        append_line("o", name.empty() ? "default" : name);
      } else if (keyword == "usemtl") {
        use_material(trim(rest));
      } else if (keyword == "vt" && has_maps()) {
        check_texture_coordinate(rest);
      } else if (keyword != "mtllib" && !is_passed_over(keyword)) {
        unused_.add(keyword);
      }
    }
    check_forward_indices(forward_, vertices_, "face index", "vertices");
    check_forward_indices(forward_texture_, texture_coordinates_, "texture index", "texture coordinates");
    check_used_materials();
    if (!unused_.empty())
      checked_.materials.notes.push_back(
          fmt::format("{}: not used: {}; only faces are", file_.string(), unused_.list()));
    return std::move(checked_);
  }

 private:
  struct ForwardIndex {
    std::int64_t index;
    std::size_t line;
  };

  void append_line(std::string_view keyword, std::string_view name) {
    checked_.geometry.append(keyword).push_back(' ');
    checked_.geometry.append(name).push_back('\n');
  }

  [[nodiscard]] bool has_maps() const { return !checked_.materials.maps.empty(); }

  void append_coordinate(std::string_view word, const char* subject) {
    const double value = parse_number(at_, word, subject);
    if (std::abs(value) > kMaxMagnitude) {
      throw at_.error(fmt::format("{} {} is too large", subject, in_quotes(word)),
                      fmt::format("at most {}", kMaxMagnitude));
    }
    append_number(checked_.geometry, value);
  }

  void check_vertex(std::string_view rest) {
    checked_.geometry += "v ";
    for (int axis = 0; axis < 3; ++axis) append_coordinate(next_value(rest), "vertex coordinate");
    checked_.geometry.back() = '\n';
    if (++vertices_ > kMaxVertices) throw at_.error("too many vertices");
  }

  /// `vt u v`, of which v is 0 where it is left out.
  void check_texture_coordinate(std::string_view rest) {
    checked_.geometry += "vt ";
    append_coordinate(next_value(rest), "texture coordinate");
    const std::string_view v = next_value(rest);
    append_coordinate(v.empty() ? "0" : v, "texture coordinate");
    checked_.geometry.back() = '\n';
    if (++texture_coordinates_ > kMaxVertices) throw at_.error("too many texture coordinates");
  }

  void check_face(std::string_view rest) {
    checked_.geometry += "f ";
    std::size_t corners = 0;
    for (std::string_view word = next_value(rest); !word.empty(); word = next_value(rest)) {
      if (++corners > kMaxCorners)
        throw at_.error(fmt::format("a face of more than {} corners", kMaxCorners));
      append_corner(word);
    }
    if (corners < 3) {
      throw at_.error(fmt::format("a face needs at least 3 corners, this one has {}", corners));
    }
    checked_.geometry.back() = '\n';
  }

  /// The vertex of `v`, `v/vt`, `v//vn` or `v/vt/vn`, counted from 1, and of textured materials its vt.
  void append_corner(std::string_view word) {
    const char* const end = word.data() + word.size();
    std::int64_t index = 0, texture = 0;
    const char* next = word.data();
    for (int part = 0; part < 3; ++part) {
      std::int64_t value = 0;
      const auto [stop, status] = std::from_chars(next, end, value);
      const bool left_out = part == 1 && stop == next;  // v//vn
      if (status != std::errc{} && !left_out) {
        throw at_.error(fmt::format("face index {} is not a whole number", in_quotes(word)));
      }
      if (part == 0) index = value;
      if (part == 1 && !left_out) texture = value;
      next = stop;
      if (next == end || *next != '/' || part == 2) break;
      ++next;
    }
    if (next != end) throw at_.error(fmt::format("face index {} is not a whole number", in_quotes(word)));

    if (index == 0)
      throw at_.error(fmt::format("face index {} is 0", in_quotes(word)), "vertices count from 1");
    append_integer(checked_.geometry, from_start(index, vertices_, forward_, word, "face index", "vertices"));
    if (texture != 0 && is_textured_) {
      checked_.geometry.push_back('/');
      append_integer(checked_.geometry, from_start(texture, texture_coordinates_, forward_texture_, word,
                                                   "texture index", "texture coordinates"));
    }
    checked_.geometry.push_back(' ');
  }

  /// An index counted from the first, where it may count back from the `count` that stand before it.
  std::int64_t from_start(std::int64_t index, std::size_t count, std::vector<ForwardIndex>& forward,
                          std::string_view word, const char* subject, const char* kind) {
    const auto known = static_cast<std::int64_t>(count);
    if (index < -known) {
      throw at_.error(fmt::format("{} {} is out of range", subject, in_quotes(word)),
                      fmt::format("{} {} stand before this line", known, kind));
    }
    if (index > known) forward.push_back({index, at_.line()});
    return index < 0 ? known + 1 + index : index;
  }

  void check_forward_indices(const std::vector<ForwardIndex>& forward, std::size_t count, const char* subject,
                             const char* kind) const {
    for (const ForwardIndex& ahead : forward) {
      if (ahead.index > static_cast<std::int64_t>(count)) {
        throw input_error_at(file_, ahead.line, fmt::format("{} '{}' is out of range", subject, ahead.index),
                             fmt::format("the file has {} {}", count, kind));
      }
    }
  }

  void use_material(std::string_view name) {
    if (name.empty()) throw at_.error("usemtl names no material");
    used_.try_emplace(std::string(name), at_.line());
    is_textured_ = checked_.materials.maps.contains(std::string(name));
    append_line("usemtl", name);
  }

  void check_used_materials() const {
    for (const auto& [name, line] : used_) {
      if (checked_.materials.places.contains(name)) continue;
      std::vector<std::string> known;
      for (const auto& material : checked_.materials.places) known.push_back(material.first);
      throw input_error_at(file_, line, fmt::format("usemtl of an unknown material {}", in_quotes(name)),
                           known.empty() ? "no material is defined: is a mtllib line missing?"
                                         : "known: " + list_names(known));
    }
  }

  /// Before all else: what has textures decides what is kept of faces.
  void read_all_libraries() {
    Statements at(file_, text_);
    while (at.next()) {
      std::string_view rest = at.statement();
      if (next_word(rest) == "mtllib") read_libraries(at, trim(rest));
    }
  }

  /// File names may hold blanks, and there may be several: the whole line is tried first.
  void read_libraries(const Statements& at, std::string_view names) {
    if (names.empty()) throw at.error("mtllib names no file");
    const std::filesystem::path folder = file_.parent_path();
    const std::filesystem::path whole = folder / names;
    if (read_library(whole)) return;
    std::string_view rest = names;
    const bool several = next_word(rest) != names;
    for (rest = names; several && !rest.empty();) {
      const std::filesystem::path path = folder / next_word(rest);
      if (!read_library(path)) throw missing_library(at, path);
    }
    if (!several) throw missing_library(at, whole);
  }

  [[nodiscard]] static InputError missing_library(const Statements& at, const std::filesystem::path& path) {
    return at.error(fmt::format("cannot find the material file '{}'", path.string()));
  }

  bool read_library(const std::filesystem::path& path) {
    if (std::find(libraries_.begin(), libraries_.end(), path) != libraries_.end()) return true;
    const std::optional<std::string> text = lookup_(path);
    if (!text) return false;
    libraries_.push_back(path);
    check_mtl_text(path, *text, checked_.materials);
    return true;
  }

  const std::filesystem::path& file_;
  const std::string& text_;
  const TextLookup& lookup_;
  Statements at_;
  CheckedObj checked_;
  std::size_t vertices_ = 0, texture_coordinates_ = 0;
  std::vector<ForwardIndex> forward_, forward_texture_;
  bool is_textured_ = false;  // the material of the last usemtl
  KeyCounts unused_;
  std::map<std::string, std::size_t> used_;  // name -> line of its first usemtl
  std::vector<std::filesystem::path> libraries_;
};

}  // namespace

CheckedObj check_obj_text(const std::filesystem::path& file, const std::string& text,
                          const TextLookup& lookup) {
  return ObjCheck(file, text, lookup).run();
}

}  // namespace fluxel
