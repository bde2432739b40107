// SPDX-License-Identifier: GPL-3.0-or-later
// Writes a new scene, and beside it the mesh that it needs: of a shape, of a rig alone, of polygons
// that are in no file.
//
//     const WrittenScene written = write_new_scene({.mesh = "part.stl"});
#pragma once

#include <optional>
#include <string>

#include <sinew/core/triangles.h>
#include <sinew/scene/new/new_scene.h>

namespace sinew {

struct NewSceneWish {
  std::string mesh;        ///< a path, or the name of `polygons`; of a rig alone, which gets a skin
  std::string rig = {};    ///< a path; "": the mesh's own, if it has one, or bones along limbs
  std::string scene = {};  ///< a path; "": NAME-OF-MESH.yaml in the current directory
  std::optional<Triangles> body = {};  ///< in place of a mesh: a shape, called `mesh`
  bool force = false;                  ///< replace older files
  std::optional<PolygonSoup> polygons = {};
};

struct WrittenScene {
  std::string path;
  std::string mesh;  ///< a file beside it that was written too; "": none
  NewScene scene;
};

/// Throws bad input as new_scene() does, and for files that are there already; not written.
WrittenScene write_new_scene(const NewSceneWish& wish);

}  // namespace sinew
