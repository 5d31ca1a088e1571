#include "bench/stability/lab.hpp"

namespace fluxel::lab {

std::vector<Situation> situations() { return {}; }

}  // namespace fluxel::lab
