#include "scene/readers/statements.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <system_error>

#include "core/input_error_at.hpp"

namespace fluxel {
namespace {

constexpr std::size_t kMaxStatementBytes = std::size_t{1} << 20;
constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\v' || c == '\f'; }

bool is_line_end(char c) { return c == '\n' || c == '\r'; }

}  // namespace

void require_text(const std::filesystem::path& file, const std::string& text) {
  const auto bad = std::find_if(text.begin(), text.end(), [](char c) {
    return static_cast<unsigned char>(c) < 0x20 && !is_blank(c) && !is_line_end(c);
  });
  if (bad == text.end()) return;
  throw input_error_at(file, 1 + static_cast<std::size_t>(std::count(text.begin(), bad, '\n')),
                       "this is binary data, not text",
                       fmt::format("it holds a byte of value {}", static_cast<int>(*bad)));
}

Statements::Statements(const std::filesystem::path& file, const std::string& text)
    : file_(file), rest_(text) {
  require_text(file, text);
  if (rest_.substr(0, kByteOrderMark.size()) == kByteOrderMark) rest_.remove_prefix(kByteOrderMark.size());
}

bool Statements::next() {
  while (!rest_.empty()) {
    line_ = next_line_;
    statement_ = take_line();
    if (!statement_.empty() && statement_.back() == '\\') join_lines();
    if (!statement_.empty() && statement_.front() != '#') return true;
  }
  return false;
}

InputError Statements::error(const std::string& what, const std::string& hint) const {
  return input_error_at(file_, line_, what, hint);
}

std::string_view Statements::take_line() {
  std::size_t end = 0;
  while (end < rest_.size() && !is_line_end(rest_[end])) ++end;
  const std::string_view line = rest_.substr(0, end);
  rest_.remove_prefix(end);
  rest_.remove_prefix(rest_.substr(0, 2) == "\r\n" ? 2 : std::min<std::size_t>(1, rest_.size()));
  ++next_line_;
  if (line.size() > kMaxStatementBytes) {
    throw error(fmt::format("a line of {} bytes is too long", line.size()),
                fmt::format("at most {}", kMaxStatementBytes));
  }
  return trim(line);
}

void Statements::join_lines() {
  joined_.clear();
  std::string_view part = statement_;
  while (!part.empty() && part.back() == '\\') {
    joined_.append(part.substr(0, part.size() - 1)).push_back(' ');
    if (joined_.size() > kMaxStatementBytes) {
      throw error("a statement over several lines is too long",
                  fmt::format("at most {} bytes", kMaxStatementBytes));
    }
    part = take_line();
  }
  joined_.append(part);
  statement_ = trim(joined_);
}

std::string_view trim(std::string_view text) {
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  return text;
}

std::string_view next_word(std::string_view& rest) {
  while (!rest.empty() && is_blank(rest.front())) rest.remove_prefix(1);
  std::size_t end = 0;
  while (end < rest.size() && !is_blank(rest[end])) ++end;
  const std::string_view word = rest.substr(0, end);
  rest.remove_prefix(end);
  return word;
}

std::string_view next_value(std::string_view& rest) {
  const std::string_view word = next_word(rest);
  if (word.empty() || word.front() != '#') return word;
  rest = {};
  return {};
}

std::string in_quotes(std::string_view word) {
  constexpr std::size_t kShown = 60;
  return word.size() <= kShown ? fmt::format("'{}'", word) : fmt::format("'{}...'", word.substr(0, kShown));
}

std::optional<std::string> read_number(std::string_view word, double& value) {
  const std::string_view digits = word.starts_with('+') ? word.substr(1) : word;
  const char* const end = digits.data() + digits.size();
  const auto [stop, status] = std::from_chars(digits.data(), end, value);
  if (stop != end || status == std::errc::invalid_argument) return in_quotes(word) + " is not a number";
  if (status == std::errc::result_out_of_range) {
    const bool tiny =
        digits.find("e-") != std::string_view::npos || digits.find("E-") != std::string_view::npos;
    value = 0;
    if (tiny) return std::nullopt;
  }
  if (status != std::errc{} || !std::isfinite(value)) return in_quotes(word) + " is not a finite number";
  return std::nullopt;
}

double parse_number(const Statements& at, std::string_view word, const char* subject) {
  return parse_number(at.file(), at.line(), word, subject);
}

double parse_number(const std::filesystem::path& file, std::size_t line, std::string_view word,
                    const char* subject) {
  if (word.empty()) throw input_error_at(file, line, fmt::format("{}: too few numbers", subject));
  double value = 0;
  if (const std::optional<std::string> fault = read_number(word, value))
    throw input_error_at(file, line, fmt::format("{}: {}", subject, *fault));
  return value;
}

}  // namespace fluxel
