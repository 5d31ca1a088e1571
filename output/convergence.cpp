#include "output/convergence.hpp"

#include <fmt/format.h>

#include <cmath>
#include <iterator>

#include "core/error.hpp"
#include "core/file.hpp"

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

ProgressRecorder::Keep keep_convergence(const Communicator& world, const Options& options) {
  if (!world.is_root()) return {};
  const std::filesystem::path file = std::filesystem::path(options.out) / "convergence.csv";
  return [file](const std::vector<PhaseRecord>& phases) {
    try {
      write_convergence(file, phases);
    } catch (const InputError&) {  // the end will say so
    }
  };
}

}  // namespace fluxel
