#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "app/option_declarations.hpp"
#include "app/option_values.hpp"
#include "app/subcommands.hpp"
#include "core/option_names.hpp"
#include "output/face_factor_files.hpp"
#include "output/group_factor_files.hpp"

namespace fluxel {

void declare_viewfactors(CLI::App* viewfactors, ViewFactorOptions& of) {
  declare_scene_file(viewfactors, of.scene, of.metres_per_unit);
  viewfactors->add_option("--out", of.out, "folder for all output (default out)")->check(refuse_empty);
  add_parsed(
      viewfactors, "write",
      [&of](const std::string& t) {
        std::vector<std::string> known;
        known.reserve(kFaceFactorFiles.size() + 2);
        known.emplace_back(kTableAsked);
        known.emplace_back(kMatrixAsked);
        for (const FaceFactorFile& file : kFaceFactorFiles) known.emplace_back(file.asked);
        of.write = parse_names(t, known);
      },
      "factors between groups as csv (view-factors.csv, default for up to 500 groups) or npz "
      "(view-factors.npz: "
      "sparse matrix for SciPy, with surfaces.csv, default for more); and those between patches as mtx "
      "(view-factors.mtx: sparse matrix, Matrix Market), npy (view-factors.npy: the same for NumPy), "
      "faces-csv "
      "(face-view-factors.csv), each with faces.csv (areas); --keep-polygons has a patch for each polygon",
      "NAME,...")
      ->join(',');
  add_parsed(
      viewfactors, "tolerance", [&of](const std::string& t) { of.tolerance = parse_number(t); },
      "relative error of a factor, 1e-7 or more (default 1e-3); where something stands between, sqrt(1e-3 T)",
      "T");
  add_choice(viewfactors, "sides", of.sides, kSidesNames,
             "sides of a patch that see (default two, each with rows of its own)");
  declare_specular(viewfactors, of.specular, kSpecularNames, "refuse them");
  viewfactors->add_flag_callback(
      "--no-cut", [&of] { of.cut = false; }, "leave patches whole where others touch or cross them");
  viewfactors->add_flag_callback(
      "--keep-polygons", [&of] { of.merge = false; },
      "do not merge coplanar polygons of one material and group into larger ones; so it is with --no-cut");
  viewfactors->add_option("--threads", of.threads, "threads in a rank (default: its CPU set)")
      ->check(CLI::Range(1, 4096));
  viewfactors->add_flag("--quiet", of.quiet, "print warnings and errors only");
}

}  // namespace fluxel
