// inversion_bench SCENE
//
// The equation g(t) = u g(theta_2) of Dmitriev (2002, equation 14), on the cells of the first luminaire's
// table as often as light is emitted from them, by Newton's way, which `fluxel photons` takes, by the secant
// and by Ridders' way, each with a kept bracket and to the same closeness, as a Markdown table: the least of
// five turns in which all take part.

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "optics/intensity_cell.hpp"
#include "optics/newton.hpp"
#include "sampling/cuda/chosen_part.hpp"
#include "sampling/random_sequence.hpp"
#include "scene/odd_moment.hpp"
#include "scene/scene_input.hpp"

namespace {

using namespace fluxel;

constexpr double kClose = 1e-14;
constexpr int kMostSteps = 60;

/// The integral over gamma of (first + slope (gamma - from)) sin(gamma), of one cell, up to a wanted part.
struct Equation {
  double from, to, first, slope, wanted, flux;
  mutable std::size_t values = 0;

  [[nodiscard]] double below(double gamma) const {
    const double h = 0.5 * (gamma - from), m = from + h;
    return 2 * (std::sin(m) * std::sin(h) * (first + slope * h) + std::cos(m) * h * odd_moment(h) * slope);
  }
  [[nodiscard]] double operator()(double gamma) const {
    ++values;
    return below(gamma) - wanted;
  }
  [[nodiscard]] double derivative(double gamma) const {
    return (first + slope * (gamma - from)) * std::sin(gamma);
  }
};

double by_newton(const Equation& g) {
  return root_by_newton(
      g, [&](double gamma) { return g.derivative(gamma); }, g.from, g.to,
      std::lerp(g.from, g.to, g.wanted / g.flux), kClose * g.to, kClose * g.flux);
}

/// The secant through the ends of a bracket, of which the value of one that stays is taken for half, so that
/// both close in (Dowell & Jarratt 1971, "Illinois").
double by_secant(const Equation& g) {
  double low = g.from, high = g.to, below = -g.wanted, above = g.flux - g.wanted, x = low;
  int stayed = 0;  // -1: the lower end, 1: the upper one
  for (int step = 0; step < kMostSteps && high - low > kClose * g.to; ++step) {
    x = std::clamp(low - below * (high - low) / (above - below), low, high);
    const double at = g(x);
    if (std::abs(at) <= kClose * g.flux) break;
    if (at < 0) {
      low = x, below = at;
      if (stayed == 1) above *= 0.5;
      stayed = 1;
    } else {
      high = x, above = at;
      if (stayed == -1) below *= 0.5;
      stayed = -1;
    }
  }
  return x;
}

/// The false position on the function times the exponential that makes both ends and the middle lie on a line
/// (Ridders 1979).
double by_ridders(const Equation& g) {
  double low = g.from, high = g.to, below = -g.wanted, above = g.flux - g.wanted, x = low;
  for (int step = 0; step < kMostSteps && high - low > kClose * g.to; ++step) {
    const double middle = 0.5 * (low + high), half = g(middle);
    if (std::abs(half) <= kClose * g.flux) return middle;
    x = middle - (middle - low) * half / std::sqrt(half * half - below * above);
    const double at = g(x);
    if (std::abs(at) <= kClose * g.flux) break;
    if (half < 0) low = middle, below = half;
    if (half > 0) high = middle, above = half;
    if (at < 0 && x > low) low = x, below = at;
    if (at > 0 && x < high) high = x, above = at;
  }
  return x;
}

/// A million of them, of random cells and numbers.
std::vector<Equation> equations(const std::string& file) {
  const SceneInput input = read_scene_input(file);
  if (input.intensities.empty()) throw InputError(file + ": no luminaire");
  const IntensityTable& table = input.intensities.front();
  std::vector<Equation> cells;
  std::vector<double> ends;
  double sum = 0;
  for (std::size_t c = 0; c < std::max<std::size_t>(1, table.C.size() - 1); ++c)
    for (std::size_t g = 0; g + 1 < table.gamma.size(); ++g) {
      const std::size_t other = table.C.size() > 1 ? c + 1 : c;
      const double first = 0.5 * (table.at(c, g) + table.at(other, g));
      const double last = 0.5 * (table.at(c, g + 1) + table.at(other, g + 1));
      Equation cell{table.gamma[g],
                    table.gamma[g + 1],
                    first,
                    (last - first) / (table.gamma[g + 1] - table.gamma[g]),
                    0,
                    0};
      cell.flux = cell.below(cell.to);
      if (!(cell.flux > 0)) continue;
      cells.push_back(cell);
      ends.push_back(sum += IntensityCell(table, c, g).flux());
    }
  RandomSequence random(1);
  std::vector<Equation> drawn;
  constexpr std::size_t kDrawn = 1'000'000;
  for (std::size_t k = 0; k < kDrawn; ++k) {
    random.start(k);
    drawn.push_back(cells[cuda::chosen_part(ends.data(), ends.size(), random.next()).number]);
    drawn.back().wanted = random.next() * drawn.back().flux;
  }
  return drawn;
}

struct Finder {
  const char* name;
  double (*root)(const Equation&);
  double seconds = std::numeric_limits<double>::infinity();
  double worst = 0;  // distance from the wanted part, of the cell's flux
};

void find_all(const std::vector<Equation>& all, Finder& finder) {
  std::vector<double> roots(all.size());
  const auto start = std::chrono::steady_clock::now();
  for (std::size_t k = 0; k < all.size(); ++k) roots[k] = finder.root(all[k]);
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  finder.seconds = std::min(finder.seconds, seconds.count());
  for (std::size_t k = 0; k < all.size(); ++k)
    finder.worst = std::max(finder.worst, std::abs(all[k].below(roots[k]) - all[k].wanted) / all[k].flux);
}

void compare(const std::vector<Equation>& all) {
  std::vector<Finder> finders{{"Newton", by_newton}, {"secant", by_secant}, {"Ridders", by_ridders}};
  constexpr int kTurns = 5;
  for (int turn = 0; turn < kTurns; ++turn)
    for (Finder& finder : finders) find_all(all, finder);
  const auto count = static_cast<double>(all.size());
  fmt::print("| | ns a root | over Newton's | values of g | worst, of the flux |\n|{}\n",
             " --- |---: |---: |---: |---: |");
  for (const Finder& finder : finders) {
    std::size_t values = 0;
    for (const Equation& g : all) {
      g.values = 0;
      static_cast<void>(finder.root(g));
      values += g.values;
    }
    fmt::print("| {} | {:.0f} | {:.2f} | {:.2f} | {:.1e} |\n", finder.name, 1e9 * finder.seconds / count,
               finder.seconds / finders.front().seconds, static_cast<double>(values) / count, finder.worst);
  }
}

}  // namespace

int main(int argc, char** argv) {
  try {
    if (argc != 2) throw InputError("usage: inversion_bench SCENE");
    compare(equations(argv[1]));
  } catch (const std::exception& error) {
    fmt::print(stderr, "inversion_bench: {}\n", error.what());
    return 2;
  }
  return 0;
}
