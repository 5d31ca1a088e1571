#include "sampling/sobol.hpp"

#include <boost/random/sobol.hpp>

namespace fluxel {

const SobolSequence::Directions& SobolSequence::directions() {
  static const Directions kDirections = [] {
    Directions table{};
    for (std::size_t digit = 0; digit < kDigits; ++digit) {
      // Boost's engine runs in the order of Gray's code and leaves out the origin: its point number
      // 2^(digit + 1) - 1 has this digit alone.
      boost::random::sobol engine(kDimensions);
      engine.seed((std::uint64_t{2} << digit) - 2);
      for (std::size_t dimension = 0; dimension < kDimensions; ++dimension)
        table[dimension][digit] = engine();
    }
    return table;
  }();
  return kDirections;
}

}  // namespace fluxel
