#include "app/end_of_run.hpp"

#include <fmt/format.h>

#include <new>
#include <string>

#include "app/terminal.hpp"
#include "core/error.hpp"
#include "mpi_master/communication/agreement.hpp"

namespace fluxel {

namespace {

/// This rank failed and the others do not know: it says why, and all end.
[[noreturn]] void end_all(const Communicator& world, const std::string& reason, int code) {
  print_message(MessageKind::error, "fluxel", fmt::format("rank {}: {}", world.rank(), reason));
  world.abort(code);
}

}  // namespace

int guarded(const Communicator& world, const std::function<int()>& work) {
  try {
    return work();
  } catch (const AgreedError& error) {
    if (world.is_root()) print_message(MessageKind::error, "fluxel", error.what());
    return 2;
  } catch (const StopRequest& stop) {
    if (world.is_root()) print_message(MessageKind::warning, "fluxel", stop.what());
    return kStopped;
  } catch (const InputError& error) {
    end_all(world, error.what(), 2);
  } catch (const std::bad_alloc&) {
    end_all(world,
            "out of memory (use more hosts or a smaller --resolution; with --method matrix larger elements)",
            2);
  } catch (const std::exception& error) {
    end_all(world, error.what(), 1);
  }
}

}  // namespace fluxel
