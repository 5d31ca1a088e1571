#include "bench/solver/methods.hpp"

#include <fmt/format.h>

#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <functional>
#include <set>
#include <string>
#include <vector>

#include "bench/solver/counting_operator.hpp"
#include "bench/stability/lit_rooms.hpp"
#include "bench/visibility/csv_file.hpp"
#include "bench/visibility/stopwatch.hpp"
#include "core/error.hpp"

namespace fluxel::bench {

namespace {

constexpr int kMaxIterations = 20000;
constexpr std::array kTolerances{1e-3, 1e-6};

struct NamedSolver {
  Solver solver;
  const char* name;
};
constexpr std::array kSolvers{
    NamedSolver{Solver::jacobi, "Jacobi"}, NamedSolver{Solver::gauss_seidel, "Gauss-Seidel"},
    NamedSolver{Solver::southwell, "Southwell"}, NamedSolver{Solver::conjugate_gradients, "CG"}};

struct NamedRoom {
  lab::LitRoom room;
  const char* name;
};
constexpr std::array kRooms{NamedRoom{lab::LitRoom::box, "box"},
                            NamedRoom{lab::LitRoom::cluttered, "cluttered"},
                            NamedRoom{lab::LitRoom::two_rooms, "two-rooms"}};

/// What the lamp emits [W/m2]: three colours, so that three channels are solved.
const Rgb kLight{10, 8, 6};

/// Wall-clock time and processor time of this thread [s].
struct Times {
  double wall = 0, processor = 0;
};

Times now() {
  std::timespec processor{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &processor);
  return {std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(),
          static_cast<double>(processor.tv_sec) + 1e-9 * static_cast<double>(processor.tv_nsec)};
}

Times since(const Times& start) {
  const Times end = now();
  return {end.wall - start.wall, end.processor - start.processor};
}

/// What one solve has taken.
struct Solve {
  Radiosity radiosity;
  int weight_applications = 0, applications = 0;
  Times of_weights, all;  ///< the second includes the first
  const char* outcome = "converged";
};

/// Ends a solve from within its observer.
struct TimeIsUp {
  int iterations;
  double error_bound;
};

Solve solve(RadiosityOperator& F, const Unknowns& unknowns, Solver solver, double tolerance,
            double limit_seconds, std::span<const Rgb> start) {
  Solve done;
  CountingOperator counted(F);
  const Times began = now();
  const RowSums row_sums = find_error_weights(counted, unknowns);
  done.of_weights = since(began);
  done.weight_applications = counted.applications();
  try {
    done.radiosity = solve_radiosity(
        solver, {counted, unknowns, row_sums}, {tolerance, kMaxIterations},
        [&](const IterationState& state) {
          if (since(began).processor > limit_seconds) throw TimeIsUp{state.iteration, state.error_bound};
        },
        start);
    if (!done.radiosity.converged)
      done.outcome = done.radiosity.iterations == kMaxIterations ? "iterations" : "rounding";
  } catch (const TimeIsUp& up) {
    done.radiosity.iterations = up.iterations;
    done.radiosity.error_bound = up.error_bound;
    done.outcome = "time";
  }
  done.all = since(began);
  done.applications = counted.applications();
  return done;
}

/// What the lines of the tables are about.
struct Case {
  std::string room, start, reflectance;
  double tolerance;
};

class Report {
 public:
  explicit Report(const std::string& csv) : table_(csv) {}

  void add(const Case& which, std::size_t elements, const char* solver, const Solve& done) {
    table_.add({{"room", which.room},
                {"start", which.start},
                {"reflectance", which.reflectance},
                {"solver", solver},
                {"outcome", done.outcome}},
               {{"tolerance", which.tolerance},
                {"elements", static_cast<double>(elements)},
                {"iterations", done.radiosity.iterations},
                {"applications", done.applications},
                {"wall-seconds", done.all.wall},
                {"seconds", done.all.processor},
                {"weight-applications", done.weight_applications},
                {"weight-seconds", done.of_weights.processor},
                {"bound", done.radiosity.error_bound}});
    fmt::print("{:>10} {:>13} {:>6} {:6.0e} {:>13} {:6} {:6} {:9.3f} {:9.3f} {:3} {:6.3f} {:8.2g} {}\n",
               which.room, which.start, which.reflectance, which.tolerance, solver, done.radiosity.iterations,
               done.applications, done.all.wall, done.all.processor, done.weight_applications,
               done.of_weights.processor, done.radiosity.error_bound, done.outcome);
    std::fflush(stdout);
  }

