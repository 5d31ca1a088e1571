#include "scene/readers/obj_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <map>
#include <string_view>

#include "core/error.hpp"
#include "scene/input_heat.hpp"
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

template <class Integer>
void append_integer(std::string& out, Integer value) {
  char digits[24];
  const auto end = std::to_chars(std::begin(digits), std::end(digits), value).ptr;
  out.append(digits, end).push_back(' ');
}

struct Place {
  std::filesystem::path file;
  std::size_t line = 0;
};

/// One pass over an OBJ file.
class ObjCheck {
 public:
  ObjCheck(const std::filesystem::path& file, const std::string& text, const TextLookup& lookup)
      : file_(file), lookup_(lookup), at_(file, text) {}

  CheckedObj run() {
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
      } else if (keyword == "mtllib") {
        read_libraries(trim(rest));
      }
    }
    check_forward_indices();
    check_used_materials();
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

  void check_vertex(std::string_view rest) {
    checked_.geometry += "v ";
    for (int axis = 0; axis < 3; ++axis) {
      const std::string_view word = next_value(rest);
      const double value = parse_number(at_, word, "vertex coordinate");
      if (std::abs(value) > kMaxMagnitude) {
        throw at_.error(fmt::format("vertex coordinate {} is too large", in_quotes(word)),
                        fmt::format("at most {}", kMaxMagnitude));
      }
      append_number(checked_.geometry, value);
    }
    checked_.geometry.back() = '\n';
    if (++vertices_ > kMaxVertices) throw at_.error("too many vertices");
  }

  void check_face(std::string_view rest) {
    checked_.geometry += "f ";
    std::size_t corners = 0;
    for (std::string_view word = next_value(rest); !word.empty(); word = next_value(rest)) {
      if (++corners > kMaxCorners)
        throw at_.error(fmt::format("a face of more than {} corners", kMaxCorners));
      append_integer(checked_.geometry, check_corner(word));
    }
    if (corners < 3) {
      throw at_.error(fmt::format("a face needs at least 3 corners, this one has {}", corners));
    }
    checked_.geometry.back() = '\n';
  }

  /// The vertex index of `v`, `v/vt`, `v//vn` or `v/vt/vn`, counted from 1.
  std::int64_t check_corner(std::string_view word) {
    const char* const end = word.data() + word.size();
    std::int64_t index = 0;
    const char* next = word.data();
    for (int part = 0; part < 3; ++part) {
      std::int64_t value = 0;
      const auto [stop, status] = std::from_chars(next, end, value);
      const bool left_out = part == 1 && stop == next;  // v//vn
      if (status != std::errc{} && !left_out) {
        throw at_.error(fmt::format("face index {} is not a whole number", in_quotes(word)));
      }
      if (part == 0) index = value;
      next = stop;
      if (next == end || *next != '/' || part == 2) break;
      ++next;
    }
    if (next != end) throw at_.error(fmt::format("face index {} is not a whole number", in_quotes(word)));

    const auto known = static_cast<std::int64_t>(vertices_);
    if (index == 0)
      throw at_.error(fmt::format("face index {} is 0", in_quotes(word)), "vertices count from 1");
    if (index < -known) {
      throw at_.error(fmt::format("face index {} is out of range", in_quotes(word)),
                      fmt::format("{} vertices stand before this line", known));
    }
    if (index > known) forward_.push_back({index, at_.line()});
    return index < 0 ? known + 1 + index : index;
  }

  void check_forward_indices() const {
    for (const ForwardIndex& forward : forward_) {
      if (forward.index > static_cast<std::int64_t>(vertices_)) {
        throw input_error_at(file_, forward.line,
                             fmt::format("face index '{}' is out of range", forward.index),
                             fmt::format("the file has {} vertices", vertices_));
      }
    }
  }

  void use_material(std::string_view name) {
    if (name.empty()) throw at_.error("usemtl names no material");
    used_.try_emplace(std::string(name), at_.line());
    append_line("usemtl", name);
  }

  void check_used_materials() const {
    for (const auto& [name, line] : used_) {
      if (materials_.contains(name)) continue;
      std::vector<std::string> known;
      for (const auto& material : materials_) known.push_back(material.first);
      throw input_error_at(file_, line, fmt::format("usemtl of an unknown material {}", in_quotes(name)),
                           known.empty() ? "no material is defined: is a mtllib line missing?"
                                         : "known: " + list_names(known));
    }
  }

  /// File names may hold blanks, and there may be several: the whole line is tried first.
  void read_libraries(std::string_view names) {
    if (names.empty()) throw at_.error("mtllib names no file");
    const std::filesystem::path folder = file_.parent_path();
    const std::filesystem::path whole = folder / names;
    if (read_library(whole)) return;
    std::string_view rest = names;
    const bool several = next_word(rest) != names;
    for (rest = names; several && !rest.empty();) {
      const std::filesystem::path path = folder / next_word(rest);
      if (!read_library(path)) throw missing_library(path);
    }
    if (!several) throw missing_library(whole);
  }

  [[nodiscard]] InputError missing_library(const std::filesystem::path& path) const {
    return at_.error(fmt::format("cannot find the material file '{}'", path.string()));
  }

  bool read_library(const std::filesystem::path& path) {
    if (std::find(libraries_.begin(), libraries_.end(), path) != libraries_.end()) return true;
    const std::optional<std::string> text = lookup_(path);
    if (!text) return false;
    libraries_.push_back(path);
    check_materials(path, *text);
    return true;
  }

  void check_materials(const std::filesystem::path& path, const std::string& text) {
    Statements at(path, text);
    std::string current;
    std::vector<std::string> mapped;
    std::map<std::string, bool> has_Kd;
    std::map<std::string, InputHeat> heat;
    while (at.next()) {
      std::string_view rest = at.statement();
      const std::string_view keyword = next_word(rest);
      if (keyword == "newmtl") {
        current = trim(rest);
        if (current.empty()) throw at.error("newmtl names no material");
        const auto [first, added] = materials_.try_emplace(current, Place{path, at.line()});
        if (!added) {
          throw at.error(fmt::format("material {} is defined twice", in_quotes(current)),
                         fmt::format("first in {}:{}", first->second.file.string(), first->second.line));
        }
        has_Kd[current] = false;
        checked_.materials += "newmtl " + current + "\n";
      } else if (keyword == "Kd" || keyword == "Ke" || keyword == "map_Kd" || is_heat_name(keyword)) {
        if (current.empty()) throw at.error(fmt::format("{} stands before any newmtl", keyword));
        if (keyword == "map_Kd") {
          mapped.push_back(current);
        } else if (is_heat_name(keyword)) {
          check_heat(at, keyword, current, rest, heat[current]);
          has_Kd.erase(current);  // meant for heat, where reflectance follows from the emissivity
        } else {
          check_colour(at, keyword, current, rest);
          if (keyword == "Kd") has_Kd[current] = true;
        }
      }
    }
    if (!mapped.empty()) {
      checked_.notes.push_back(fmt::format("{}: map_Kd is ignored and Kd used for material {}", path.string(),
                                           list_names(mapped)));
    }
    note_missing_reflectance(path, has_Kd);
  }

  /// One number stands for all three channels.
  void check_colour(const Statements& at, std::string_view keyword, const std::string& material,
                    std::string_view rest) {
    const bool reflectance = keyword == "Kd";
    const char* const subject = reflectance ? "reflectance Kd" : "emission Ke";
    double value = parse_number(at, next_value(rest), subject);
    std::string_view word = next_value(rest);
    const bool grey = word.empty();
    checked_.materials.append(keyword).push_back(' ');
    for (int channel = 0; channel < 3; ++channel) {
      if (channel > 0 && !grey) {
        value = parse_number(at, word, subject);
        word = next_value(rest);
      }
      const double most = reflectance ? 1 : kMaxMagnitude;
      if (!(value >= 0 && value <= most)) {
        const char* const why = reflectance ? "outside 0..1" : value < 0 ? "negative" : "too large";
        throw at.error(fmt::format("{} {} of material {} is {}", subject, value, in_quotes(material), why));
      }
      append_number(checked_.materials, value);
    }
    checked_.materials.back() = '\n';
  }

  void check_heat(const Statements& at, std::string_view keyword, const std::string& material,
                  std::string_view rest, InputHeat& heat) {
    const double value = parse_number(at, next_value(rest), std::string(keyword).c_str());
    if (const std::optional<std::string> fault = set_heat(keyword, value, heat))
      throw at.error(fmt::format("{} {} of material {} is {}", keyword, value, in_quotes(material), *fault));
    checked_.materials += fmt::format("{} {}\n", keyword, value);
  }

  void note_missing_reflectance(const std::filesystem::path& path,
                                const std::map<std::string, bool>& has_Kd) {
    std::vector<std::string> without;
    for (const auto& [name, has] : has_Kd) {
      if (!has) without.push_back(name);
    }
    if (without.empty()) return;
    checked_.notes.push_back(
        fmt::format("{}: no Kd, so reflectance 0, for material {}", path.string(), list_names(without)));
  }

  const std::filesystem::path& file_;
  const TextLookup& lookup_;
  Statements at_;
  CheckedObj checked_;
  std::size_t vertices_ = 0;
  std::vector<ForwardIndex> forward_;
  std::map<std::string, std::size_t> used_;  // name -> line of its first usemtl
  std::map<std::string, Place> materials_;
  std::vector<std::filesystem::path> libraries_;
};

}  // namespace

CheckedObj check_obj_text(const std::filesystem::path& file, const std::string& text,
                          const TextLookup& lookup) {
  return ObjCheck(file, text, lookup).run();
}

}  // namespace fluxel
