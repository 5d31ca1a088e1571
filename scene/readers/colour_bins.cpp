#include "scene/readers/colour_bins.hpp"

#include <fmt/format.h>

#include "core/srgb.hpp"

namespace fluxel {

MaterialId ColourBins::add(const Rgb& rho) {
  std::uint32_t srgb = 0;
  for (int c = 0; c < kChannels; ++c) srgb = srgb << 8 | encode_srgb(rho[c]);
  const auto [entry, added] = ids_.try_emplace(srgb, MaterialId{static_cast<std::uint32_t>(bins_.size())});
  if (added) bins_.push_back({srgb, Rgb(0), 0});
  Bin& bin = bins_[index(entry->second)];
  bin.sum += rho;
  ++bin.faces;
  return entry->second;
}

std::vector<InputMaterial> ColourBins::materials() const {
  std::vector<InputMaterial> materials;
  materials.reserve(bins_.size());
  for (const Bin& bin : bins_) {
    InputMaterial& material = materials.emplace_back();
    material.name = fmt::format("colour {} {} {}", bin.srgb >> 16, bin.srgb >> 8 & 0xff, bin.srgb & 0xff);
    material.rho = bin.sum / bin.faces;
  }
  return materials;
}

}  // namespace fluxel
