#pragma once

#include <cstddef>
#include <map>
#include <string>

namespace fluxel {

/// Makes names that differ: a name that was given before gets a number behind it.
class UniqueNames {
 public:
  [[nodiscard]] std::string add(const std::string& name);

 private:
  std::map<std::string, std::size_t> given_;  // how often
};

}  // namespace fluxel
