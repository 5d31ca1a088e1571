#pragma once

#include <functional>
#include <optional>
#include <string>

#include "core/error.hpp"
#include "core/units.hpp"
#include "scene/scene_input.hpp"

namespace fluxel {

/// Brings what files emit to the units of the scene: those that it states, else those of the first file that
/// states some.
class UnitMerger {
 public:
  /// `efficacy`: lumens of a watt, by which files of other units are converted; none: they are refused.
  /// `scene` outlives this.
  UnitMerger(SceneInput& scene, std::optional<double> efficacy) : scene_(scene), efficacy_(efficacy) {}

  using Fault = std::function<InputError(const std::string& what, const std::string& hint)>;

  /// What quantities of a file that has these units are to be multiplied by. `what` names the file in the
  /// error that `fault` makes where they may not be mixed.
  [[nodiscard]] double factor(Units units, const std::string& what, const Fault& fault);

  /// A geometry file's emission, in the scene's units.
  void convert(SceneInput& part, const Fault& fault);

 private:
  SceneInput& scene_;
  std::optional<double> efficacy_;
  std::string first_ = "the scene file";  ///< what has set the units
};

}  // namespace fluxel
