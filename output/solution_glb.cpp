#include "output/solution_glb.hpp"

#include "output/elements/glb_writer.hpp"
#include "output/glb_parts.hpp"

namespace fluxel {

namespace {

void write_as(const std::filesystem::path& file, const OutputSource& source, GlbEncoding encoding) {
  write_glb(file, glb_parts(source), encoding, glb_scene(source.record));
}

}  // namespace

void write_solution_glb(const std::filesystem::path& file, const OutputSource& source) {
  write_as(file, source, GlbEncoding::full);
}

void write_quantised_glb(const std::filesystem::path& file, const OutputSource& source) {
  write_as(file, source, GlbEncoding::quantised);
}

}  // namespace fluxel
