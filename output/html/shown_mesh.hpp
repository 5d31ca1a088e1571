#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "core/element.hpp"
#include "core/rgb.hpp"

namespace fluxel {

/// What a mesh has at each of its elements, by the names that assets/mesh.js knows: radiosity, irradiance
/// (three components), temperature, error (one), each with `_back` for the backs. What is not a number is not
/// there.
struct MeshLayer {
  std::string name;
  std::size_t components = 1;
  std::vector<float> values;
};

struct MeshToShow {
  std::vector<Outline<glm::vec3>> outlines;  ///< [m], an entry an element, as all below
  std::vector<std::uint32_t> patch;          ///< of each element; elements of different ones are never joined
  std::vector<std::uint32_t> group, material;  ///< of each element, or empty
  std::vector<std::string> groups, materials;  ///< names
  std::vector<Rgb> reflectance;                ///< of the materials
  std::vector<MeshLayer> layers;
  glm::dvec3 up{0, 1, 0};
  std::string error_is = "error";  ///< what the layer `error` is
  std::string error_unit;
  bool is_signed = false;  ///< that layer
};

/// Three components an element, an entry of `values` each.
[[nodiscard]] MeshLayer layer_of(std::string name, std::span<const Rgb> values);

/// For a page: corners of 16 bits and values of 14 bits, deflated. Of more elements than `most`, those
/// of a patch are joined within squares of a size that leaves no more, with the means of their values; what
/// is shown then are the convex hulls of what was joined, the largest where patches alone are too many.
[[nodiscard]] nlohmann::ordered_json shown_mesh(const MeshToShow& mesh, std::size_t most = 100'000);

}  // namespace fluxel
