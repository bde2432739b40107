// SPDX-License-Identifier: GPL-3.0-or-later
// The script with which Blender (3.4 and later) writes a file of another format as GLB. Arguments:
// the file, the GLB, a file for the reason of a failure.
#pragma once

namespace sinew {

// Takes become tracks of their objects, which the exporter joins by name. Blender names an action
// OBJECT|TAKE|LAYER, and where it was its own exporter, OBJECT|OBJECT|TAKE|LAYER. Of COLLADA, 600
// frames per second hold the keys of all usual rates. The exporter of 3.4 fails where an action
// begins between frames. Hidden meshes are left out, unless all are.
inline constexpr const char* blender_script = R"(import bpy, sys

source, target, reason = sys.argv[sys.argv.index("--") + 1:]


def call(operator, **wanted):
    known = operator.get_rna_type().properties.keys()
    return operator(**{name: value for name, value in wanted.items() if name in known})


def read():
    scene = bpy.context.scene
    for thing in list(bpy.data.objects):
        bpy.data.objects.remove(thing)
    if source.endswith(".fbx"):
        call(bpy.ops.import_scene.fbx, filepath=source, anim_offset=0.0, use_custom_normals=False,
             use_image_search=False, use_custom_props=False)
    else:
        scene.render.fps = 600
        if not hasattr(bpy.ops.wm, "collada_import"):
            raise RuntimeError("this version of Blender reads no COLLADA")
        call(bpy.ops.wm.collada_import, filepath=source)
    scene.render.fps_base = 1
    meshes = [thing for thing in bpy.data.objects if thing.type == "MESH"]
    hidden = [thing for thing in meshes if thing.hide_viewport or thing.hide_get()]
    for thing in hidden if len(hidden) < len(meshes) else []:
        bpy.data.objects.remove(thing)
    if not bpy.data.objects:
        raise RuntimeError("it holds no objects")


def take_of(action, thing):
    rest = action.name[len(thing.name) + 1:]
    rest = rest[len(thing.name) + 1:] if rest.startswith(thing.name + "|") else rest
    return rest.rsplit("|", 1)[0] or action.name


def takes():
    found = {}
    things = [thing for thing in bpy.data.objects if thing.animation_data]
    for action in bpy.data.actions:
        users = [thing for thing in things if action.name.startswith(thing.name + "|")]
        if users:
            thing = max(users, key=lambda one: len(one.name))
            found.setdefault((thing.name, take_of(action, thing)), (thing, action))
    for thing in things:
        if thing.animation_data.action and not any(one == thing for one, _ in found.values()):
            found[thing.name, "Take"] = thing, thing.animation_data.action
    return found


def snap(action):
    first, last = action.frame_range
    for curve in action.fcurves:
        for key in curve.keyframe_points:
            if abs(key.co[0] - round(key.co[0])) < 0.02 or key.co[0] in (first, last):
                key.co[0] = round(key.co[0])


def add_tracks():
    for action in bpy.data.actions:
        snap(action)
    found = takes()
    for (_, name), (thing, action) in found.items():
        track = thing.animation_data.nla_tracks.new()
        track.name = name
        track.strips.new(name, int(action.frame_range[0]), action)
    for thing, _ in found.values():
        thing.animation_data.action = None


def frame_step():
    if bpy.context.scene.render.fps != 600:
        return 1
    keys = [key.co[0] for action in bpy.data.actions for curve in action.fcurves
            for key in curve.keyframe_points]
    fits = [step for step in (25, 24, 20, 10, 5) if all(abs(key / step - round(key / step)) < 0.02 for key in keys)]
    return fits[0] if fits else 10


def write():
    call(bpy.ops.export_scene.gltf, filepath=target, export_format="GLB", check_existing=False,
         export_image_format="NONE", export_all_influences=True, export_morph_normal=False,
         export_animation_mode="NLA_TRACKS", export_nla_strips=True, export_frame_range=False,
         export_frame_step=frame_step(), export_anim_single_armature=False)


try:
    import numpy
    read()
    add_tracks()
    write()
except BaseException as error:
    lines = [line for line in str(error).splitlines() if line.strip() and not line.startswith("Location:")]
    said = (lines[-1] if "Traceback" in str(error) else lines[0]) if lines else type(error).__name__
    with open(reason, "w", errors="replace") as file:
        file.write(said.replace("Error: ", "").replace(repr(source), "").strip())
    raise
)";

}  // namespace sinew
