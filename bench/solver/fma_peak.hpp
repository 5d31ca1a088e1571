#pragma once

namespace fluxel::bench {

/// Fused multiply-adds in single precision a second, counted lane by lane, that one thread reaches in twelve
/// independent chains with the instruction set in use (a multiplication and a sum where that has no fused
/// ones). Processor time.
[[nodiscard]] double fma_peak();

}  // namespace fluxel::bench
