#include "scene/readers/mtl_check.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <string_view>
#include <utility>

#include "scene/input_heat.hpp"
#include "scene/list_names.hpp"
#include "scene/readers/statements.hpp"

namespace fluxel {
namespace {

constexpr double kMaxEmission = 1e15;  // as of coordinates: far below the parser's limits

/// One pass over a material file.
class MtlCheck {
 public:
  MtlCheck(const std::filesystem::path& file, const std::string& text, CheckedMaterials& materials)
      : file_(file), at_(file, text), materials_(materials) {}

  void run() {
    while (at_.next()) {
      std::string_view rest = at_.statement();
      const std::string_view keyword = next_word(rest);
      if (keyword == "newmtl") {
        begin_material(trim(rest));
      } else if (keyword == "Kd" || keyword == "Ke") {
        require_material(keyword);
        check_colour(keyword, rest);
        if (keyword == "Kd") own_[current_].has_Kd = true;
      } else if (keyword == "map_Kd" || keyword == "map_Ke") {
        require_material(keyword);
        (keyword == "map_Kd" ? own_[current_].Kd : own_[current_].Ke) =
            parse_texture_map(at_, keyword, rest, file_.parent_path(), unused_);
      } else if (is_heat_name(keyword)) {
        require_material(keyword);
        check_heat(keyword, rest);
      } else if ((keyword == "d" || keyword == "Tr") && !current_.empty()) {
        read_opacity(keyword, rest);
      } else {
        unused_.add(keyword);
      }
    }
    note_missing_reflectance();
    note_transparent();
    if (!unused_.empty())
      materials_.notes.push_back(
          fmt::format("{}: not used: {}; surfaces are diffuse and opaque unless a scene file says more",
                      file_.string(), unused_.list()));
    for (const auto& [name, maps] : own_)
      if (maps.Kd || maps.Ke) materials_.maps.emplace(name, maps);
  }

 private:
  void begin_material(std::string_view name) {
    current_ = name;
    if (current_.empty()) throw at_.error("newmtl names no material");
    const auto [first, added] = materials_.places.try_emplace(current_, Place{file_, at_.line()});
    if (!added) {
      throw at_.error(fmt::format("material {} is defined twice", in_quotes(current_)),
                      fmt::format("first in {}:{}", first->second.file.string(), first->second.line));
    }
    own_.try_emplace(current_);
    materials_.text += "newmtl " + current_ + "\n";
  }

  void require_material(std::string_view keyword) const {
    if (current_.empty()) throw at_.error(fmt::format("{} stands before any newmtl", keyword));
  }

  /// One number stands for all three channels.
  void check_colour(std::string_view keyword, std::string_view rest) {
    const bool reflectance = keyword == "Kd";
    const char* const subject = reflectance ? "reflectance Kd" : "emission Ke";
    double value = parse_number(at_, next_value(rest), subject);
    std::string_view word = next_value(rest);
    const bool grey = word.empty();
    materials_.text.append(keyword);
    for (int channel = 0; channel < 3; ++channel) {
      if (channel > 0 && !grey) {
        value = parse_number(at_, word, subject);
        word = next_value(rest);
      }
      const double most = reflectance ? 1 : kMaxEmission;
      if (!(value >= 0 && value <= most)) {
        const char* const why = reflectance ? "outside 0..1" : value < 0 ? "negative" : "too large";
        throw at_.error(fmt::format("{} {} of material {} is {}", subject, value, in_quotes(current_), why));
      }
      materials_.text += fmt::format(" {}", value);
    }
    materials_.text.push_back('\n');
  }

  void check_heat(std::string_view keyword, std::string_view rest) {
    const double value = parse_number(at_, next_value(rest), std::string(keyword).c_str());
    if (const std::optional<std::string> fault =
            set_heat(keyword, value, TemperatureUnit::kelvin, heat_[current_]))
      throw at_.error(fmt::format("{} {} of material {} is {}", keyword, value, in_quotes(current_), *fault));
    materials_.text += fmt::format("{} {}\n", keyword, value);
  }

  /// `d FACTOR`, `d -halo FACTOR` or `Tr FACTOR`, which is 1 - d, and of which a `d` has precedence.
  void read_opacity(std::string_view keyword, std::string_view rest) {
    std::string_view word, last;
    while (!(word = next_value(rest)).empty()) last = word;
    double value = 0;
    const auto [stop, status] = std::from_chars(last.data(), last.data() + last.size(), value);
    if (status != std::errc{} || stop != last.data() + last.size()) {
      unused_.add(keyword);
    } else if (keyword == "d") {
      opacity_[current_] = value;
    } else {
      opacity_.try_emplace(current_, 1 - value);
    }
  }

  void note_missing_reflectance() {
    std::vector<std::string> without;
    for (const auto& [name, maps] : own_)
      if (!maps.has_Kd && !maps.Kd && !heat_.contains(name)) without.push_back(name);
    if (without.empty()) return;
    materials_.notes.push_back(
        fmt::format("{}: no Kd, so reflectance 0, for material {}", file_.string(), list_names(without)));
  }

  void note_transparent() {
    std::vector<std::string> transparent;
    for (const auto& [name, opacity] : opacity_)
      if (opacity < 1) transparent.push_back(name);
    if (transparent.empty()) return;
    materials_.notes.push_back(
        fmt::format("{}: d below 1 is not used, opaque unless a scene file says more: material {}",
                    file_.string(), list_names(transparent)));
  }

  const std::filesystem::path& file_;
  Statements at_;
  CheckedMaterials& materials_;
  std::string current_;
  std::map<std::string, MaterialMaps> own_;  // of this file's materials
  std::map<std::string, InputHeat> heat_;    // which reflectance follows from
  std::map<std::string, double> opacity_;
  KeyCounts unused_;
};

}  // namespace

void check_mtl_text(const std::filesystem::path& file, const std::string& text, CheckedMaterials& materials) {
  MtlCheck(file, text, materials).run();
}

}  // namespace fluxel
