#include "photons/tally_file.hpp"

#include <fmt/format.h>

#include <array>
#include <bit>
#include <cstring>
#include <string_view>
#include <type_traits>

#include "core/hash.hpp"
#include "visibility/visibility_identity.hpp"

namespace fluxel {

namespace {

static_assert(std::endian::native == std::endian::little, "the file is little endian");

/// To be raised with every change after which the same photons may go other ways.
constexpr std::uint64_t kFollowing = 2;

constexpr std::string_view kTallyMagic = "FLXTALLY";
constexpr std::uint32_t kTallyVersion = 1;

struct TallyHeader {
  std::array<char, 8> magic;
  std::uint32_t version, sequence;
  std::uint64_t identity, seed, photons, values, values_check;
  std::uint64_t check;  // of what stands before
};
static_assert(sizeof(TallyHeader) == 64);

std::uint64_t check_of(const TallyHeader& header) {
  return hash_bytes(std::as_bytes(std::span(&header, 1)).first(offsetof(TallyHeader, check)));
}

/// Of points that have none.
std::uint64_t seed_of(const PhotonPoints& points) {
  const bool has_seed = points.sequence == Sequence::random || points.sequence == Sequence::scrambled;
  return has_seed ? points.seed : 0;
}

}  // namespace

std::uint64_t photon_identity(const RayScene& ray_scene, const ElementView& mesh,
                              std::span<const Receiver> receivers) {
  std::uint64_t hash = visibility_identity(ray_scene, mesh.elements);
  const auto add = [&hash](const auto& item) {
    static_assert(std::is_trivially_copyable_v<std::remove_cvref_t<decltype(item)>>);
    hash = hash_bytes(std::as_bytes(std::span(&item, 1)), hash);
  };
  const auto add_list = [&hash](const auto& items) {
    hash = hash_bytes(std::as_bytes(std::span(items)), hash);
  };
  add(kFollowing);
  const Scene& scene = ray_scene.scene();
  for (const Patch& patch : scene.patches) {
    add_list(light_of(scene.material(patch)));
    add(patch.sides);
  }
  for (const Luminaire& luminaire : scene.luminaires) {
    for (const glm::dvec3& vector : {luminaire.position, luminaire.aim, luminaire.ahead, luminaire.scale})
      add(vector);
    add(luminaire.size);
    add(luminaire.round);
    const IntensityTable& table = scene.intensity(luminaire);
    for (const std::vector<double>& values : {table.C, table.gamma, table.intensity}) add_list(values);
  }
  for (const Receiver& receiver : receivers) {
    for (const glm::dvec3& vector : {receiver.origin, receiver.u, receiver.v}) add(vector);
    add(receiver.columns);
    add(receiver.rows);
    add_list(receiver.unmeasured);
  }
  return hash;
}

std::string tally_file(const TallyKey& key, const PhotonTally& tally) {
  const auto values = std::as_bytes(tally.values());
  TallyHeader header{{},
                     kTallyVersion,
                     static_cast<std::uint32_t>(key.points.sequence),
                     key.identity,
                     seed_of(key.points),
                     tally.count(PhotonCount::sent),
                     tally.values().size(),
                     hash_bytes(values),
                     0};
  kTallyMagic.copy(header.magic.data(), header.magic.size());
  header.check = check_of(header);
  std::string bytes(reinterpret_cast<const char*>(&header), sizeof header);
  bytes.append(reinterpret_cast<const char*>(values.data()), values.size());
  return bytes;
}

TallyFileResult read_tally_file(std::span<const std::byte> bytes, const TallyKey& key,
                                const TallyShape& shape) {
  TallyHeader header;
  if (bytes.size() < sizeof header) return {{}, "is too short to be a tally of photons"};
  std::memcpy(&header, bytes.data(), sizeof header);
  if (std::string_view(header.magic.data(), header.magic.size()) != kTallyMagic)
    return {{}, "is no tally of photons"};
  if (header.check != check_of(header)) return {{}, "is damaged or cut off"};
  if (header.version != kTallyVersion)
    return {{},
            fmt::format("is of another version of the format ({} where {} is needed)", header.version,
                        kTallyVersion)};
  if (header.sequence != static_cast<std::uint32_t>(key.points.sequence))
    return {{}, "is of another --sequence"};
  if (header.seed != seed_of(key.points)) return {{}, "is of another --seed"};
  if (header.identity != key.identity)
    return {{}, "is of another scene, other elements or receivers, or another version of the program"};
  const auto payload = bytes.subspan(sizeof header);
  if (header.values != PhotonTally::size_of(shape) || payload.size() != 8 * header.values ||
      hash_bytes(payload) != header.values_check)
    return {{}, "is damaged or cut off"};
  TallyFileResult result{PhotonTally(shape), {}};
  std::memcpy(result.tally->values().data(), payload.data(), payload.size());
  if (result.tally->count(PhotonCount::sent) != header.photons) return {{}, "is damaged or cut off"};
  return result;
}

}  // namespace fluxel
