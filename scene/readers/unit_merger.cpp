#include "scene/readers/unit_merger.hpp"

#include <fmt/format.h>

namespace fluxel {

namespace {

const char* name_of(Units units) { return units == Units::photometric ? "photometric" : "radiometric"; }

}  // namespace

double UnitMerger::factor(Units units, const std::string& what, const Fault& fault) {
  if (!scene_.units) {
    scene_.units = units;
    first_ = what;
  }
  if (*scene_.units == units) return 1;
  if (!efficacy_)
    throw fault(
        fmt::format("{} is {}, and {} is {}", what, name_of(units), first_, name_of(*scene_.units)),
        fmt::format("luminous_efficacy = {:g} in the scene file converts by so many lm/W (white light)",
                    kLuminousEfficacy));
  scene_.notes.push_back(
      fmt::format("{}: converted to {} units by {:g} lm/W", what, name_of(*scene_.units), *efficacy_));
  return units == Units::radiometric ? *efficacy_ : 1 / *efficacy_;
}

void UnitMerger::convert(SceneInput& part, const Fault& fault) {
  if (!part.units) return;
  const double by = factor(*part.units, part.file.string(), fault);
  for (InputMaterial& material : part.materials) {
    material.Ke *= by;
    if (material.E) *material.E *= by;
  }
  for (Luminaire& luminaire : part.luminaires) luminaire.scale *= by;
}

}  // namespace fluxel
