#pragma once

#include <cstddef>
#include <map>
#include <string>

#include "scene/scene.hpp"
#include "scene/scene_input.hpp"

namespace fluxel {

/// Faces that have a shape, but are too small beside the scene's extent to count.
class SmallFaces {
 public:
  void add(GroupId group, bool emits);

  /// Leaves a note of what they are, those that emit first, of the tolerance and where it comes from, and of
  /// what to do; none where there are none. `diagonal` is of the scene's box [m], `least_area` the tolerance.
  void report(const SceneInput& input, double diagonal, double least_area, Scene& scene) const;

 private:
  struct Count {
    std::size_t faces = 0, emitting = 0;
  };
  std::map<GroupId, Count> groups_;
};

/// `is metres_per_unit right?`, with what it is where a scene file sets it.
[[nodiscard]] std::string ask_for_unit(const SceneInput& input);

}  // namespace fluxel
