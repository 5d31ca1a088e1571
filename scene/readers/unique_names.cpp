#include "scene/readers/unique_names.hpp"

namespace fluxel {

std::string UniqueNames::add(const std::string& name) {
  std::string unique = name;
  while (!given_.try_emplace(unique, 1).second) unique = name + " " + std::to_string(++given_[name]);
  return unique;
}

}  // namespace fluxel
