#include "hierarchy/kept_rounds.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <stdexcept>
#include <string_view>
#include <type_traits>

#include "core/hash.hpp"
#include "visibility/visibility_identity.hpp"

namespace fluxel {

namespace {

static_assert(std::endian::native == std::endian::little, "the file is little endian");

/// To be raised with every change after which the same scene may get other nodes, links or light.
constexpr std::uint64_t kRefining = 10;

constexpr std::string_view kRoundMagic = "FLXROUND";
constexpr std::uint32_t kRoundVersion = 4;

struct RoundHeader {
  std::array<char, 8> magic;
  std::uint32_t version, zero;
  std::uint64_t identity;
  std::uint64_t payload_bytes, payload_check;
  std::uint64_t check;  // of what stands before
};
static_assert(sizeof(RoundHeader) == 48);

std::uint64_t check_of(const RoundHeader& header) {
  return hash_bytes(std::as_bytes(std::span(&header, 1)).first(offsetof(RoundHeader, check)));
}

/// What stands first in the payload.
struct Fixed {
  std::uint64_t ranks, rounds, halvings, cut, unknowns, cause_bytes, path_sums, paths, path_seed, path_rays;
  std::uint32_t solver, channels, iterations, converged;
  double residual, error_bound, path_seconds;
  Rgb largest_bound, mean_square_bound;
};
static_assert(sizeof(Fixed) == 10 * 8 + 4 * 4 + 9 * 8);

using RoundNumbers = std::array<double, 10>;

RoundNumbers numbers_of(const HierarchyRound& round) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  return {round.block_error,
          static_cast<double>(round.links),
          static_cast<double>(round.rows),
          static_cast<double>(round.nodes),
          static_cast<double>(round.leaves),
          static_cast<double>(round.iterations),
          round.change.value_or(kNone),
          round.discretisation.value_or(kNone),
          round.refine_seconds,
          round.solve_seconds};
}

HierarchyRound round_of(const RoundNumbers& numbers) {
  const auto known = [](double x) { return std::isnan(x) ? std::nullopt : std::optional(x); };
  const auto count = [](double x, double most) {
    if (!(x >= 0 && x <= most)) throw std::runtime_error("no count");
    return static_cast<std::uint64_t>(x);
  };
  constexpr double kMaxInDouble = 0x1p53;
  return {numbers[0],
          count(numbers[1], kMaxInDouble),
          count(numbers[2], double{kNoNode}),
          count(numbers[3], double{kNoNode}),
          count(numbers[4], double{kNoNode}),
          static_cast<int>(count(numbers[5], double{std::numeric_limits<int>::max()})),
          known(numbers[6]),
          known(numbers[7]),
          numbers[8],
          numbers[9]};
}

template <class T>
void append(std::string& bytes, std::span<const T> items) {
  static_assert(std::is_trivially_copyable_v<T>);
  bytes.append(reinterpret_cast<const char*>(items.data()), items.size_bytes());
}

/// Takes items off the front of bytes, and throws std::runtime_error where there are not enough.
class Reader {
 public:
  explicit Reader(std::span<const std::byte> bytes) : rest_(bytes) {}

  template <class T>
  std::vector<T> take(std::uint64_t count) {
    if (count > rest_.size() / sizeof(T)) throw std::runtime_error("too short");
    std::vector<T> items(count);
    if (count > 0) std::memcpy(items.data(), rest_.data(), count * sizeof(T));
    rest_ = rest_.subspan(count * sizeof(T));
    return items;
  }
  template <class T>
  T take() {
    return take<T>(1).front();
  }
  [[nodiscard]] std::span<const std::byte> rest() const { return rest_; }

 private:
  std::span<const std::byte> rest_;
};

int small_count(std::uint32_t count) {
  if (count > static_cast<std::uint32_t>(std::numeric_limits<int>::max()))
    throw std::runtime_error("no count");
  return static_cast<int>(count);
}

bool are_possible(const AuditPaths& paths) {
  return (paths.of_each > 0) == !paths.sums.empty() && paths.seconds >= 0 &&
         std::ranges::all_of(paths.sums, [](const Rgb& sum) {
           return std::isfinite(sum.r) && std::isfinite(sum.g) && std::isfinite(sum.b);
         });
}

KeptRounds read_payload(std::span<const std::byte> payload) {
  Reader reader(payload);
  const auto fixed = reader.take<Fixed>();
  constexpr std::array kSolvers{Solver::jacobi, Solver::conjugate_gradients, Solver::southwell};
  const auto solver = std::ranges::find(kSolvers, fixed.solver, [](Solver s) { return std::uint32_t(s); });
  if (fixed.rounds == 0 || fixed.ranks == 0 || solver == kSolvers.end())
    throw std::runtime_error("numbers that cannot be");
  KeptRounds kept;
  kept.ranks = fixed.ranks;
  for (const RoundNumbers& numbers : reader.take<RoundNumbers>(fixed.rounds))
    kept.rounds.push_back(round_of(numbers));
  kept.halvings = reader.take<Halving>(fixed.halvings);
  kept.cut = reader.take<NodeId>(fixed.cut);
  Radiosity& radiosity = kept.radiosity;
  radiosity.B = reader.take<Rgb>(fixed.unknowns);
  radiosity.H = reader.take<Rgb>(fixed.unknowns);
  const std::vector<char> cause = reader.take<char>(fixed.cause_bytes);
  radiosity.cause.assign(cause.begin(), cause.end());
  kept.paths = {reader.take<Rgb>(fixed.path_sums), static_cast<std::uint32_t>(fixed.paths), fixed.path_seed,
                fixed.path_rays, fixed.path_seconds};
  if (!are_possible(kept.paths) || fixed.paths != kept.paths.of_each) throw std::runtime_error("no paths");
  if (!reader.rest().empty()) throw std::runtime_error("too long");
  radiosity.solver = *solver;
  radiosity.channels = small_count(fixed.channels);
  radiosity.iterations = small_count(fixed.iterations);
  radiosity.residual = fixed.residual;
  radiosity.error_bound = fixed.error_bound;
  radiosity.largest_bound = fixed.largest_bound;
  radiosity.mean_square_bound = fixed.mean_square_bound;
  radiosity.converged = fixed.converged != 0;
  return kept;
}

}  // namespace

