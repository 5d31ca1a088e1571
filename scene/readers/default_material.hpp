#pragma once

namespace fluxel {

/// The name of the material of faces whose file gives them none; `material` of [[geometry]] gives another.
inline constexpr const char* kDefaultMaterial = "default";

}  // namespace fluxel
