#pragma once

#include <array>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "formfactor/view_factor_table.hpp"
#include "scene/scene.hpp"

namespace fluxel {

/// A file of `fluxel viewfactors` that is written where it is asked for.
struct FaceFactorFile {
  std::string_view asked;  ///< name by which --write asks for it
  const char* name;
};

/// What surfaces the rows of the other files are; written with any of these.
inline constexpr const char* kFaceFile = "faces.csv";

inline constexpr std::array kFaceFactorFiles{FaceFactorFile{"mtx", "view-factors.mtx"},
                                             FaceFactorFile{"npy", "view-factors.npy"},
                                             FaceFactorFile{"faces-csv", "face-view-factors.csv"}};

/// Writes faces.csv and the files that are asked for into the folder, and removes those of an earlier run
/// that are not. Faces are numbered from 1, as Matrix Market does, in the order of the patches, fronts first;
/// a face without an area has no number. `faces`: between the sides of patches. Factors have ten digits in
/// texts. Returns the names of what was written. Throws InputError where something cannot be written.
[[nodiscard]] std::vector<std::string> write_face_factors(const std::filesystem::path& folder,
                                                          const Scene& scene, const ExchangeTable& faces,
                                                          std::span<const std::string> asked);

}  // namespace fluxel
