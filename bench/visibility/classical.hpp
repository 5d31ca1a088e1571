#pragma once

#include <cstddef>

#include "core/element.hpp"
#include "scene/scene.hpp"

namespace fluxel::bench {

/// Time of the visibility matrix where the elements themselves are the occluders and every pair that faces
/// each other is a ray (Debelov & Sattarov, Fig. 4, the dashed curve): the median over repetitions of a
/// sample of `sample` tiles, scaled up to the upper triangle [s]. Embree's hierarchy stands where the paper's
/// classical method tries all elements, so a ray costs about log N here and N there.
[[nodiscard]] double classical_seconds(const Scene& scene, const ElementMesh& mesh, std::size_t sample,
                                       int repetitions);

}  // namespace fluxel::bench
