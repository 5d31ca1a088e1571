// fluxel_throwing_rank PHASE RANK OUT: a small job in which that rank throws when that phase begins.

#include <stdexcept>
#include <string>
#include <variant>

#include "app/command_line.hpp"
#include "app/end_of_run.hpp"
#include "app/solve.hpp"
#include "mpi_master/communication/communicator.hpp"

namespace {

using namespace fluxel;

class ThrowingDisplay final : public ProgressDisplay {
 public:
  explicit ThrowingDisplay(std::string phase) : phase_(std::move(phase)) {}
  void begin(const std::string& phase) override {
    if (phase == phase_) throw std::runtime_error("planted failure in " + phase);
  }
  void show(double, double, const std::string&) override {}
  void end() override {}

 private:
  std::string phase_;
};

}  // namespace

int main(int argc, char** argv) {
  if (argc != 4) return 64;
  const std::string phase = argv[1], out = argv[3];
  const int rank = std::stoi(argv[2]);
  const MpiSession session(&argc, &argv);
  return guarded(session.world(), [&] {
    const auto request = std::get<SolveRequest>(
        read_command_line({"solve", FLUXEL_SOURCE_DIR "/scenes/cornell-box/cornell-box.toml", "--method",
                           "matrix", "--resolution", "16x16", "--threads", "1", "--quiet", "--out", out}));
    ThrowingDisplay throwing(phase);
    NoDisplay silent;
    ProgressDisplay& display =
        session.world().rank() == rank ? static_cast<ProgressDisplay&>(throwing) : silent;
    return run_solve(session.world(), request, display);
  });
}
