#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace fluxel {

/// What stands before the numbers of an array in NumPy's format, version 1.0 (NEP 1): a header of text,
/// filled up with spaces to a multiple of 64 bytes. `descr`: the type as NumPy writes it, in quotes or as a
/// list; `shape`: without items a single number.
[[nodiscard]] std::string numpy_header(std::string_view descr, const std::vector<std::uint64_t>& shape);

}  // namespace fluxel
