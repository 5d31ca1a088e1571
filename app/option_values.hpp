#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/choices.hpp"

namespace fluxel {

struct Options;

// Values of options from their texts; each throws CLI::ValidationError with what is wrong.

[[nodiscard]] double parse_number(const std::string& text);        ///< finite
[[nodiscard]] double parse_above_zero(const std::string& text);    ///< finite
[[nodiscard]] std::uint64_t parse_count(const std::string& text);  ///< whole, 1 to 1e18; also as 3e8
[[nodiscard]] std::uint64_t parse_bytes(
    const std::string& text);  ///< as a count, or with K, M, G: 1024, its square, cube
[[nodiscard]] glm::dvec3 parse_vector(const std::string& text);               ///< x,y,z
[[nodiscard]] std::pair<int, int> parse_resolution(const std::string& text);  ///< WxH, 1 to 65536 each
[[nodiscard]] int parse_median_radius(const std::string& text);  ///< none or median:R, R to 50; 0 for none

/// Of these names, parted by commas, each once.
[[nodiscard]] std::vector<std::string> parse_names(const std::string& text,
                                                   std::span<const std::string> known);

/// adaptive, disc, point, or points:MxN with 1 to 64 points along each edge; into rule and points.
void parse_form_factor(const std::string& text, FormFactorOptions& options);
/// A number above 0, auto, or auto:SHARE with SHARE above 0 and up to 1; into tolerance and
/// discretisation_share.
void parse_tolerance(const std::string& text, Options& options);

}  // namespace fluxel
