#include "app/preview.hpp"

#include <chrono>

#include "app/outputs.hpp"
#include "mpi_master/agreement.hpp"
#include "solver/early_radiosity.hpp"

namespace fluxel {

namespace {

/// Of the emitted power: below it no eye sees a difference.
constexpr double kNothingLeft = 1e-3;

/// Likewise; form factors that amplify give more at each shot.
constexpr double kFarTooMuch = 10;

}  // namespace

void write_previews(const Communicator& leaders, const Scene& scene, const SubdividedScene& subdivided,
                    RadiosityOperator& F, const Unknowns& unknowns, const Teller& teller, RunReport& report) {
  using Clock = std::chrono::steady_clock;
  const Clock::time_point start = Clock::now();
  const std::filesystem::path folder = report.options.out;
  on_root(leaders, [&] {
    for (const char* name : kPreviews) std::filesystem::remove(folder / name);
  });
  std::size_t next = 0;
  shoot_early_radiosity(F, unknowns, [&](std::span<const Rgb> B, double left) {
    // The root's clock rules, since all must end together.
    double elapsed = leaders.is_root() ? std::chrono::duration<double>(Clock::now() - start).count() : 0;
    leaders.all_max(std::span(&elapsed, 1));
    if (!(left < kFarTooMuch)) {
      teller.say("preview: given up after {:.1f} s, the light grows", elapsed);
      return false;
    }
    if (left < kNothingLeft) {
      teller.say("preview: {:.1f} s, all light has been shot", elapsed);
      return false;
    }
    const std::size_t before = next;
    while (next < kPreviews.size() && elapsed >= static_cast<double>(std::size_t{1} << next)) ++next;
    if (next == before) return true;
    const std::filesystem::path file = folder / kPreviews[next - 1];
    on_root(leaders, [&] { write_preview(file, scene, subdivided, B, report); });
    teller.say("preview: {:.1f} s, {:.3g} % of the light is left to shoot: {}", elapsed, 100 * left,
               file.string());
    return next < kPreviews.size();
  });
}

}  // namespace fluxel
