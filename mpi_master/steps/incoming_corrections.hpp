#pragma once

#include <cstddef>
#include <span>
#include <utility>

#include "formfactor/corrections.hpp"
#include "mpi_master/communication/machine.hpp"

namespace fluxel {

/// The corrections of a rank's rows as they are found, for as long as there is room for them: rather a
/// sentence now than a kill later.
class IncomingCorrections {
 public:
  explicit IncomingCorrections(AvailableBytes available) : available_(std::move(available)) {}

  void add(std::span<const CorrectionEntry> entries) { entries_.add(entries); }
  [[nodiscard]] std::size_t size() const { return entries_.size(); }

  /// Whether more may be added, and all be compressed. The system is asked only when half of what it had last
  /// may have been taken.
  [[nodiscard]] bool has_room();

  /// Nothing is left here.
  [[nodiscard]] Corrections compressed(std::size_t unknowns) {
    return compress(std::exchange(entries_, {}), unknowns);
  }

 private:
  AvailableBytes available_;
  CorrectionList entries_;
  std::size_t ask_at_ = 0;  // entries
};

}  // namespace fluxel
