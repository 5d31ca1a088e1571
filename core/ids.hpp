#pragma once

#include <cstddef>
#include <cstdint>

namespace fluxel {

/// Indices are distinct types, so that a patch number cannot be passed for an element number.
enum class PatchId : std::uint32_t {};
enum class ElementId : std::uint32_t {};
enum class MaterialId : std::uint32_t {};
enum class GroupId : std::uint32_t {};

/// What a pixel or a list holds where there is nothing.
inline constexpr PatchId kNoPatch{0xFFFFFFFFu};
inline constexpr ElementId kNoElement{0xFFFFFFFFu};

constexpr std::size_t index(PatchId id) { return static_cast<std::size_t>(id); }
constexpr std::size_t index(ElementId id) { return static_cast<std::size_t>(id); }
constexpr std::size_t index(MaterialId id) { return static_cast<std::size_t>(id); }
constexpr std::size_t index(GroupId id) { return static_cast<std::size_t>(id); }

}  // namespace fluxel
