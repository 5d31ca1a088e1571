#include "scene/readers/optics_keys.hpp"

#include <array>
#include <utility>

namespace fluxel {

namespace {

constexpr double kMostRefraction = 10;

using Share = std::pair<const char*, Rgb SurfaceOptics::*>;
constexpr std::array kShares{Share{"mirror", &SurfaceOptics::mirror},
                             Share{"transmission", &SurfaceOptics::transmission},
                             Share{"diffuse_transmission", &SurfaceOptics::diffuse_transmission}};

void read_refraction(const TomlFile& toml, const toml::table& table, const toml::node& node,
                     const std::string& where, InputMaterial& material) {
  const double index = toml.number(node, where + " refraction_index");
  if (!(index >= 1 && index <= kMostRefraction))
    throw toml.error(node.source(), fmt::format("{} refraction_index is {:g}", where, index),
                     fmt::format("from 1 to {:g}, as 1.5 for glass", kMostRefraction));
  for (const auto& [key, value] : table)
    if (key.str() != "refraction_index")
      throw toml.error(key.source(), fmt::format("{} has {} beside refraction_index", where, key.str()),
                       "a clear body reflects and refracts by its index alone: leave the rest out");
  if (material.Ke != Rgb(0))
    throw toml.error(node.source(), where + " emits by its file's Ke, and has a refraction_index",
                     "the surface of a clear body emits nothing");
  material.optics.refraction_index = index;
  material.rho = Rgb(0);
}

}  // namespace

void read_optics(const TomlFile& toml, const toml::table& table, const std::string& where,
                 InputMaterial& material) {
  const toml::node* last = nullptr;
  Rgb sum(0);
  for (const auto& [key, share] : kShares) {
    const toml::node* const value = table.get(key);
    if (value == nullptr) continue;
    last = value;
    const Rgb colour = toml.colour(*value, where + " " + key);
    for (int c = 0; c < kChannels; ++c)
      if (!(colour[c] >= 0 && colour[c] <= 1))
        throw toml.error(value->source(), fmt::format("{} {}: share outside 0..1", where, key));
    material.optics.*share = colour;
    sum += colour;
  }
  const toml::node* const index = table.get("refraction_index");
  if (index != nullptr) read_refraction(toml, table, *index, where, material);
  if (last == nullptr && index == nullptr) return;
  material.optics_line = (last != nullptr ? last : index)->source().begin.line;
  if (last == nullptr) return;
  if (material.textured && !table.contains("rho"))
    throw toml.error(last->source(), where + " has a texture of its own reflectance beside other shares",
                     "give its rho too, which then takes the texture's place");
  for (int c = 0; c < kChannels; ++c)
    if (const double all = material.rho[c] + sum[c]; all > 1 + kSharesRounding)
      throw toml.error(
          last->source(),
          fmt::format("{}: rho, mirror, transmission and diffuse_transmission add up to {:g}", where, all),
          fmt::format("at most 1 of what arrives; rho is {:g}{}", material.rho[c],
                      table.contains("rho") ? "" : " by the geometry's file"));
}

}  // namespace fluxel
