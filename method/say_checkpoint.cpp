#include "method/say_checkpoint.hpp"

#include <fmt/format.h>

#include "core/options.hpp"

namespace fluxel {

void say_checkpoint(const Problem& problem, const Solution& solution) {
  if (!solution.checkpoint) return;
  problem.log.say(fmt::format("checkpoint: {} files, {:.3g} GiB in {}, written in {:.2f} s",
                              solution.checkpoint->files,
                              static_cast<double>(solution.checkpoint->bytes) * 0x1p-30,
                              problem.options.checkpoint, solution.checkpoint->seconds));
}

}  // namespace fluxel
