#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "core/error.hpp"

namespace fluxel {

/// Gives the statements of an OBJ or MTL text one by one: lines that end in a backslash are joined, blanks
/// around are taken off, empty lines and comments are passed over. Ends of lines are LF, CRLF or CR. `file`
/// stands in messages; `file` and `text` outlive the object. Throws InputError for binary data and for a
/// statement of more than 1 MiB.
class Statements {
 public:
  Statements(const std::filesystem::path& file, const std::string& text);

  /// Goes to the next statement; false at the end.
  bool next();

  [[nodiscard]] const std::filesystem::path& file() const { return file_; }
  [[nodiscard]] std::string_view statement() const { return statement_; }
  [[nodiscard]] std::size_t line() const { return line_; }  ///< the first line of the statement, from 1

  /// An error at the statement.
  [[nodiscard]] InputError error(const std::string& what, const std::string& hint = {}) const;

 private:
  std::string_view take_line();
  void join_lines();

  const std::filesystem::path& file_;
  std::string_view rest_;
  std::string_view statement_;
  std::string joined_;
  std::size_t line_ = 0;
  std::size_t next_line_ = 1;
};

/// Throws InputError with file and line where a text holds control characters.
void require_text(const std::filesystem::path& file, const std::string& text);

[[nodiscard]] std::string_view trim(std::string_view text);

/// Takes the next word off the front; empty at the end.
[[nodiscard]] std::string_view next_word(std::string_view& rest);

/// Takes the next word that is data; empty at the end and from the start of a comment on.
[[nodiscard]] std::string_view next_value(std::string_view& rest);

/// A word as a message shows it: short, and in quotes.
[[nodiscard]] std::string in_quotes(std::string_view word);

/// Sets `value` to the finite number that `word` is, or says what is wrong with it.
[[nodiscard]] std::optional<std::string> read_number(std::string_view word, double& value);

/// The finite number that `word` is; `subject` begins the message. Throws InputError at the statement.
[[nodiscard]] double parse_number(const Statements& at, std::string_view word, const char* subject);

/// The same, at a line of a file.
[[nodiscard]] double parse_number(const std::filesystem::path& file, std::size_t line, std::string_view word,
                                  const char* subject);

}  // namespace fluxel