std::uint64_t rounds_identity(const RayScene& ray_scene, const NodeTree& tree, const Unknowns& unknowns,
                              std::span<const GatherPoint> seen, std::span<const double> choices) {
  const ElementMesh mesh = tree.elements();
  std::uint64_t hash = visibility_identity(ray_scene, mesh.elements);
  const auto add = [&hash](auto items) { hash = hash_bytes(std::as_bytes(items), hash); };
  add(std::span(&kRefining, 1));
  add(std::span(unknowns.E));
  add(std::span(unknowns.rho));
  for (const Luminaire& luminaire : tree.scene().luminaires) {
    for (const glm::dvec3& vector : {luminaire.position, luminaire.aim, luminaire.ahead, luminaire.scale})
      add(std::span(&vector, 1));
    add(std::span(&luminaire.size, 1));
    add(std::span(&luminaire.round, 1));
    const IntensityTable& table = tree.scene().intensity(luminaire);
    for (const std::vector<double>& values : {table.C, table.gamma, table.intensity}) add(std::span(values));
  }
  for (const GatherPoint& point : seen) {
    add(std::span(&point.face, 1));
    add(std::span(&point.position, 1));
  }
  add(choices);
  return hash;
}

std::string rounds_file(const KeptRounds& kept, std::uint64_t identity) {
  const Radiosity& radiosity = kept.radiosity;
  const Fixed fixed{kept.ranks,
                    kept.rounds.size(),
                    kept.halvings.size(),
                    kept.cut.size(),
                    radiosity.B.size(),
                    radiosity.cause.size(),
                    kept.paths.sums.size(),
                    kept.paths.of_each,
                    kept.paths.seed,
                    kept.paths.rays,
                    static_cast<std::uint32_t>(radiosity.solver),
                    static_cast<std::uint32_t>(radiosity.channels),
                    static_cast<std::uint32_t>(radiosity.iterations),
                    radiosity.converged ? 1u : 0u,
                    radiosity.residual,
                    radiosity.error_bound,
                    kept.paths.seconds,
                    radiosity.largest_bound,
                    radiosity.mean_square_bound};
  std::string bytes(sizeof(RoundHeader), '\0');
  append(bytes, std::span(&fixed, 1));
  for (const HierarchyRound& round : kept.rounds) {
    const RoundNumbers numbers = numbers_of(round);
    append(bytes, std::span<const double>(numbers));
  }
  append(bytes, std::span<const Halving>(kept.halvings));
  append(bytes, std::span<const NodeId>(kept.cut));
  append(bytes, std::span<const Rgb>(radiosity.B));
  append(bytes, std::span<const Rgb>(radiosity.H));
  bytes += radiosity.cause;
  append(bytes, std::span<const Rgb>(kept.paths.sums));
  const auto payload = std::as_bytes(std::span(bytes)).subspan(sizeof(RoundHeader));
  RoundHeader header{{}, kRoundVersion, 0, identity, payload.size(), hash_bytes(payload), 0};
  kRoundMagic.copy(header.magic.data(), header.magic.size());
  header.check = check_of(header);
  std::memcpy(bytes.data(), &header, sizeof header);
  return bytes;
}

RoundsFileResult read_rounds_file(std::span<const std::byte> bytes, std::uint64_t identity) {
  RoundHeader header;
  if (bytes.size() < sizeof header) return {{}, "is too short to be a file of rounds"};
  std::memcpy(&header, bytes.data(), sizeof header);
  if (std::string_view(header.magic.data(), header.magic.size()) != kRoundMagic)
    return {{}, "is no file of rounds"};
  const auto payload = bytes.subspan(sizeof header);
  if (header.check != check_of(header) || payload.size() != header.payload_bytes ||
      hash_bytes(payload) != header.payload_check)
    return {{}, "is damaged or cut off"};
  if (header.version != kRoundVersion)
    return {{},
            fmt::format("is of another version of the format ({} where {} is needed)", header.version,
                        kRoundVersion)};
  if (header.identity != identity) return {{}, "is of another scene or other options"};
  try {
    return {read_payload(payload), {}};
  } catch (const std::runtime_error&) {
    return {{}, "is damaged or cut off"};
  }
}

}  // namespace fluxel
