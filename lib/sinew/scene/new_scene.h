// SPDX-License-Identifier: GPL-3.0-or-later
// A first scene for a mesh, with the bones and the clip of a rig or with bones of the mesh's own:
// every choice that a person would make first, and why.
//
//     const NewScene scene = new_scene({"part.stl", "", "part.yaml"});
//     write_file("part.yaml", scene.text);
#pragma once

#include <string>
#include <vector>

namespace sinew {

struct NewSceneFiles {
  std::string mesh;   ///< a path
  std::string rig;    ///< a path; "": the mesh's own, if it has one
  std::string scene;  ///< where the scene will be; paths in it are relative to its folder
};

struct NewScene {
  std::string text;                     ///< of the file, with comments
  std::string mesh, mesh_text;          ///< a file that it needs, beside it; "": none
  std::string unit, axes, bones, size;  ///< one line each: what was chosen, and why
};

/// A mesh whose triangles are too large to bend with the body is replaced by the same one in
/// smaller triangles. Reads and measures the files, and fills the mesh once. Throws bad input, with
/// the file, for what cannot be read or filled, and for a rig without a bone.
NewScene new_scene(const NewSceneFiles& files);

}  // namespace sinew
