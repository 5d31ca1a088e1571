#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

#include "output/json_parts.hpp"
#include "output/output_table.hpp"

namespace fluxel {

/// What report.json says.
[[nodiscard]] Json report_json(const OutputSource& source);

/// Writes report.json, with what was in force and nothing else; throws InputError where it cannot.
void write_report(const std::filesystem::path& file, const OutputSource& source);

/// Name of the solver, as the command line takes it; across ranks Gauss-Seidel's method is another.
[[nodiscard]] std::string solver_text(Solver solver, std::size_t ranks);

}  // namespace fluxel
