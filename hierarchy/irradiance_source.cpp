#include "hierarchy/irradiance_source.hpp"

#include "core/signals.hpp"

namespace fluxel {

bool IrradianceSource::is_stopped() const { return signal_handler_ && stop_requested(); }

void IrradianceSource::handle_signals() const {
  if (signal_handler_) signal_handler_();
}

}  // namespace fluxel
