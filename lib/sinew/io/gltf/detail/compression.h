// SPDX-License-Identifier: GPL-3.0-or-later
// Meshes and animations that a glTF file holds compressed: EXT_meshopt_compression, by
// meshoptimizer, and KHR_draco_mesh_compression, by Draco; each where its library is installed.
//
//     unpack_gltf(gltf);  // accessors and views as if nothing had been compressed
#pragma once

#include <array>
#include <string_view>

#include <sinew/io/gltf/checks.h>

namespace sinew {

/// Extensions that this build unpacks; "" for those that it does not.
extern const std::array<std::string_view, 2> gltf_codecs;

/// Unpacks views, and surfaces whose accessors have no data of their own, behind the end of the
/// bytes. Sizes are checked before anything is allocated: against the counts of accessors, 2 GiB,
/// and what so many compressed bytes can hold. Throws bad input (without the path).
void unpack_gltf(CheckedGltf& gltf);

}  // namespace sinew