 private:
  CsvFile table_;
};

/// The median of each time.
Times median_of(const std::vector<Solve>& runs, Times Solve::*which) {
  std::vector<double> wall, processor;
  for (const Solve& run : runs) {
    wall.push_back((run.*which).wall);
    processor.push_back((run.*which).processor);
  }
  return {median(wall), median(processor)};
}

/// All solvers in turns. Those that are given up or take long are run once, and a solver that was given up
/// with a larger tolerance (`given_up`) is not tried.
void compare(const Case& which, RadiosityOperator& F, const Unknowns& unknowns, std::span<const Rgb> start,
             const MethodSettings& settings, std::set<Solver>& given_up, Report& report) {
  constexpr double kLong = 3;
  std::array<std::vector<Solve>, kSolvers.size()> runs;
  for (int k = 0; k < settings.repetitions; ++k)
    for (std::size_t s = 0; s < kSolvers.size(); ++s)
      if (!given_up.contains(kSolvers[s].solver) && (runs[s].empty() || runs[s][0].all.processor < kLong))
        runs[s].push_back(
            solve(F, unknowns, kSolvers[s].solver, which.tolerance, settings.limit_seconds, start));
  for (std::size_t s = 0; s < kSolvers.size(); ++s) {
    if (runs[s].empty()) continue;
    Solve typical = runs[s][0];
    typical.all = median_of(runs[s], &Solve::all);
    typical.of_weights = median_of(runs[s], &Solve::of_weights);
    if (typical.outcome == std::string("time")) given_up.insert(kSolvers[s].solver);
    report.add(which, unknowns.elements, kSolvers[s].name, typical);
  }
}

/// The shortest edge that gives no more elements than wanted.
double edge_for(const Communicator& world, lab::LitRoom room, std::size_t wanted) {
  double shorter = 0.02, longer = 2;
  constexpr int kSteps = 12;
  for (int step = 0; step < kSteps; ++step) {
    const double edge = std::sqrt(shorter * longer);
    const lab::Setup setup = lab::lit_room(room, edge);
    const std::size_t count = lab::subdivide(world, setup, lab::build(setup)).elements.size();
    (count > wanted ? shorter : longer) = edge;
  }
  return longer;
}

void measure_room(const Communicator& world, const NamedRoom& which, const MethodSettings& settings,
                  Report& report) {
  const lab::Setup setup = lab::lit_room(which.room, edge_for(world, which.room, settings.elements));
  lab::Prepared room(world, setup, FormFactorOptions{});
  RadiosityOperator& F = room.matrix.factors();
  Unknowns unknowns = room.unknowns;
  light(room, "lamp", kLight, unknowns);
  const std::vector<std::pair<std::string, std::function<void()>>> reflectances{
      {"0.5", [&] { lab::set_reflectance(0.5, unknowns); }},
      {"0.8", [&] { lab::set_reflectance(0.8, unknowns); }},
      {"mixed", [&] { lab::mix_reflectances(room, 0.05, 0.99, unknowns); }},
      {"0.9", [&] { lab::set_reflectance(0.9, unknowns); }},
      {"0.99", [&] { lab::set_reflectance(0.99, unknowns); }},
      {"0.999", [&] { lab::set_reflectance(0.999, unknowns); }}};
  for (const auto& [name, set] : reflectances) {
    set();
    std::set<Solver> given_up;
    for (const double tolerance : kTolerances)
      compare({which.name, "cold", name, tolerance}, F, unknowns, {}, settings, given_up, report);
  }
  lab::set_reflectance(0.8, unknowns);
  const std::vector<Rgb> before =
      solve(F, unknowns, Solver::conjugate_gradients, kTolerances[0], settings.limit_seconds, {}).radiosity.B;
  std::set<Solver> none_given_up;
  light(room, "lamp", {kLight.b, kLight.g, kLight.r}, unknowns);
  compare({which.name, "other colour", "0.8", kTolerances[0]}, F, unknowns, before, settings, none_given_up,
          report);
  light(room, "second lamp", kLight, unknowns);
  compare({which.name, "other place", "0.8", kTolerances[0]}, F, unknowns, before, settings, none_given_up,
          report);
}

}  // namespace

void run_methods(const MethodSettings& settings) {
  const MpiSession session(nullptr, nullptr);
  Report report(settings.csv);
  fmt::print("{:>10} {:>13} {:>6} {:>6} {:>13} {:>6} {:>6} {:>9} {:>9} {:>10} {:>8}\n", "room", "start",
             "rho", "to", "solver", "iter.", "F", "wall s", "proc. s", "weights", "bound");
  bool measured = false;
  for (const NamedRoom& room : kRooms) {
    if (!settings.only.empty() && settings.only != room.name) continue;
    measure_room(session.world(), room, settings, report);
    measured = true;
  }
  if (!measured) throw InputError("no room is named " + settings.only);
}

}  // namespace fluxel::bench
