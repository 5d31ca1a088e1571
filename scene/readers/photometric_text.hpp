#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "core/input_error_at.hpp"

namespace fluxel {

/// What a comma among numbers is.
enum class Comma { separator, decimal_point };

/// Goes through the text of a photometric file: line by line where lines have a meaning, and number by number
/// where they have none. Ends of lines are LF, CRLF or CR. `file` stands in messages; `file` and `text`
/// outlive the object. All but `next_line` throw InputError with file and line, also where the text ends too
/// early.
class PhotometricText {
 public:
  PhotometricText(const std::filesystem::path& file, std::string_view text, Comma comma)
      : file_(file), rest_(text), comma_(comma) {}

  /// Goes to the next line; false at the end.
  bool next_line();

  /// The rest of the line, without blanks around.
  [[nodiscard]] std::string_view line() const;

  /// Goes to the next line, which there has to be; `subject` names it in messages.
  void require_line(const char* subject);

  /// Leaves what remains of the line.
  void skip_line() { line_ = {}; }

  /// The next number, in this line or a later one.
  double number(const char* subject);

  /// The next number as a length [m], of either sign.
  double length(double metres_per_unit, const char* subject);

  /// The next number, which is whole and from `least` to a thousand millions.
  std::size_t count(const char* subject, std::size_t least);

  /// The next `count` numbers, which ascend from 0 or more to `most` or less.
  std::vector<double> angles(std::size_t count, double most, const char* subject);

  /// The next `count` numbers times `scale`, none of which may be negative or too large.
  std::vector<double> intensities(std::size_t count, double scale);

  /// What follows the last number: whether there is anything. Throws where that is a number.
  bool has_trailing_text();

  /// An error at the line.
  [[nodiscard]] InputError error(const std::string& what, const std::string& hint = {}) const {
    return input_error_at(file_, line_number_, what, hint);
  }

 private:
  std::string_view next_word();
  [[nodiscard]] double parse(std::string_view word, const char* subject) const;
  [[nodiscard]] InputError ends_before(const std::string& what) const;

  const std::filesystem::path& file_;
  std::string_view rest_;  ///< after the line
  std::string_view line_;  ///< what is left of the line
  std::size_t line_number_ = 0;
  Comma comma_;
};

}  // namespace fluxel
