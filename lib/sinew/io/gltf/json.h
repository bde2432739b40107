// SPDX-License-Identifier: GPL-3.0-or-later
// A glTF file's JSON, from and to values.
#pragma once

#include <string>
#include <string_view>

#include <sinew/io/gltf/document.h>

namespace sinew {

/// Checks the form of each field it takes (type, length, range), not what indices point at. Throws
/// bad input (without the path) that names the field.
GltfDocument gltf_document(std::string_view json);

/// The surfaces of a document whose buffers lie in one of `bytes` bytes, for a reader that believes
/// everything. Indices stay what they were; skins and animations are left out.
std::string gltf_json(const GltfDocument& document, std::int64_t bytes);

}  // namespace sinew
