#pragma once

#include <string>

namespace fluxel {

[[nodiscard]] std::string version();     ///< as 0.2.0
[[nodiscard]] std::string build_info();  ///< commit, build type, compiler

}  // namespace fluxel
