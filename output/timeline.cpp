#include "output/timeline.hpp"

#include <fmt/format.h>

#include <array>
#include <iterator>
#include <string>

#include "core/file.hpp"

namespace fluxel {

namespace {

void append(const char* phase, const ScheduleRecord& schedule, std::string& text) {
  constexpr std::array kKinds{"compute", "messages", "wait"};
  for (const ActivitySpan& span : schedule.timeline)
    fmt::format_to(std::back_inserter(text), "{},{},{},{:.6f},{:.6f}\n", phase, span.rank,
                   kKinds[static_cast<std::size_t>(span.kind)], span.start, span.end);
}

}  // namespace

void write_timeline(const std::filesystem::path& file, const MatrixStatistics& statistics) {
  std::string text = "phase,rank,kind,start_s,end_s\n";
  append("visibility", statistics.visibility_schedule, text);
  if (statistics.form_factors) append("corrections", statistics.form_factors->corrections_schedule, text);
  write_bytes_atomically(file, text);
}

}  // namespace fluxel
