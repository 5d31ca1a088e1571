#include "mpi_master/steps/side_view_job.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <vector>

#include "mpi_master/communication/host_gather.hpp"

namespace fluxel {

SharedArray<SideView> gather_side_views(const Communicator& communicator, const RayScene& ray_scene,
                                        const Scene& scene, const ElementView& mesh, bool two_sided,
                                        int threads) {
  const auto rank = static_cast<std::size_t>(communicator.rank());
  const auto ranks = static_cast<std::size_t>(communicator.size());
  const std::size_t first = mesh.elements.size() * rank / ranks;
  const std::size_t last = mesh.elements.size() * (rank + 1) / ranks;
  const std::size_t count = last - first;
  std::vector<SideView> views(2 * count);
  const std::span<SideView> front = std::span(views).first(count), back = std::span(views).last(count);
  tbb::task_arena arena(threads);
  arena.execute([&] {
    tbb::parallel_for(tbb::blocked_range(first, last, 64), [&](const tbb::blocked_range<std::size_t>& range) {
      const std::size_t from = range.begin() - first;
      side_views(ray_scene, scene, mesh, range.begin(), range.end(),
                 {front.subspan(from), back.subspan(from)});
    });
  });
  const std::size_t sides = two_sided ? 2 : 1;
  return gather_on_hosts(communicator, std::span<const SideView>(views).first(sides * count), sides);
}

std::vector<SideView> views_of_sides(const Communicator& communicator, const RayScene& ray_scene,
                                     const Scene& scene, const ElementView& mesh,
                                     std::span<const std::uint32_t> sides, int threads) {
  const auto rank = static_cast<std::size_t>(communicator.rank());
  const auto ranks = static_cast<std::size_t>(communicator.size());
  const std::size_t first = sides.size() * rank / ranks, last = sides.size() * (rank + 1) / ranks;
  std::vector<SideView> own(last - first);
  tbb::task_arena arena(threads);
  arena.execute([&] {
    tbb::parallel_for(first, last, [&](std::size_t k) {
      const std::size_t element = sides[k] % mesh.elements.size();
      own[k - first] = side_view(ray_scene, scene, mesh, element, sides[k] < mesh.elements.size());
    });
  });
  return communicator.all_gather(std::span<const SideView>(own));
}

}  // namespace fluxel
