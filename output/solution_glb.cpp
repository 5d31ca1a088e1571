#include "output/solution_glb.hpp"

#include <cmath>
#include <string>

#include "core/version.hpp"
#include "output/elements/glb_writer.hpp"
#include "output/glb_parts.hpp"

namespace fluxel {

namespace {

void write_as(const std::filesystem::path& file, const OutputSource& source, GlbEncoding encoding) {
  const RunRecord& record = source.record;
  const bool z_up =
      record.options.camera && std::abs(record.options.camera->up.z) > std::abs(record.options.camera->up.y);
  write_glb(file, glb_parts(source), record.scene.origin,
            {z_up, encoding, "Fluxel " + std::string(version())});
}

}  // namespace

void write_solution_glb(const std::filesystem::path& file, const OutputSource& source) {
  write_as(file, source, GlbEncoding::full);
}

void write_quantised_glb(const std::filesystem::path& file, const OutputSource& source) {
  write_as(file, source, GlbEncoding::quantised);
}

}  // namespace fluxel
