#include "mpi_master/side_view_job.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

namespace fluxel {

std::vector<SideView> gather_side_views(const Communicator& communicator, const RayScene& ray_scene,
                                        const Scene& scene, const ElementMesh& mesh, bool two_sided,
                                        int threads) {
  const auto rank = static_cast<std::size_t>(communicator.rank());
  const auto ranks = static_cast<std::size_t>(communicator.size());
  const std::size_t first = mesh.elements.size() * rank / ranks;
  const std::size_t last = mesh.elements.size() * (rank + 1) / ranks;
  std::vector<SideView> front(last - first), back(last - first);
  tbb::task_arena arena(threads);
  arena.execute([&] {
    tbb::parallel_for(tbb::blocked_range(first, last, 64), [&](const tbb::blocked_range<std::size_t>& range) {
      const std::size_t from = range.begin() - first;
      side_views(ray_scene, scene, mesh, range.begin(), range.end(), std::span(front).subspan(from),
                 std::span(back).subspan(from));
    });
  });
  std::vector<SideView> views = communicator.all_gather(std::span<const SideView>(front));
  if (two_sided) {
    const std::vector<SideView> backs = communicator.all_gather(std::span<const SideView>(back));
    views.insert(views.end(), backs.begin(), backs.end());
  }
  return views;
}

}  // namespace fluxel
