#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "core/error.hpp"
#include "scene/readers/ply_header.hpp"
#include "scene/readers/words.hpp"

namespace fluxel {

/// Gives the numbers behind the header of a PLY file one by one, in any of its encodings. All that is given
/// outlives the object.
class PlyValues {
 public:
  PlyValues(const std::filesystem::path& file, const std::string& bytes, const PlyHeader& header);

  /// Begins an item: the numbers of an item of a text stand on one line. Throws InputError where the text
  /// ends, or the line before has more numbers than its item.
  void begin_item();

  /// The next number; `subject` begins a message. Throws InputError where the line or file has no more, and
  /// in a text where it is not finite, or not whole though `type` is.
  double next(PlyType type, const char* subject);

  /// An error at the last number, with line or byte.
  [[nodiscard]] InputError error(const std::string& what, const std::string& hint = {}) const;

 private:
  double next_in_text(PlyType type, const char* subject);

  const std::filesystem::path& file_;
  std::string_view bytes_;
  PlyEncoding encoding_;
  std::size_t place_;           // of the next number of a binary file
  std::size_t last_place_ = 0;  // of the last one
  Words words_;                 // of a text, one ahead
  std::size_t item_line_ = 0;
};

}  // namespace fluxel
