#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "core/error.hpp"

namespace fluxel {

/// Gives the words of a text one by one, of formats where ends of lines (LF, CRLF or CR) are blanks like
/// others. A byte order mark is passed over. `file` stands in messages; `file` and the text outlive the
/// object.
class Words {
 public:
  Words(const std::filesystem::path& file, std::string_view text, std::size_t first_line = 1);

  /// Goes to the next word; false at the end, where word() is empty.
  bool next();

  [[nodiscard]] std::string_view word() const { return word_; }
  [[nodiscard]] std::size_t line() const { return line_; }  ///< of the word; at the end, of the last one

  /// Takes what stands behind the word on its line, without the blanks around it.
  std::string_view rest_of_line();

  /// An error at the word.
  [[nodiscard]] InputError error(const std::string& what, const std::string& hint = {}) const;

  /// The finite number that the word is; `subject` begins the message. Throws InputError at the word.
  [[nodiscard]] double number(const char* subject) const;

 private:
  const std::filesystem::path& file_;
  std::string_view rest_;
  std::string_view word_;
  std::size_t line_;
  std::size_t next_line_;
};

}  // namespace fluxel
