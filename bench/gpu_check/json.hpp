#pragma once

#include <cmath>
#include <cstdio>
#include <initializer_list>
#include <string>
#include <utility>
#include <vector>

namespace fluxel::cuda::checks::json {

// Values as text: a machine that has a GPU may have no library for it.

/// Of a plain text, without control characters.
inline std::string text(const std::string& value) {
  std::string quoted = "\"";
  for (const char c : value) {
    if (c == '"' || c == '\\') quoted += '\\';
    quoted += c;
  }
  return quoted + "\"";
}

inline std::string number(double value) {
  if (!std::isfinite(value)) return "null";
  char digits[32];
  std::snprintf(digits, sizeof digits, "%.12g", value);
  return digits;
}

inline std::string list(const std::vector<std::string>& values) {
  std::string all;
  for (const std::string& value : values) all += (all.empty() ? "" : ",\n") + value;
  return "[" + all + "]";
}

inline std::string object(std::initializer_list<std::pair<const char*, std::string>> members) {
  std::string all;
  for (const auto& [name, value] : members) all += (all.empty() ? "" : ", ") + text(name) + ": " + value;
  return "{" + all + "}";
}

}  // namespace fluxel::cuda::checks::json
