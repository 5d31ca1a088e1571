#pragma once

#include <filesystem>

#include "scene/patch_mesh.hpp"
#include "scene/scene.hpp"
#include "scene/scene_input.hpp"

namespace fluxel {

/// Throws InputError, with file and line, of a material in use that is not diffuse.
void refuse_specular(const InputMaterial& material, const std::filesystem::path& file);

/// Throws InputError where a surface with an index of refraction does not bound a clear body: it has an edge
/// of its own, its normals do not point outwards, or it lies within another clear body. Needs the mesh of the
/// patches.
void require_clear_bodies(const Scene& scene, const PatchMesh& mesh, const SceneInput& input);

}  // namespace fluxel
