#include "output/outputs.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <system_error>

#include "core/file.hpp"
#include "core/input_error_at.hpp"
#include "core/options.hpp"
#include "image/seen_noise.hpp"
#include "method/kept_links.hpp"
#include "output/light_map_files.hpp"
#include "output/run_page.hpp"

namespace fluxel {

namespace {

namespace fs = std::filesystem;

bool fits_single_precision(const std::vector<Rgb>& values) {
  constexpr double kLargest = std::numeric_limits<float>::max();
  return std::ranges::all_of(values, [](const Rgb& value) {
    return std::abs(value.r) <= kLargest && std::abs(value.g) <= kLargest && std::abs(value.b) <= kLargest;
  });
}

bool is_numbered(const OutputRow& row) { return row.name.find('#') != std::string_view::npos; }

/// The files of a row, by name: of a family those of the scene's receivers; of numbered ones none.
std::vector<fs::path> files_of(const OutputRow& row, std::span<const Receiver> receivers) {
  if (is_numbered(row)) return {};
  const std::size_t star = row.name.find('*');
  if (star == std::string_view::npos) return {fs::path(row.name)};
  std::vector<fs::path> files;
  for (const Receiver& receiver : receivers)
    files.emplace_back(std::string(row.name).replace(star, 1, receiver.name));
  return files;
}

/// Files of a family in the folder, whatever scene they are of.
bool is_of_family(const OutputRow& row, const fs::path& file) {
  const std::string name = file.filename().string();
  const std::size_t star = row.name.find_first_of("*#");
  if (star == std::string_view::npos) return false;
  const std::string_view before = row.name.substr(0, star), after = row.name.substr(star + 1);
  if (name.size() <= before.size() + after.size() || !name.starts_with(before) || !name.ends_with(after))
    return false;
  const std::string between = name.substr(star, name.size() - before.size() - after.size());
  return !is_numbered(row) || between.find_first_not_of("0123456789") == std::string::npos;
}

/// What a checkpoint's folder may hold of an earlier run's strips and rounds.
std::vector<fs::path> kept_files(const fs::path& folder) {
  std::error_code failed;
  std::vector<fs::path> files;
  for (fs::directory_iterator at(folder, failed), end; !failed && at != end; at.increment(failed))
    if (at->path().extension() == ".fxs" || at->path().extension() == ".fxr") files.push_back(at->path());
  return files;
}

void make_picture_of_camera(OutputSource& source) {
  source.picture = make_run_picture(source.record);
  source.exposure = source.picture->display.curve.exposure;
  source.shown = shown_pictures(source);
  const Solution& solution = source.record.solution;
  if (!solution.pixel_irradiance.empty())
    source.noise =
        seen_noise(solution.subdivided.raster, source.record.options.supersample, solution.pixel_irradiance);
}

}  // namespace

void require_outputs(const Options& options, const SceneInput& input) {
  const fs::path folder = options.out;
  std::vector<fs::path> outputs;
  for (const OutputRow& row : output_table())
    for (const fs::path& name : files_of(row, input.receivers)) outputs.push_back(folder / name);
  std::vector<fs::path> replaced = kept_files(options.checkpoint);
  replaced.insert(replaced.end(), outputs.begin(), outputs.end());
  require_inputs_kept(input.files, replaced);
  require_writable_folder(folder);
  std::error_code ignored;
  if (!options.checkpoint.empty() && fs::weakly_canonical(options.checkpoint, ignored) ==
                                         fs::weakly_canonical(links_folder(folder), ignored))
    throw input_error_at(options.checkpoint, 0, "is where --keep-links keeps links for views",
                         "choose another --checkpoint");
  for (const fs::path& file : outputs)
    if (fs::is_directory(file))
      throw input_error_at(file, 0, "is a folder where a file will be written",
                           "remove it, or choose another --out");
}

bool can_be_written(const Solution& solution) {
  return solution.radiosity && fits_single_precision(solution.radiosity->B) &&
         fits_single_precision(solution.radiosity->H);
}

void make_pictures_of(OutputSource& source) {
  const Solution& solution = source.record.solution;
  if (!can_be_written(solution)) return;
  if (source.record.options.camera) make_picture_of_camera(source);
  if (solution.light_map) source.light_map_png = light_map_png(source);
}

void write_outputs(OutputTime when, const OutputSource& source) {
  const fs::path folder = source.record.options.out;
  for (const OutputRow& row : output_table())
    if (row.when == when && row.write != nullptr && is_wanted(row, source.record))
      row.write(folder / row.name, source);
}

std::vector<fs::path> stale_outputs(const RunRecord& record) {
  const fs::path folder = record.options.out;
  std::vector<fs::path> stale;
  // A reference's receivers and tasks have the same names.
  const bool is_of_reference = fs::exists(folder / "reference.json");
  const bool is_view = record.options.method == Method::view;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    if (entry.is_directory()) continue;
    const fs::path name = entry.path().filename();
    for (const OutputRow& row : output_table()) {
      // What only a solve can make is not a view's to remove.
      if (is_view && (row.name.starts_with("solution") || row.name == "thermal.csv")) continue;
      const bool is_of_receivers = (is_of_family(row, name) && !is_numbered(row)) ||
                                   row.name == "receivers.csv" || row.name == "tasks.csv";
      const bool is_of_row =
          (name == row.name || is_of_family(row, name)) && !(is_of_receivers && is_of_reference);
      const auto own =
          is_wanted(row, record) ? files_of(row, record.scene.receivers) : std::vector<fs::path>{};
      const bool is_own =
          is_numbered(row) ? is_wanted(row, record) : std::ranges::find(own, name) != own.end();
      if (is_of_row && !is_own) stale.push_back(folder / name);
    }
  }
  std::ranges::sort(stale);
  return stale;
}

void remove_early_pictures(const fs::path& folder) {
  std::vector<fs::path> early;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder))
    for (const OutputRow& row : output_table())
      if (row.when == OutputTime::under_way && !entry.is_directory() &&
          (entry.path().filename() == row.name || is_of_family(row, entry.path())))
        early.push_back(entry.path());
  for (const fs::path& file : early) fs::remove(file);
}

void remove_outputs(const std::vector<fs::path>& files) {
  for (const fs::path& file : files) {
    std::error_code failed;
    fs::remove(file, failed);
    if (failed) throw input_error_at(file, 0, "an earlier run's file cannot be removed: " + failed.message());
  }
}

}  // namespace fluxel
