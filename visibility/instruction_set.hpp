#pragma once

#include <string>
#include <vector>

#include "core/choices.hpp"

namespace fluxel {

// All but name_of touch the choice that vector code looks at: to be called while no other thread computes.

/// Name of a set as the user says it: "auto", "sse4", "avx2", "avx512".
[[nodiscard]] const char* name_of(Isa isa);

/// The sets that this processor has, best first, without Isa::automatic.
[[nodiscard]] std::vector<Isa> supported_instruction_sets();

/// All vector code of the program, and Embree in ray scenes made afterwards, uses this set from now on;
/// `automatic`: the best that the processor has. Throws
/// InputError, leaving `automatic`, where the processor lacks the set.
void use_instruction_set(Isa isa);

/// Name of the set in use: as name_of, or Highway's name of a poorer or a foreign one.
[[nodiscard]] std::string instruction_set_in_use();

}  // namespace fluxel
