#include "output/convergence.hpp"

#include <fmt/format.h>

#include <cmath>
#include <iterator>

#include "core/error.hpp"
#include "core/file.hpp"
#include "core/options.hpp"
#include "output/html/html_page.hpp"
#include "output/json_parts.hpp"
#include "output/run_page.hpp"

namespace fluxel {

void write_convergence(const std::filesystem::path& file, const std::vector<PhaseRecord>& phases) {
  const auto field = [](double value) {
    return std::isfinite(value) ? fmt::format("{:.6g}", value) : std::string();
  };
  std::string text = "phase,seconds,done,error,target,forecast_s\n";
  for (const PhaseRecord& phase : phases) {
    for (const PhaseSample& sample : phase.samples())
      fmt::format_to(std::back_inserter(text), "{},{},{},{},{},{}\n", phase.name(), field(sample.seconds),
                     field(sample.done), field(sample.error),
                     phase.has_errors() ? field(sample.target) : std::string(), field(sample.forecast));
  }
  write_bytes_atomically(file, text);
}

ProgressRecorder::Keep keep_convergence(const Communicator& world, const Options& options,
                                        const std::string& page) {
  if (!world.is_root()) return {};
  const std::filesystem::path folder = options.out;
  HtmlPage live;
  live.kind = std::filesystem::path(page).stem().string();
  live.name = std::filesystem::path(options.scene).filename().string();
  live.command = command_text(options.command, static_cast<std::size_t>(world.size()));
  live.is_live = true;
  return [=, is_live = options.live](const std::vector<PhaseRecord>& phases) {
    try {
      write_convergence(folder / "convergence.csv", phases);
      if (!is_live) return;
      HtmlPage now = live;
      now.report["progress"] = progress_json(phases, Phases::all);
      write_html_page(folder / page, now);
    } catch (const InputError&) {  // the end will say so
    }
  };
}

}  // namespace fluxel
