#include "output/comparands.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <glm/common.hpp>
#include <map>
#include <numeric>

#include "core/input_error_at.hpp"
#include "image/exr_reader.hpp"
#include "scene/polygon.hpp"

namespace fluxel {

namespace {

using Layers = std::map<std::string, std::vector<Rgb>, std::less<>>;

/// Standard errors of means, of whose two halves alone is known: each is far off, their squares are right on
/// average.
std::vector<Rgb> errors_of_halves(const std::vector<Rgb>& a, const std::vector<Rgb>& b) {
  std::vector<Rgb> errors;
  errors.reserve(a.size());
  for (std::size_t k = 0; k < a.size(); ++k) errors.push_back(0.5 * glm::abs(a[k] - b[k]));
  return errors;
}

/// Appends the layers of one side, or of a picture: the values, and their noise where there is some.
void append_side(const std::string& file, Layers& layers, const std::string& values,
                 const std::string& ending, FieldData& field) {
  const auto append = [](std::vector<Rgb>& all, const std::vector<Rgb>& more) {
    all.insert(all.end(), more.begin(), more.end());
  };
  const bool first = field.values.empty();
  append(field.values, layers.at(values));
  const auto layer_of = [&](const std::string& name) {
    const auto found = layers.find(name + ending);
    return found == layers.end() ? nullptr : &found->second;
  };
  const std::vector<Rgb>*const error = layer_of("error"), *const a = layer_of("half_a"),
                               *const b = layer_of("half_b");
  const bool has_halves = a != nullptr && b != nullptr;
  if ((a != nullptr) != (b != nullptr) || (error != nullptr && !has_halves) ||
      (!first && has_halves != field.field().has_noise()))
    throw input_error_at(file, 0,
                         fmt::format("holds some of the layers error{0}, half_a{0} and half_b{0}", ending),
                         "a reference has all three for all that it holds, photons both halves at least");
  if (!has_halves) return;
  append(field.half_a, *a);
  append(field.half_b, *b);
  append(field.error, error != nullptr ? *error : errors_of_halves(*a, *b));
}

FieldData element_field(const std::string& file, Layers& layers) {
  if (!layers.contains(kRadiosity))
    throw input_error_at(file, 0, "holds no radiosity", "give the solution.ply or reference.ply of a run");
  FieldData field;
  append_side(file, layers, kRadiosity, "", field);
  if (layers.contains(kRadiosityBack)) append_side(file, layers, kRadiosityBack, "_back", field);
  return field;
}

/// Largest difference between two coordinates of the elements [m].
double extent_of(const FileElements& elements) {
  glm::dvec3 least = elements.outlines[0].corner[0], most = least;
  for (const auto& outline : elements.outlines)
    for (const glm::dvec3& corner : corners(outline)) {
      least = glm::min(least, corner);
      most = glm::max(most, corner);
    }
  const glm::dvec3 size = most - least;
  return std::max({size.x, size.y, size.z});
}

/// Programs of different instruction sets may round alike elements differently, by less than this.
constexpr double kRounding = 1e-6;

void require_same_elements(const std::string& judged, const FileElements& a, const std::string& reference,
                           const FileElements& b) {
  const auto refuse = [&](const std::string& what) {
    throw InputError(fmt::format(
        "{}: its elements are not those of {}: {} (to make a reference for them: fluxel reference "
        "SCENE --elements {})",
        judged, reference, what, judged));
  };
  if (a.outlines.size() != b.outlines.size())
    refuse(fmt::format("{} instead of {}", a.outlines.size(), b.outlines.size()));
  const double rounding = kRounding * extent_of(b);
  for (std::size_t i = 0; i < a.outlines.size(); ++i) {
    bool same = a.outlines[i].corners == b.outlines[i].corners;
    for (std::size_t k = 0; same && k < a.outlines[i].corners; ++k) {
      const glm::dvec3 apart = glm::abs(a.outlines[i].corner[k] - b.outlines[i].corner[k]);
      same = std::max({apart.x, apart.y, apart.z}) <= rounding;
    }
    if (!same) refuse(fmt::format("number {} lies elsewhere", i));
  }
}

/// Sides that are black in both are left out: no unknowns, such as backs of one-sided patches, or unlit.
std::vector<double> side_areas(const Comparands& of) {
  std::vector<double> areas;
  for (std::size_t i = 0; i < of.reference.values.size(); ++i) {
    const bool black = of.judged.values[i] == Rgb(0) && of.reference.values[i] == Rgb(0);
    areas.push_back(black ? 0 : area(corners(of.elements.outlines[i % of.elements.outlines.size()])));
  }
  return areas;
}

Comparands read_elements(const std::string& judged, const std::string& reference) {
  ElementFile a = read_element_file(judged), b = read_element_file(reference);
  require_same_elements(judged, a.elements, reference, b.elements);
  Comparands of;
  of.judged = element_field(judged, a.layers);
  of.reference = element_field(reference, b.layers);
  of.elements = std::move(b.elements);
  if (of.judged.values.size() != of.reference.values.size())
    throw InputError(
        fmt::format("only one of {} and {} holds the backs of the elements (make both with the same --sides)",
                    judged, reference));
  of.weights = side_areas(of);
  if (of.sides() == 0)
    throw InputError(
        fmt::format("{} and {} are dark everywhere: there is nothing to compare", judged, reference));
  return of;
}

Comparands read_pixels(const std::string& judged, const std::string& reference) {
  LayeredImage a = read_exr(judged), b = read_exr(reference);
  if (a.width != b.width || a.height != b.height)
    throw InputError(fmt::format("{}: {}x{} pixels, but {} has {}x{} (make both with the same --resolution)",
                                 judged, a.width, a.height, reference, b.width, b.height));
  Comparands of;
  append_side(judged, a.layers, "", "", of.judged);
  append_side(reference, b.layers, "", "", of.reference);
  of.width = b.width;
  of.height = b.height;
  of.weights.assign(b.pixels(), 1.0);
  return of;
}

}  // namespace

std::size_t Comparands::sides() const {
  return static_cast<std::size_t>(std::ranges::count_if(weights, [](double weight) { return weight > 0; }));
}

double Comparands::area() const { return std::accumulate(weights.begin(), weights.end(), 0.0); }

Comparands read_comparands(const std::string& judged, const std::string& reference) {
  const std::string kind = std::filesystem::path(judged).extension();
  if (kind != ".ply" && kind != ".exr")
    throw InputError(fmt::format(
        "{}: neither .ply nor .exr (give two files of elements, or two pictures or receivers)", judged));
  if (std::filesystem::path(reference).extension() != kind)
    throw InputError(
        fmt::format("{}: is no {} file as {} is (give two files of elements, or two pictures or receivers)",
                    reference, kind, judged));
  return kind == ".ply" ? read_elements(judged, reference) : read_pixels(judged, reference);
}

}  // namespace fluxel
