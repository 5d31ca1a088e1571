#include "mpi_master/checkpoint/kept_tally.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <fstream>
#include <span>
#include <string>
#include <system_error>

#include "core/input_error_at.hpp"
#include "mpi_master/communication/agreement.hpp"

namespace fluxel {

namespace {

std::string tally_bytes(const std::filesystem::path& file) {
  std::error_code failed;
  if (!std::filesystem::exists(file, failed))
    throw InputError(fmt::format(
        "--resume: there is no tally of photons at '{}': give the folder of the run that it is to go on "
        "(--out, or its --checkpoint), or leave --resume out",
        file.string()));
  const std::uintmax_t size = std::filesystem::file_size(file, failed);
  if (failed) throw input_error_at(file, 0, "cannot be read", failed.message());
  std::string bytes(size, '\0');
  std::ifstream stream(file, std::ios::binary);
  if (!stream || !stream.read(bytes.data(), static_cast<std::streamsize>(size)))
    throw input_error_at(file, 0, "cannot be read", std::generic_category().message(errno));
  return bytes;
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
