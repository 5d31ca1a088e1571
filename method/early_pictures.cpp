#include "method/early_pictures.hpp"

#include <fmt/format.h>

#include <string>

#include "mpi_master/communication/agreement.hpp"
#include "mpi_master/communication/host_gather.hpp"
#include "mpi_master/communication/root_clock.hpp"
#include "solver/early_radiosity.hpp"

namespace fluxel {

namespace {

/// Of the emitted power: below it no eye sees a difference.
constexpr double kNothingLeft = 1e-3;

/// Likewise; form factors that amplify give more at each shot.
constexpr double kFarTooMuch = 10;

}  // namespace

void shoot_early_pictures(const Problem& problem, const SubdividedScene& subdivided, RadiosityOperator& F,
                          const Unknowns& unknowns) {
  const Communicator& world = problem.world;
  const RootClock clock(world);
  std::size_t next = 0;
  shoot_early_radiosity(F, unknowns, [&](std::span<const Rgb> B, double left) {
    const double elapsed = clock.seconds();
    if (!(left < kFarTooMuch)) {
      problem.log.say(fmt::format("preview: given up after {:.1f} s, the light grows", elapsed));
      return false;
    }
    if (left < kNothingLeft) {
      problem.log.say(fmt::format("preview: {:.1f} s, all light has been shot", elapsed));
      return false;
    }
    const std::size_t before = next;
    while (next < kEarlyPictures && elapsed >= static_cast<double>(std::size_t{1} << next)) ++next;
    if (next == before) return true;
    std::string file;
    const SharedArray<Rgb> all = gather_on_hosts(world, B, unknowns.two_sided ? 2 : 1);
    on_root(world, [&] { file = problem.hooks.early_picture(subdivided, all.items(), next - 1); });
    problem.log.say(fmt::format("preview: {:.1f} s, {:.3g} % of the light is left to shoot: {}", elapsed,
                                100 * left, file));
    return next < kEarlyPictures;
  });
}

}  // namespace fluxel
