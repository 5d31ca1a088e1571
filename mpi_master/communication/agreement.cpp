#include "mpi_master/communication/agreement.hpp"

#include <optional>

#include "core/signals.hpp"

namespace fluxel {

void agree(const Communicator& communicator, const std::function<void()>& work) {
  std::optional<std::string> failure;
  try {
    work();
  } catch (const InputError& error) {
    failure = error.what();
  }
  auto first = static_cast<std::uint64_t>(failure ? communicator.rank() : communicator.size());
  communicator.all_min(std::span(&first, 1));
  if (first == static_cast<std::uint64_t>(communicator.size())) return;
  Bytes text;
  if (failure) {
    const auto bytes = std::as_bytes(std::span(*failure));
    text.assign(bytes.begin(), bytes.end());
  }
  communicator.broadcast(text, static_cast<int>(first));
  throw AgreedError(std::string(reinterpret_cast<const char*>(text.data()), text.size()));
}

void on_root(const Communicator& communicator, const std::function<void()>& work) {
  agree(communicator, [&] {
    if (communicator.is_root()) work();
  });
}

bool anybody_stops(const Communicator& communicator) {
  std::uint64_t asked = stop_requested() || end_requested() ? 1 : 0;
  communicator.all_sum(std::span(&asked, 1));
  return asked > 0;
}

}  // namespace fluxel
