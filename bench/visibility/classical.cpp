#include "bench/visibility/classical.hpp"

#include "bench/visibility/raw_packets.hpp"
#include "bench/visibility/scenes.hpp"
#include "bench/visibility/stopwatch.hpp"

namespace fluxel::bench {

double classical_seconds(const Scene& scene, const ElementMesh& mesh, std::size_t sample, int repetitions) {
  const Scene occluders = scene_of_elements(scene, mesh);
  const RawEmbree embree(occluders, true);
  const float lift = RayScene(scene, 1).surface_epsilon();
  const std::vector<TilePlace> all = upper_triangle(mesh.elements.size());
  const std::vector<TilePlace> places = sample_tiles(all, sample);
  TilePackets packets;
  std::uint64_t seen = 0;
  std::vector<double> seconds;
  for (int k = 0; k < repetitions; ++k)
    seconds.push_back(thread_seconds_of([&] {
      for (const TilePlace& place : places) {
        pack_tile(lift, mesh.elements, place, 1, packets);
        seen += embree.trace(packets, false);
      }
    }));
  return median(seconds) * static_cast<double>(all.size()) / static_cast<double>(places.size());
}

}  // namespace fluxel::bench
