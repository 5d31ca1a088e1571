#include "photons/receiver_crossings.hpp"

namespace fluxel {

ReceiverCrossings::ReceiverCrossings(std::span<const Receiver> receivers, std::size_t first_slot,
                                     double contact)
    : contact_(contact) {
  for (const Receiver& receiver : receivers) {
    const glm::dvec3 upright = glm::cross(receiver.u, receiver.v);
    const double squared = glm::dot(upright, upright);
    const auto columns = static_cast<double>(receiver.columns), rows = static_cast<double>(receiver.rows);
    planes_.push_back({receiver.origin, glm::normalize(upright),
                       columns / squared * glm::cross(receiver.v, upright),
                       rows / squared * glm::cross(upright, receiver.u), columns, rows,
                       static_cast<std::size_t>(receiver.columns), static_cast<std::size_t>(receiver.rows),
                       first_slot, &receiver});
    first_slot += receiver.size();
  }
}

}  // namespace fluxel
