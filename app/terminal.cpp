#include "app/terminal.hpp"

#include <fmt/color.h>
#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>

namespace fluxel {
namespace {

bool is_set(const char* name) {
  const char* const value = std::getenv(name);
  return value != nullptr && *value != '\0';
}

/// https://no-color.org
bool errors_are_coloured() {
  const char* const terminal = std::getenv("TERM");
  return isatty(STDERR_FILENO) != 0 && !is_set("NO_COLOR") && is_set("TERM") &&
         std::string_view(terminal) != "dumb";
}

/// Where the last column of a line begins: behind the last gap of two blanks or more.
std::size_t last_column(std::string_view line) {
  const std::size_t gap = line.rfind("  ");
  const std::size_t start = gap == std::string_view::npos ? 0 : line.find_first_not_of(' ', gap);
  return start == std::string_view::npos ? 0 : start;
}

}  // namespace

void print_message(MessageKind kind, std::string_view label, std::string_view text) {
  std::string shown = fmt::format("{}:", label);
  if (errors_are_coloured()) {
    const auto colour = kind == MessageKind::error ? fmt::terminal_color::red : fmt::terminal_color::yellow;
    shown = fmt::format(fmt::emphasis::bold | fmt::fg(colour), "{}", shown);
  }
  fmt::print(stderr, "{} {}\n", shown, text);  // at once: other ranks print, too
}

std::size_t text_columns() {
  constexpr std::size_t kLeast = 60, kMost = 120, kElsewhere = 100;
  winsize size{};
  if (isatty(STDOUT_FILENO) == 0 || ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) != 0 || size.ws_col == 0)
    return kElsewhere;
  return std::clamp<std::size_t>(size.ws_col, kLeast, kMost);
}

std::string wrapped(std::string_view text, std::size_t columns) {
  constexpr std::size_t kNarrow = 6;
  std::string out;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    std::size_t indent = last_column(line);
    std::size_t before = 0;  // blanks in front of what is left
    if (line.size() > columns &&
        indent > columns / 2) {  // too narrow a column: its text has lines of its own
      out.append(line.substr(0, line.find_last_not_of(' ', indent - 1) + 1)) += '\n';
      line.remove_prefix(indent);
      before = indent = kNarrow;
    }
    while (before + line.size() > columns) {
      const std::size_t room = columns - before;
      const std::size_t blank = line.rfind(' ', room);
      // Not within the columns on the left, nor in a word that no line has room for.
      if (blank == std::string_view::npos || (before == 0 && blank < indent)) break;
      out.append(before, ' ').append(line.substr(0, blank)) += '\n';
      line.remove_prefix(blank + 1);
      before = indent;
    }
    out.append(before, ' ').append(line) += '\n';
  }
  return out;
}

}  // namespace fluxel
