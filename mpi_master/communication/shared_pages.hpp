#pragma once

#include <cstddef>
#include <span>

#include "mpi_master/communication/communicator.hpp"

namespace fluxel {

/// Collective on the ranks of `host`, which give as many bytes each: all get the leader's. What whole pages
/// of memory there are they hold together from now on, and the memory that each had for itself is free. A
/// page that a rank writes to becomes its own again (copy on write), so that nobody sees what others write,
/// and the bytes may be given back as they were allocated. Meanwhile nobody may use them. Where there are
/// few, a rank may not open files of the leader, or the bytes of a rank lie otherwise in their pages than the
/// leader's, they are copied. Returns how many bytes are held together now.
std::size_t share_pages(const Communicator& host, std::span<std::byte> bytes);

}  // namespace fluxel
