#include "output/comparison_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>

#include "core/options.hpp"

namespace fluxel {

namespace {

std::string percent(double share) { return fmt::format("{:.4g} %", 100 * share); }

/// A line of the table for each colour, where the colour has it.
struct Row {
  const char* label;
  std::function<std::string(const ColourErrors&)> text;
};

std::vector<Row> rows(const Comparands& of, const ComparisonReport& report) {
  std::vector<Row> rows{
      {"mean of B", [](const ColourErrors& e) { return fmt::format("{:.6g}", e.mean); }},
      {"mean of A", [](const ColourErrors& e) { return fmt::format("{:.6g}", e.judged_mean); }},
      {"sigma", [](const ColourErrors& e) { return fmt::format("{:.6g}", e.sigma); }},
      {"over the mean of B:", [](const ColourErrors&) { return std::string(); }},
      {"  sigma", [](const ColourErrors& e) { return percent(e.sigma / e.mean); }},
      {"  bias", [](const ColourErrors& e) { return percent(e.bias / e.mean); }},
      {"  deviation", [](const ColourErrors& e) { return percent(e.deviation / e.mean); }},
      {"  99th percentile", [](const ColourErrors& e) { return percent(e.percentile_99 / e.mean); }},
      {"  largest", [](const ColourErrors& e) { return percent(e.largest / e.mean); }}};
  if (report.noise_free()) {
    const std::vector<Row> of_noise{
        {"  noise of B",
         [](const ColourErrors& e) { return percent(e.noise_free->reference_noise / e.mean); }},
        {"  bias, standard error",
         [](const ColourErrors& e) { return percent(e.noise_free->bias_error / e.mean); }},
        {"  deviation without noise",
         [](const ColourErrors& e) { return percent(e.noise_free->deviation() / e.mean); }},
        {"  sigma without noise",
         [](const ColourErrors& e) { return percent(e.noise_free->sigma() / e.mean); }},
        {"    one standard error down",
         [](const ColourErrors& e) { return percent(e.noise_free->sigma_low() / e.mean); }},
        {"    and up", [](const ColourErrors& e) { return percent(e.noise_free->sigma_high() / e.mean); }}};
    rows.insert(rows.end(), of_noise.begin(), of_noise.end());
  }
  rows.push_back({"sigma over the quadratic mean", [](const ColourErrors& e) {
                    return percent((e.noise_free ? e.noise_free->sigma() : e.sigma) / e.quadratic_mean);
                  }});
  if (!of.of_elements())
    rows.push_back(
        {"relMSE", [](const ColourErrors& e) { return fmt::format("{:.4g}", e.relative_mean_square); }});
  return rows;
}

}  // namespace

bool ComparisonReport::noise_free() const {
  return std::ranges::any_of(errors.colours, [](const auto& colour) { return colour && colour->noise_free; });
}

ComparisonReport compare(const Comparands& of) {
  const Field judged = of.judged.field(), reference = of.reference.field();
  ComparisonReport report;
  report.errors = compare_fields(judged, reference, of.weights);
  report.relative = relative_differences(judged, reference, report.errors);
  report.overall = overall_differences(judged, reference, report.errors);
  report.range = symmetric_range(report.overall, of.weights);
  report.histogram = histogram_of(report.relative, of.weights, report.range);
  return report;
}

std::vector<std::string> comparison_notes(const ComparisonReport& report) {
  std::vector<std::string> notes;
  for (int c = 0; c < kChannels; ++c) {
    const auto& colour = report.errors.colours[static_cast<std::size_t>(c)];
    if (!colour)
      notes.push_back(fmt::format("{}: left out, as it is 0 everywhere in A and B", kColourNames[c]));
    else if (!(colour->mean > 0))
      notes.push_back(
          fmt::format("{}: no error is relative to B, whose mean is not above 0", kColourNames[c]));
    else if (colour->noise_free && colour->noise_free->is_hidden())
      notes.push_back(fmt::format("{}: the noise hides the error, which is below {:.3g} % or so{}",
                                  kColourNames[c], 100 * colour->noise_free->sigma_high() / colour->mean,
                                  colour->noise_free->mean_square < 0
                                      ? " (the estimate of its square is below 0, and reported as 0)"
                                      : ""));
  }
  const bool judged_has_noise = std::ranges::any_of(report.errors.colours, [](const auto& colour) {
    return colour && colour->noise_free && colour->noise_free->judged_noise > 0;
  });
  if (judged_has_noise)
    notes.emplace_back(
        "both files have noise: of references with the same --seed it is alike, and then no error of either "
        "shows");
  return notes;
}

std::string comparison_table(const CompareOptions& options, const Comparands& of,
                             const ComparisonReport& report) {
  std::string text = fmt::format("A: {}\nB: {}\n", options.judged, options.reference);
  text += of.of_elements() ? fmt::format("{} elements, {} sides of {:.6g} m2\n", of.elements.outlines.size(),
                                         of.sides(), of.area())
                           : fmt::format("{}x{} pixels\n", of.width, of.height);
  text += fmt::format("{:30}", "");
  for (const char* colour : kColourNames) text += fmt::format("{:>14}", colour);
  text += "\n";
  for (const Row& row : rows(of, report)) {
    text += fmt::format("{:30}", row.label);
    for (const auto& colour : report.errors.colours)
      text += fmt::format("{:>14}", colour ? row.text(*colour) : "-");
    text += "\n";
  }
  text += fmt::format("error: {} (largest sigma over the mean{})\n", percent(report.errors.figure()),
                      report.noise_free() ? ", without noise" : "");
  for (const std::string& note : comparison_notes(report)) text += fmt::format("note: {}\n", note);
  if (!options.out.empty())
    text += fmt::format("map: {0}/error.{1}, from blue -{2} over white to red {2}\n", options.out,
                        of.of_elements() ? "ply" : "png", percent(report.range));
  return text;
}

}  // namespace fluxel
