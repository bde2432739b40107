// SPDX-License-Identifier: GPL-3.0-or-later
// A first scene for a mesh, with the bones and the clip of a rig or with bones of the mesh's own:
// every choice that a person would make first, and why.
//
//     const NewScene scene = new_scene({"part.stl", "", "part.yaml"});
//     write_file("part.yaml", scene.text);
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <sinew/body/body.h>
#include <sinew/core/triangles.h>
#include <sinew/core/vector.h>
#include <sinew/mesh/surface.h>
#include <sinew/settings/settings.h>

namespace sinew {

/// A body for a rig alone, m, z up, and how the rig comes into it.
struct RigBody {
  Triangles skin;
  SkeletonOptions skeleton;      ///< with `rest_at` where the skin is that of a pose of the clip
  std::string unit, axes, pose;  ///< why; `pose` is "" where the rig's own rest pose serves
};

/// A figure (figure.h) in one skin. Up is where its head is, over its feet, and it is as tall as a
/// human in the unit that comes nearest. Other rigs: y is up, and those longer than 20 are in cm.
/// Throws bad input, with the path.
RigBody body_of_rig(const std::string& path);

struct NewSceneFiles {
  std::string mesh;                 ///< a path
  std::string rig;                  ///< a path; "": the mesh's own, if it has one
  std::string scene;                ///< where it will be; paths in it are relative to its folder
  const RigBody* figure = nullptr;  ///< the mesh is its skin
  std::optional<Axis> up = {};      ///< up of the mesh; none: guessed
  bool quick = false;               ///< runs in ten seconds or so, however coarse
  std::string clip = {};            ///< a clip by its name; "": a walk, or the first that moves
  std::optional<int> count = {};    ///< particles; none: as many as a run may take
  std::optional<double> duration = {};  ///< s; none: the clip, up to 3 s
};

struct NewScene {
  std::string text;             ///< text of the file, with comments
  std::string mesh, mesh_text;  ///< a file that it needs, beside it; "": none
  std::vector<std::pair<std::string, std::string>> parts = {};  ///< others: path and text
  std::string unit, axes, bones, size;  ///< one line each: what was chosen, and why
  std::string pose;                     ///< why the rest pose is one of the clip; "": it is not
  std::string holes;                    ///< holes that are closed; "": none
  std::string materials;                ///< materials of the mesh's cells; "": one
  std::string warning;                  ///< warning of the mesh's reader; "": none
  std::string time;                     ///< foreseen for a run on this machine; "": not known
};

/// A mesh whose triangles are too large to bend with the body is replaced by the same one in
/// smaller triangles. Reads and measures the files, and fills the mesh a few times. Throws bad
/// input, with the file, for what cannot be read or filled, and for a rig without a bone.
NewScene new_scene(const NewSceneFiles& files);

// A new scene is written with the mesh that it needs: of a shape, of a rig alone, of polygons that
// are in no file.

struct NewSceneWish {
  std::string mesh;        ///< a path, or the name of `polygons`; of a rig alone, which gets a skin
  std::string rig = {};    ///< a path; "": the mesh's own, if it has one, or bones along limbs
  std::string scene = {};  ///< a path; "": NAME-OF-MESH.yaml in the current directory
  std::optional<Triangles> body = {};  ///< in place of a mesh: a shape, called `mesh`
  bool force = false;                  ///< replace older files
  std::optional<PolygonSoup> polygons = {};
  std::optional<Axis> up = {};  ///< up of the mesh; none: guessed
  bool quick = false;           ///< runs in ten seconds or so, however coarse
  std::string clip = {};        ///< clip, count and duration as in NewSceneFiles
  std::optional<int> count = {};
  std::optional<double> duration = {};
};

struct WrittenScene {
  std::string path;
  std::string mesh;  ///< a file beside it that was written too; "": none
  NewScene scene;
};

/// Throws bad input as new_scene() does, and for files that are there already; not written.
WrittenScene write_new_scene(const NewSceneWish& wish);

// What files of meshes do not say: the unit of their lengths, and where up is.

struct UnitGuess {
  LengthUnit unit = LengthUnit::m;
  std::string why;
};

/// Guesses by the format and the longest side of the box, as the file has it.
UnitGuess guess_unit(const std::filesystem::path& mesh, double longest);

struct UpGuess {
  Axis up = Axis::z;
  std::string why;
};

/// Guesses by the format, and by the axis along which the body stands: on 0, or else on its lowest
/// points (m, as the file has them).
UpGuess guess_up(const std::filesystem::path& mesh, const Points& points);

// What a new scene is made of, before it is text.

/// Time of the scene after the motion, s.
inline constexpr double rest_after = 0.2;

struct NewChoices {
  Settings settings;                    ///< paths relative to the current directory
  std::string unit, axes, bones, size;  ///< why; see NewScene
  std::string pose = {};                ///< why the rest pose is not the rig's own; "": it is
  std::size_t particles = 0;
  Box box;                              ///< box of the body, m
  double thickness = 0;                 ///< thickness of its limbs, m
  std::vector<std::string> clips = {};  ///< others than the one that plays
  std::string clip_note = {};           ///< about that one
  bool begins_posed = false;            ///< it begins far from rest
  bool hollow = false;                  ///< a shell, whose bones lie outside of it
  std::string holes = {};               ///< holes that are closed; "": none
  std::string materials = {};           ///< materials of the mesh's cells; "": one
  std::string changed = {};             ///< what the written mesh is; "": the given one
  bool quick = false;                   ///< runs in ten seconds or so, however coarse
  std::string clip = {};                ///< asked for; "": any
  std::optional<int> count = {};        ///< particles asked for
  std::optional<double> duration = {};  ///< asked for, s
  std::string time = {};                ///< foreseen for a run on this machine; "": not known
};

/// The scene, as a file in `folder`.
std::string new_scene_text(const NewChoices& choices, const std::filesystem::path& folder);

// A rig comes into a scene with axes and scale, so that its bones lie in the mesh, and with a clip.

/// The mesh's own path if it holds a rig as well, else "".
std::string rig_within(const std::string& mesh);

/// Sets skeleton, motion, binding and duration. Of the axes that files usually have, and of the
/// scales by which units differ, those count with which most of the bones lies inside the mesh;
/// the mesh may be turned as well: returns its surface. Throws bad input, with the path.
Surface use_rig(const std::string& rig, Surface surface, NewChoices& choices);

/// The same for the skin of a rig alone, which lies where the rig does.
void use_rig(const RigBody& figure, const Surface& surface, NewChoices& choices);

// A motion that shows the joints of a rig without a clip.

/// The joints, at most twelve, on both sides of which there is flesh; of more those whose bones
/// hold the most particles. Ascending.
std::vector<int> joints_that_skin_follows(const Body& body);

/// Bends them one after the other, as they are bent at rest or where the limb has room, and back.
/// Leaves the motion as it is where there are none.
void bend_joints(const Body& body, NewChoices& choices);

}  // namespace sinew
