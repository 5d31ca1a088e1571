#pragma once

#include <string>
#include <vector>

namespace fluxel::bench {

/// Errors over the known view factors: a Markdown table on the standard output, a line a case, and as CSV,
/// a line a case and tolerance, where `csv` names a file. A case that takes longer than `slow` [s] is not
/// measured at the tolerances that follow. `only`: the case of this id alone; throws InputError where there
/// is none.
void print_known_factors(const std::vector<double>& tolerances, double slow, const std::string& only,
                         const std::string& csv);

/// Time and row sums of a cube of side 1 in a cube of side 3, every square of both walls a group: a line a
/// tolerance, Markdown and CSV as above.
void print_nested_cubes(const std::vector<double>& tolerances, int divisions, const std::string& csv);

}  // namespace fluxel::bench
