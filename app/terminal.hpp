#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace fluxel {

enum class MessageKind { warning, error };

/// Prints `label: text` and a line's end to standard error, the label in yellow (warnings) or red (errors)
/// where a terminal shows it that knows colours, unless the environment has a NO_COLOR that is not empty.
void print_message(MessageKind kind, std::string_view label, std::string_view text);

/// The columns that a text on standard output may take: those of the terminal, at least 60 and at most 120;
/// 100 where it is none.
[[nodiscard]] std::size_t text_columns();

/// The text with lines of at most so many columns where blanks allow it. What does not fit goes on below the
/// last column of the line (parts two or more blanks apart are columns).
[[nodiscard]] std::string wrapped(std::string_view text, std::size_t columns);

}  // namespace fluxel
