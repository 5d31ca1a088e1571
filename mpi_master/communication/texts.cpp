#include "mpi_master/communication/texts.hpp"

#include <span>
#include <utility>

namespace fluxel {

std::vector<std::string> texts_of_all(const Communicator& communicator,
                                      const std::vector<std::string>& mine) {
  std::string joined;
  for (const std::string& text : mine) joined += text + '\0';
  std::vector<std::string> texts;
  std::string text;
  for (const char c : communicator.all_gather(std::span<const char>(joined))) {
    if (c != '\0') {
      text += c;
    } else {
      texts.push_back(std::exchange(text, {}));
    }
  }
  return texts;
}

}  // namespace fluxel
