#include "sampling/owen_sobol.hpp"

#include <boost/random/sobol.hpp>

namespace fluxel {

const cuda::SobolDirections& sobol_directions() {
  static const cuda::SobolDirections kDirections = [] {
    cuda::SobolDirections table{};
    for (std::size_t byte = 0; byte < 4; ++byte) {
      auto& of_byte = table.digits[byte];
      for (std::size_t digit = 0; digit < 8; ++digit) {
        // Boost's engine runs in the order of Gray's code and leaves out the origin: its point number
        // 2^(digit + 1) - 1 has this digit alone.
        boost::random::sobol engine(OwenSobol::kAxes);
        engine.discard(OwenSobol::kAxes * ((std::uint64_t{2} << (8 * byte + digit)) - 2));
        for (std::uint32_t& axis : of_byte[std::size_t{1} << digit])
          axis = static_cast<std::uint32_t>(engine() >> 32);
      }
      for (std::size_t value = 1; value < 256; ++value) {
        const std::size_t lowest = value & (~value + 1);
        for (std::size_t axis = 0; value != lowest && axis < OwenSobol::kAxes; ++axis)
          of_byte[value][axis] = of_byte[value ^ lowest][axis] ^ of_byte[lowest][axis];
      }
    }
    return table;
  }();
  return kDirections;
}

std::array<double, OwenSobol::kAxes> OwenSobol::next() {
  double point[kAxes];
  numbers_.next(sobol_directions(), point);
  return {point[0], point[1], point[2], point[3]};
}

}  // namespace fluxel
