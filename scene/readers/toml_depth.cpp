#include "scene/readers/toml_depth.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>

#include "core/input_error_at.hpp"

namespace fluxel {
namespace {

constexpr int kMaxDots = 32;      // of a key; the deepest of a scene file has two
constexpr int kMaxBrackets = 32;  // open at once

/// One pass over the text.
class DepthCheck {
 public:
  DepthCheck(const std::filesystem::path& file, std::string_view text) : file_(file), rest_(text) {}

  void run() {
    while (!rest_.empty()) {
      const char c = rest_.front();
      if (c == '"' || c == '\'') {
        skip_text(c);
      } else if (c == '#') {
        skip(std::min(rest_.find('\n'), rest_.size()));
      } else {
        count(c);
        skip(1);
      }
    }
  }

 private:
  /// Passes over so many bytes, and counts their lines.
  void skip(std::size_t bytes) {
    line_ += static_cast<std::size_t>(std::ranges::count(rest_.substr(0, bytes), '\n'));
    rest_.remove_prefix(bytes);
  }

  void count(char c) {
    switch (c) {
      case '.':
        if (++dots_ > kMaxDots) throw too_deep("a key has", kMaxDots, "dots");
        break;
      case '[':
      case '{':
        dots_ = 0;
        if (++brackets_ > kMaxBrackets) throw too_deep("there are", kMaxBrackets, "brackets open at once");
        break;
      case ']':
      case '}':
        dots_ = 0;
        brackets_ = std::max(0, brackets_ - 1);
        break;
      case '\n':
      case ',':
      case '=':
        dots_ = 0;
        break;
      default:
        break;
    }
  }

  /// A text ends with the quotes that it begins with, one or three; one of single quotes ends with its line
  /// at the latest, which is an error of the parser's.
  void skip_text(char quote) {
    const std::string_view three = quote == '"' ? R"(""")" : "'''";
    const bool several_lines = rest_.starts_with(three);
    const std::string_view end = three.substr(0, several_lines ? 3 : 1);
    std::size_t at = end.size();
    for (; at < rest_.size() && !rest_.substr(at).starts_with(end); ++at) {
      if (!several_lines && rest_[at] == '\n') return skip(at);
      if (quote == '"' && rest_[at] == '\\') ++at;
    }
    at += end.size();
    // Up to two quotes more are the last characters of the text.
    for (int k = 0; several_lines && k < 2 && at < rest_.size() && rest_[at] == quote; ++k) ++at;
    skip(std::min(at, rest_.size()));
  }

  [[nodiscard]] InputError too_deep(const char* subject, int most, const char* of) const {
    return input_error_at(file_, line_, fmt::format("{} more than {} {}", subject, most, of),
                          "the keys of a scene file have two dots at most, its arrays no arrays within");
  }

  const std::filesystem::path& file_;
  std::string_view rest_;
  std::size_t line_ = 1;
  int dots_ = 0, brackets_ = 0;
};

}  // namespace

void require_shallow_toml(const std::filesystem::path& file, std::string_view text) {
  DepthCheck(file, text).run();
}

}  // namespace fluxel
