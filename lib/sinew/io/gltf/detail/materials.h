// SPDX-License-Identifier: GPL-3.0-or-later
// The materials of a glTF file with their textures and images.
//
//     const GltfMaterials materials = gltf_materials("fox.glb", gltf);
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include <sinew/core/surface_look.h>
#include <sinew/io/gltf/checks.h>

namespace sinew {

/// Returns materials as in the file, with the bytes of images from its buffers, from data URIs and
/// from files in its folder or below; other images keep their URIs. Throws bad input, with the
/// path, where the file cannot be read.
GltfMaterials gltf_materials(const std::filesystem::path& path, const CheckedGltf& gltf);

/// The type of an image that glTF allows, as "image/png", by its first bytes; null for others.
const char* gltf_image_type(std::string_view bytes);

/// Adds a material of another format, with its texture where that can be read; returns its number.
int add_material(GltfMaterials& materials, const SurfaceLook::Material& material);

/// Their names, "material_3" for those without.
std::vector<std::string> names_of(const GltfMaterials& materials);

}  // namespace sinew
