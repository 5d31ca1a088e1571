#pragma once

#include <fmt/format.h>

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "scene/list_names.hpp"

namespace fluxel {

/// Keywords of a file that are not used, and how often each stands there.
class KeyCounts {
 public:
  void add(std::string_view key) { ++counts_[std::string(key.substr(0, kShown))]; }
  [[nodiscard]] bool empty() const { return counts_.empty(); }

  /// As `Ks (12), Ns (12)`.
  [[nodiscard]] std::string list() const {
    std::vector<std::string> names;
    for (const auto& [key, count] : counts_) names.push_back(fmt::format("{} ({})", key, count));
    return list_names(names);
  }

 private:
  static constexpr std::size_t kShown = 40;  // of what is no keyword but a line of something else

  std::map<std::string, std::size_t> counts_;
};

}  // namespace fluxel
