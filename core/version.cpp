#include "core/version.hpp"

namespace fluxel {

std::string version() { return FLUXEL_VERSION; }

std::string build_info() { return FLUXEL_COMMIT ", " FLUXEL_BUILD_TYPE ", compiler " __VERSION__; }

}  // namespace fluxel
