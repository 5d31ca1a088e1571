#pragma once

#include <stdexcept>

namespace fluxel {

/// The user's input cannot be used: the message says what, where and what to do. The program exits with 2.
class InputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace fluxel
