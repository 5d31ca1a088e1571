#include "scene/readers/words.hpp"

#include <algorithm>

#include "scene/readers/statements.hpp"

namespace fluxel {
namespace {

constexpr std::string_view kLineEnds = "\n\r";
constexpr std::string_view kBlanks = " \t\v\f\n\r";

}  // namespace

bool Words::next() {
  const std::size_t start = std::min(rest_.find_first_not_of(kBlanks), rest_.size());
  for (std::size_t i = 0; i < start; ++i) {
    const bool half_of_pair = rest_[i] == '\r' && i + 1 < rest_.size() && rest_[i + 1] == '\n';
    if ((rest_[i] == '\n' || rest_[i] == '\r') && !half_of_pair) ++next_line_;
  }
  rest_.remove_prefix(start);
  word_ = rest_.substr(0, rest_.find_first_of(kBlanks));
  rest_.remove_prefix(word_.size());
  if (word_.empty()) return false;
  line_ = next_line_;
  return true;
}

std::string_view Words::rest_of_line() {
  const std::string_view rest = rest_.substr(0, rest_.find_first_of(kLineEnds));
  rest_.remove_prefix(rest.size());
  return trim(rest);
}

InputError Words::error(const std::string& what, const std::string& hint) const {
  return input_error_at(file_, line_, what, hint);
}

double Words::number(const char* subject) const { return parse_number(file_, line_, word_, subject); }

}  // namespace fluxel
