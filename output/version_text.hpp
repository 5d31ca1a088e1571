#pragma once

#include <fmt/format.h>

#include <string>

#include "core/version.hpp"
#include "mpi_master/communication/communicator.hpp"
#include "visibility/ray_scene.hpp"

namespace fluxel {

/// Program, build, and the libraries that results depend on.
inline std::string version_text() {
  return fmt::format("fluxel {} ({})\n{}\n{}", version(), build_info(), mpi_version(), ray_engine_version());
}

}  // namespace fluxel
