// Read by defects.cpp alone, from a folder whose name has its headers checked.
#pragma once

#include <string>

namespace fluxel {

int count_of(int number);

int twice(int number) { return 2 * number; }  // finds misc-definitions-in-headers

inline bool is_empty(const std::string& text) {
  return text.size() == 0;  // finds readability-container-size-empty
}

struct wrong_case {};  // finds readability-identifier-naming

}  // namespace fluxel
