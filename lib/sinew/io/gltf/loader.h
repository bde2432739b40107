// SPDX-License-Identifier: GPL-3.0-or-later
// VTK's glTF loader, fed with nothing but what the guard let through.
#pragma once

#include <memory>

#include <sinew/io/gltf/guard.h>

class vtkGLTFDocumentLoader;

namespace sinew {

/// The loaded document with its geometry built and the default scene's global transforms known.
/// Nodes, meshes and primitives have the indices they have in `gltf`; only surfaces have geometry.
/// Throws bad input when VTK refuses, not written when there is no room for a temporary file.
std::shared_ptr<vtkGLTFDocumentLoader> loaded_gltf(const GuardedGltf& gltf);

}  // namespace sinew
