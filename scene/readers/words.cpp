#include "scene/readers/words.hpp"

#include "core/input_error_at.hpp"
#include "scene/readers/statements.hpp"

namespace fluxel {
namespace {

constexpr std::string_view kEndsOfLines = "\n\r";
constexpr std::string_view kMark = "\xEF\xBB\xBF";

/// A space, or \t, \n, \v, \f or \r.
bool is_white(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }

}  // namespace

Words::Words(const std::filesystem::path& file, std::string_view text, std::size_t first_line)
    : file_(file), rest_(text), line_(first_line), next_line_(first_line) {
  if (rest_.starts_with(kMark)) rest_.remove_prefix(kMark.size());
}

bool Words::next() {
  std::size_t start = 0;
  for (; start < rest_.size() && is_white(rest_[start]); ++start) {
    const bool half_of_pair = rest_.substr(start, 2) == "\r\n";
    if ((rest_[start] == '\n' || rest_[start] == '\r') && !half_of_pair) ++next_line_;
  }
  std::size_t end = start;
  while (end < rest_.size() && !is_white(rest_[end])) ++end;
  word_ = rest_.substr(start, end - start);
  rest_.remove_prefix(end);
  if (word_.empty()) return false;
  line_ = next_line_;
  return true;
}

std::string_view Words::rest_of_line() {
  const std::string_view rest = rest_.substr(0, rest_.find_first_of(kEndsOfLines));
  rest_.remove_prefix(rest.size());
  return trim(rest);
}

InputError Words::error(const std::string& what, const std::string& hint) const {
  return input_error_at(file_, line_, what, hint);
}

double Words::number(const char* subject) const { return parse_number(file_, line_, word_, subject); }

}  // namespace fluxel
