#include "output/output_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <string>

#include "core/file.hpp"
#include "core/options.hpp"
#include "image/exr_writer.hpp"
#include "image/png_writer.hpp"
#include "output/convergence.hpp"
#include "output/element_colours.hpp"
#include "output/elements/solution_writer.hpp"
#include "output/false_colour_picture.hpp"
#include "output/light_map_files.hpp"
#include "output/lighting_verdicts.hpp"
#include "output/option_json.hpp"
#include "output/outcome.hpp"
#include "output/outputs.hpp"
#include "output/receiver_files.hpp"
#include "output/report.hpp"
#include "output/run_page.hpp"
#include "output/solution_glb.hpp"
#include "output/solution_vtu.hpp"
#include "output/thermal_table.hpp"
#include "output/timeline.hpp"
#include "output/version_text.hpp"

namespace fluxel {

namespace {

namespace fs = std::filesystem;

bool always(const RunRecord&) { return true; }
bool after_a_run(const RunRecord& record) { return record.solution.end != RunEnd::forecast; }
bool with_timeline(const RunRecord& record) {
  return after_a_run(record) && record.options.timeline && record.solution.matrix &&
         record.solution.matrix->visibility;
}
bool solved(const RunRecord& record) {
  return record.solution.end == RunEnd::solution && can_be_written(record.solution);
}
/// A view shows a solution that stands elsewhere.
bool with_solution(const RunRecord& record) {
  return solved(record) && record.options.method != Method::view;
}
bool with_mesh(const RunRecord& record) {
  return with_solution(record) || (solved(record) && record.solution.mesh);
}
bool with_light_map(const RunRecord& record) { return solved(record) && record.solution.light_map; }
bool with_camera(const RunRecord& record) { return solved(record) && record.options.camera; }
bool with_shot_light(const RunRecord& record) {
  return solved(record) && record.options.preview && record.options.method == Method::matrix;
}
/// By --preview or SIGUSR1.
bool with_rounds(const RunRecord& record) {
  return with_camera(record) && record.options.method == Method::hierarchical;
}
bool with_heat(const RunRecord& record) { return with_solution(record) && record.options.thermal; }
bool with_receivers(const RunRecord& record) { return solved(record) && !record.scene.receivers.empty(); }
bool with_tasks(const RunRecord& record) { return solved(record) && !record.scene.tasks.empty(); }

std::map<std::string, std::string> attributes(const RunRecord& record) {
  std::map<std::string, std::string> text;
  const Json options = options_json(record.options);
  for (const auto& [name, value] : options.items())
    text["fluxel." + name] = value.is_string() ? value.get<std::string>() : value.dump();
  const Solution& solution = record.solution;
  text["fluxel.version"] = version_text();
  text["fluxel.units"] = record.scene.units == Units::photometric ? "photometric" : "radiometric";
  text["fluxel.ranks"] = fmt::format("{}", record.places.size());
  text["fluxel.elements"] = fmt::format("{}", solution.subdivided.mesh.elements.size());
  if (record.options.method != Method::view) {
    text["fluxel.iterations"] = fmt::format("{}", solution.radiosity->iterations);
    text["fluxel.error_bound"] = fmt::format("{:.3g}", solution.radiosity->error_bound);
    text["fluxel.converged"] = solution.radiosity->converged ? "true" : "false";
  }
  if (const std::string what = unreached(record); !what.empty()) text["fluxel.unreached"] = what;
  if (solution.stated_error) text["fluxel.stated_error"] = fmt::format("{:.3g}", *solution.stated_error);
  std::string& seconds = text["fluxel.seconds"];
  for (const auto& [name, phase] : kPhases)
    if (const double wall = (record.time.*phase).wall; wall > 0)
      seconds += fmt::format("{}{} {:.3f}", seconds.empty() ? "" : ", ", name, wall);
  return text;
}

void exr(const fs::path& file, const OutputSource& source) {
  write_exr(file, source.picture->picture, attributes(source.record));
}

void light_map_exr(const fs::path& file, const OutputSource& source) {
  write_light_map_exr(file, source, attributes(source.record));
}

void light_map_picture(const fs::path& file, const OutputSource& source) {
  write_bytes_atomically(file, source.light_map_png);
}

void png(const fs::path& file, const OutputSource& source) { write_png(file, source.picture->display); }

void write_elements(const fs::path& file, const OutputSource& source, decltype(&write_solution) write) {
  const Solution& solution = source.record.solution;
  const ElementView& mesh = solution.subdivided.mesh;
  write(file, source.record.scene, mesh,
        split_sides(solution.radiosity->B, solution.radiosity->H, mesh.elements.size()),
        colours_of_elements(source), unreached(source.record));
}

void ply(const fs::path& file, const OutputSource& source) { write_elements(file, source, write_solution); }

/// Every face a triangle, for programs that read no others.
void triangles(const fs::path& file, const OutputSource& source) {
  write_elements(file, source, write_triangles);
}

void vtu(const fs::path& file, const OutputSource& source) { write_solution_vtu(file, source.record); }

void thermal(const fs::path& file, const OutputSource& source) {
  write_thermal(file, source.record.solution.thermal, source.record.scene.temperature_unit,
                unreached(source.record).empty());
}

void receiver_pictures(const fs::path& file, const OutputSource& source) {
  const RunRecord& record = source.record;
  for (const StatedReceiver& of : stated_receivers(record))
    write_receiver_picture(file.parent_path(), of,
                           {{"fluxel.version", version_text()}, {"fluxel.scene", record.options.scene}});
}

void receiver_maps(const fs::path& file, const OutputSource& source) {
  const RunRecord& record = source.record;
  for (const StatedReceiver& of : stated_receivers(record))
    write_receiver_map(file.parent_path(), of, record.scene.units, record.options.false_colour);
}

void receiver_table(const fs::path& file, const OutputSource& source) {
  write_receiver_table(file, source.record.scene, stated_receivers(source.record));
}

void task_table(const fs::path& file, const OutputSource& source) {
  write_task_table(file, task_verdicts(source.record), unreached(source.record).empty());
}

void timeline(const fs::path& file, const OutputSource& source) {
  write_timeline(file, *source.record.solution.matrix);
}

void convergence(const fs::path& file, const OutputSource& source) {
  write_convergence(file, source.record.phases);
}

void report(const fs::path& file, const OutputSource& source) { write_report(file, source); }

void page(const fs::path& file, const OutputSource& source) { write_run_page(file, source); }

constexpr std::array kTable{
    OutputRow{"preview-1s.png", OutputTime::under_way, with_shot_light, nullptr},
    OutputRow{"preview-2s.png", OutputTime::under_way, with_shot_light, nullptr},
    OutputRow{"preview-4s.png", OutputTime::under_way, with_shot_light, nullptr},
    OutputRow{"preview-8s.png", OutputTime::under_way, with_shot_light, nullptr},
    OutputRow{"preview-#.png", OutputTime::under_way, with_rounds, nullptr},
    OutputRow{"image.exr", OutputTime::solution, with_camera, exr},
    OutputRow{"image.png", OutputTime::solution, with_camera, png},
    OutputRow{"image-false-colour.png", OutputTime::solution, with_camera, write_false_colour_picture,
              "false-colour"},
    OutputRow{"solution.ply", OutputTime::solution, with_solution, ply},
    OutputRow{"solution-triangles.ply", OutputTime::solution, with_solution, triangles, "ply-triangles"},
    OutputRow{"solution.vtu", OutputTime::solution, with_mesh, vtu, "vtu"},
    OutputRow{"solution.glb", OutputTime::solution, with_mesh, write_solution_glb, "glb"},
    OutputRow{"solution-quantised.glb", OutputTime::solution, with_mesh, write_quantised_glb,
              "glb-quantised"},
    OutputRow{"lightmap.exr", OutputTime::solution, with_light_map, light_map_exr, "lightmap"},
    OutputRow{"lightmap.png", OutputTime::solution, with_light_map, light_map_picture, "lightmap"},
    OutputRow{"lightmap.glb", OutputTime::solution, with_light_map, write_light_map_glb, "lightmap"},
    OutputRow{"thermal.csv", OutputTime::solution, with_heat, thermal},
    OutputRow{"receivers.csv", OutputTime::end, with_receivers, receiver_table},
    OutputRow{"tasks.csv", OutputTime::end, with_tasks, task_table},
    OutputRow{"receiver-*.exr", OutputTime::end, with_receivers, receiver_pictures},
    OutputRow{"receiver-*.png", OutputTime::end, with_receivers, receiver_maps},
    OutputRow{"timeline.csv", OutputTime::end, with_timeline, timeline},
    OutputRow{"convergence.csv", OutputTime::end, after_a_run, convergence},
    OutputRow{"report.json", OutputTime::end, always, report},
    OutputRow{"report.html", OutputTime::end, always, page}};

}  // namespace

std::span<const OutputRow> output_table() { return kTable; }

bool is_wanted(const OutputRow& row, const RunRecord& record) {
  const std::vector<std::string>& asked = record.options.write;
  return row.wanted(record) && (row.asked.empty() || std::ranges::find(asked, row.asked) != asked.end());
}

std::vector<std::string> asked_names() {
  std::vector<std::string> names;
  for (const OutputRow& row : kTable)
    if (!row.asked.empty() && std::ranges::find(names, row.asked) == names.end())
      names.emplace_back(row.asked);
  return names;
}

}  // namespace fluxel
