#include "bench/simulate/traced_scene.hpp"

#include <fmt/format.h>

#include <cereal/archives/binary.hpp>
#include <cereal/types/string.hpp>
#include <cereal/types/vector.hpp>
#include <fstream>

#include "core/error.hpp"

namespace fluxel::bench {

void write_traced_scene(const std::string& file, const TracedScene& scene) {
  std::ofstream out(file, std::ios::binary);
  cereal::BinaryOutputArchive archive(out);
  archive(scene);
  if (!out.flush()) throw InputError(fmt::format("{} cannot be written", file));
}

TracedScene read_traced_scene(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  TracedScene scene;
  try {
    cereal::BinaryInputArchive archive(in);
    archive(scene);
  } catch (const cereal::Exception& error) {
    throw InputError(fmt::format("{} is no file of `simulate trace` ({})", file, error.what()));
  }
  scene.map.finish();
  return scene;
}

}  // namespace fluxel::bench
