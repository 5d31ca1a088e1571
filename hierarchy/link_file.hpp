#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <iosfwd>
#include <span>
#include <string>
#include <vector>

#include "hierarchy/link.hpp"
#include "hierarchy/refinement.hpp"

namespace fluxel {

/// What a file of a rank's links belongs to.
struct LinkFileKey {
  std::uint64_t identity = 0;  ///< rounds_identity
  std::uint64_t round = 0;     ///< counted from 1

  bool operator==(const LinkFileKey&) const = default;
};

/// Writes the links in segments, each with its own check sum, so that several ranks may share in reading
/// them; docs/file-formats.md has the format. The stream's state tells whether that has succeeded.
void write_link_file(std::ostream& stream, const LinkFileKey& key, std::span<const Link> links,
                     const RefinementCounts& counts);

/// What reading a file of links came to.
struct LinkFileResult {
  std::vector<Link> links;  ///< of the segments that were wanted
  RefinementCounts counts;
  std::string defect;  ///< what is wrong with the file, as the end of a sentence; empty: nothing
};

/// Reads a file of links between `nodes` nodes, from wherever it comes: the segments whose numbers are
/// wanted. Throws nothing but what memory does.
[[nodiscard]] LinkFileResult read_link_file(std::istream& stream, const LinkFileKey& key, std::size_t nodes,
                                            const std::function<bool(std::uint64_t)>& wanted);

}  // namespace fluxel
