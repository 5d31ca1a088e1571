#include "scene/readers/radiance_primitives.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <limits>

#include "scene/readers/format_limits.hpp"
#include "scene/readers/statements.hpp"

namespace fluxel {
namespace {

constexpr std::size_t kAnyNumber = std::numeric_limits<std::size_t>::max();

constexpr std::array kRadianceTypes{
    RadianceType{"polygon", RadianceRole::polygon, 9, 3 * kMaxFaceCorners},
    RadianceType{"sphere", RadianceRole::sphere, 4, 4},
    RadianceType{"bubble", RadianceRole::bubble, 4, 4},
    RadianceType{"cone", RadianceRole::cone, 8, 8},
    RadianceType{"cup", RadianceRole::cup, 8, 8},
    RadianceType{"cylinder", RadianceRole::cylinder, 7, 7},
    RadianceType{"tube", RadianceRole::tube, 7, 7},
    RadianceType{"ring", RadianceRole::ring, 8, 8},
    RadianceType{"source", RadianceRole::elsewhere, 0, kAnyNumber},
    RadianceType{"instance", RadianceRole::elsewhere, 0, kAnyNumber},
    RadianceType{"mesh", RadianceRole::elsewhere, 0, kAnyNumber},
    RadianceType{"alias", RadianceRole::alias, 0, 0},
    RadianceType{"plastic", RadianceRole::plastic, 5, 5},
    RadianceType{"plastic2", RadianceRole::plastic, 6, 6},
    RadianceType{"plasfunc", RadianceRole::plastic, 4, kAnyNumber},
    RadianceType{"plasdata", RadianceRole::plastic, 4, kAnyNumber},
    RadianceType{"metal", RadianceRole::metal, 5, 5},
    RadianceType{"metal2", RadianceRole::metal, 6, 6},
    RadianceType{"metfunc", RadianceRole::metal, 4, kAnyNumber},
    RadianceType{"metdata", RadianceRole::metal, 4, kAnyNumber},
    RadianceType{"trans", RadianceRole::trans, 7, 7, 5},
    RadianceType{"trans2", RadianceRole::trans, 8, 8, 6},
    RadianceType{"transfunc", RadianceRole::trans, 6, kAnyNumber, 4},
    RadianceType{"transdata", RadianceRole::trans, 6, kAnyNumber, 4},
    RadianceType{"ashik2", RadianceRole::ashik, 8, 8},
    RadianceType{"BRTDfunc", RadianceRole::brtd, 9, kAnyNumber},
    RadianceType{"mirror", RadianceRole::mirror, 3, 3},
    RadianceType{"light", RadianceRole::light, 3, 3},
    RadianceType{"illum", RadianceRole::illum, 3, 3},
    RadianceType{"glow", RadianceRole::glow, 4, 4},
    RadianceType{"spotlight", RadianceRole::spotlight, 7, 7},
    RadianceType{"glass", RadianceRole::transparent, 3, 4},
    RadianceType{"dielectric", RadianceRole::transparent, 5, 5},
    RadianceType{"interface", RadianceRole::transparent, 8, 8},
    RadianceType{"mist", RadianceRole::transparent, 0, 7},
    RadianceType{"antimatter", RadianceRole::transparent, 0, 0},
    RadianceType{"prism1", RadianceRole::transparent, 0, kAnyNumber},
    RadianceType{"prism2", RadianceRole::transparent, 0, kAnyNumber},
    RadianceType{"BSDF", RadianceRole::transparent, 0, kAnyNumber},
    RadianceType{"aBSDF", RadianceRole::transparent, 0, kAnyNumber},
    RadianceType{"WGMDfunc", RadianceRole::transparent, 0, kAnyNumber},
    RadianceType{"colorfunc", RadianceRole::pattern, 0, kAnyNumber},
    RadianceType{"brightfunc", RadianceRole::pattern, 0, kAnyNumber},
    RadianceType{"colordata", RadianceRole::pattern, 0, kAnyNumber},
    RadianceType{"brightdata", RadianceRole::pattern, 0, kAnyNumber},
    RadianceType{"colorpict", RadianceRole::pattern, 0, kAnyNumber},
    RadianceType{"colortext", RadianceRole::pattern, 0, kAnyNumber},
    RadianceType{"brighttext", RadianceRole::pattern, 0, kAnyNumber},
    RadianceType{"spectrum", RadianceRole::pattern, 0, kAnyNumber},
    RadianceType{"specfile", RadianceRole::pattern, 0, kAnyNumber},
    RadianceType{"specfunc", RadianceRole::pattern, 0, kAnyNumber},
    RadianceType{"specdata", RadianceRole::pattern, 0, kAnyNumber},
    RadianceType{"specpict", RadianceRole::pattern, 0, kAnyNumber},
    RadianceType{"texfunc", RadianceRole::pattern, 0, kAnyNumber},
    RadianceType{"texdata", RadianceRole::pattern, 0, kAnyNumber},
    RadianceType{"mixfunc", RadianceRole::mixture, 0, kAnyNumber},
    RadianceType{"mixdata", RadianceRole::mixture, 0, kAnyNumber},
    RadianceType{"mixpict", RadianceRole::mixture, 0, kAnyNumber},
    RadianceType{"mixtext", RadianceRole::mixture, 0, kAnyNumber},
};

}  // namespace

RadiancePrimitives::RadiancePrimitives(const std::filesystem::path& file, const std::string& text)
    : words_(file, text) {
  require_text(file, text);
}

bool RadiancePrimitives::next(RadiancePrimitive& primitive) {
  if (!find_start()) return false;
  primitive.line = words_.line();
  primitive.modifier = words_.word();
  const std::string type = next_string("the type of a primitive");
  const auto found = std::ranges::find(kRadianceTypes, type, &RadianceType::name);
  if (found == kRadianceTypes.end()) {
    throw words_.error(fmt::format("{} is no type of primitive", in_quotes(type)),
                       "`modifier type identifier`; does the one before have more arguments than it counts?");
  }
  primitive.type = &*found;
  primitive.identifier = next_string("the identifier of a primitive");
  read_arguments(primitive);
  return true;
}

/// Passes over comments and commands.
bool RadiancePrimitives::find_start() {
  while (ahead_ || words_.next()) {
    ahead_ = false;
    if (words_.word().front() == '#') {
      words_.rest_of_line();
    } else if (words_.word().front() == '!') {
      skip_command();
    } else {
      return true;
    }
  }
  return false;
}

/// A command goes on behind a line that ends in a backslash.
void RadiancePrimitives::skip_command() {
  std::size_t line = words_.line();
  std::string_view end = words_.word();
  const std::string_view arguments = words_.rest_of_line();
  const std::string blank = arguments.empty() ? "" : " ";
  commands_.push_back(
      fmt::format("line {} {}", line, in_quotes(std::string(end).append(blank).append(arguments))));
  if (!arguments.empty()) end = arguments;
  while (end.back() == '\\' && words_.next()) {
    ahead_ = words_.line() != line + 1;
    if (ahead_) return;
    line = words_.line();
    end = words_.word();
    if (const std::string_view rest = words_.rest_of_line(); !rest.empty()) end = rest;
  }
}

void RadiancePrimitives::read_arguments(RadiancePrimitive& primitive) {
  primitive.strings.clear();
  primitive.reals.clear();
  if (primitive.type->role == RadianceRole::alias) {
    primitive.strings.push_back(next_string("what an alias stands for"));
    return;
  }
  for (std::size_t left = next_count("string"); left > 0; --left)
    primitive.strings.push_back(next_string("string argument"));
  for (std::size_t left = next_count("integer"); left > 0; --left) {
    next_number();
    static_cast<void>(words_.number("integer argument"));
  }
  const std::size_t reals = next_count("real");
  check_reals(primitive, reals);
  for (std::size_t left = reals; left > 0; --left) {
    next_number();
    primitive.reals.push_back(words_.number("real argument"));
  }
}

/// The next word, or words in quotes.
std::string RadiancePrimitives::next_string(const char* what) {
  if (!words_.next()) throw words_.error(fmt::format("the file ends before {}", what));
  std::string text(words_.word());
  const char quote = text.front();
  if (quote != '"' && quote != '\'') return text;
  while (text.size() == 1 || text.back() != quote) {
    if (!words_.next()) throw words_.error(fmt::format("the file ends within {} in quotes", what));
    text.append(" ").append(words_.word());
  }
  return text.substr(1, text.size() - 2);
}

/// Goes to the next word that is no comment: among numbers there may be some.
void RadiancePrimitives::next_number() {
  while (words_.next() && words_.word().front() == '#') words_.rest_of_line();
  if (words_.word().empty()) throw words_.error("the file ends within the arguments of a primitive");
}

std::size_t RadiancePrimitives::next_count(const char* what) {
  next_number();
  const std::string_view word = words_.word();
  std::size_t count = 0;
  const auto [stop, status] = std::from_chars(word.data(), word.data() + word.size(), count);
  if (status != std::errc{} || stop != word.data() + word.size())
    throw words_.error(fmt::format("{} is no number of {} arguments", in_quotes(word), what));
  return count;
}

void RadiancePrimitives::check_reals(const RadiancePrimitive& primitive, std::size_t count) const {
  const RadianceType& type = *primitive.type;
  const bool triples = type.role == RadianceRole::polygon;
  if (count >= type.least_reals && count <= type.most_reals && !(triples && count % 3 != 0)) return;
  const std::string wanted = triples ? fmt::format("3 for each of 3 to {} corners", kMaxFaceCorners)
                             : type.least_reals == type.most_reals ? fmt::format("{}", type.least_reals)
                             : type.most_reals == kAnyNumber
                                 ? fmt::format("{} at least", type.least_reals)
                                 : fmt::format("{} to {}", type.least_reals, type.most_reals);
  throw words_.error(
      fmt::format("{} {} has {} real arguments", type.name, in_quotes(primitive.identifier), count),
      "it needs " + wanted);
}

}  // namespace fluxel
