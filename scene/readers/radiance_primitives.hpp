#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.hpp"
#include "scene/readers/words.hpp"

namespace fluxel {

/// What a type of Radiance primitive is to this program. Surfaces come first.
enum class RadianceRole {
  polygon,
  sphere,
  bubble,
  cone,
  cup,
  cylinder,
  tube,
  ring,
  elsewhere,  ///< a surface that is not in the scene itself: `source`, `instance`, `mesh`
  alias,
  pattern,  ///< or a texture
  mixture,
  plastic,
  metal,
  trans,
  ashik,
  brtd,
  mirror,
  light,
  illum,
  glow,
  spotlight,
  transparent,  ///< a material that is no reflecting surface
};

struct RadianceType {
  std::string_view name;
  RadianceRole role;
  std::size_t least_reals, most_reals;
  std::size_t transmissivity = 0;  ///< of `trans`: which real
};

/// `modifier type identifier`, and its arguments; of an alias the one string that it stands for.
struct RadiancePrimitive {
  std::string modifier;
  const RadianceType* type = nullptr;
  std::string identifier;
  std::vector<std::string> strings;
  std::vector<double> reals;
  std::size_t line = 0;
};

/// Gives the primitives of a Radiance scene description one by one (Ward, The RADIANCE 5.1 Synthetic Imaging
/// System, section 2). `file` and `text` outlive the object. Throws InputError with file and line for what is
/// no text, unknown types, numbers of arguments that do not fit the type, and arguments that are no numbers.
class RadiancePrimitives {
 public:
  RadiancePrimitives(const std::filesystem::path& file, const std::string& text);

  /// Reads the next primitive; false at the end.
  bool next(RadiancePrimitive& primitive);

  /// The commands so far, which are not run: `line 3 '!genbox ...'`.
  [[nodiscard]] const std::vector<std::string>& commands() const { return commands_; }

 private:
  bool find_start();
  void skip_command();
  void read_arguments(RadiancePrimitive& primitive);
  [[nodiscard]] std::string next_string(const char* what);
  void next_number();
  [[nodiscard]] std::size_t next_count(const char* what);
  void check_reals(const RadiancePrimitive& primitive, std::size_t count) const;

  Words words_;
  bool ahead_ = false;  // words_ stands at a word that is still to be looked at
  std::vector<std::string> commands_;
};

}  // namespace fluxel
