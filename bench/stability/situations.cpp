#include <algorithm>
#include <iterator>

#include "bench/stability/situation_lists.hpp"

namespace fluxel::lab {

std::vector<Situation> situations() {
  std::vector<Situation> all;
  for (const auto& list : {
           contact_situations,
           reflectance_situations,
           occlusion_situations,
           camera_situations,
           sliver_situations,
           coincidence_situations,
           leak_situations,
           topology_situations,
       }) {
    std::vector<Situation> some = list();
    std::ranges::move(some, std::back_inserter(all));
  }
  return all;
}

}  // namespace fluxel::lab
