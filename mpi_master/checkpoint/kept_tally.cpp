#include "mpi_master/checkpoint/kept_tally.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <span>
#include <string>

#include "mpi_master/communication/agreement.hpp"

namespace fluxel {

namespace {

std::string tally_bytes(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream)
    throw InputError(fmt::format(
        "--resume: there is no tally of photons at '{}': give the folder of the run that it is to go on "
        "(--out, or its --checkpoint), or leave --resume out",
        file.string()));
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

}  // namespace

PhotonTally restore_tally(const Communicator& communicator, const std::filesystem::path& file,
                          const TallyKey& key, const TallyShape& shape, const std::string& hint) {
  PhotonTally tally(shape);
  Bytes values;
  on_root(communicator, [&] {
    const std::string bytes = tally_bytes(file);
    TallyFileResult read = read_tally_file(std::as_bytes(std::span(bytes)), key, shape);
    if (!read.tally) throw input_error_at(file, 0, read.defect, hint);
    const auto raw = std::as_bytes(read.tally->values());
    values.assign(raw.begin(), raw.end());
  });
  communicator.broadcast(values);
  std::ranges::copy(values, std::as_writable_bytes(tally.values()).begin());
  return tally;
}

}  // namespace fluxel
