# SPDX-License-Identifier: GPL-3.0-or-later
"""Damaged scenes, from a good one whose mesh is box.obj beside it."""
from damage import FOREIGN, NOT_FILES, replaced

SCENE = b"""body:
  mesh: box.obj
  radius: 0.03
skeleton:
  bones:
    - name: lower
      head: [0, 0, 0]
      tail: [0, 0, 0.34648]
    - name: upper
      parent: lower
      tail: [0, 0, 0.69296]
motion:
  tracks:
    - bone: upper
      keys:
        - time: 0
        - time: 0.2
          axis: [0, 1, 0]
          angle: 30
solver:
  duration: 0.2
"""

CHANGES = {
    # YAML
    "open_bracket": ("[0, 0, 0]", "[0, 0, 0"), "open_quote": ("box.obj", '"box.obj'), "tab": ("  radius", "\tradius"),
    "control": ("lower", "low\x07er"), "zero_byte": ("lower", "low\0er"), "not_utf8": ("lower", b"l\xf6wer"), "utf8_too_long": ("lower", b"\xc0\xaf"),
    "tag": ("0.03", "!!python/object:os.system 0.03"), "second_document": ("solver", "---\nsolver"), "bad_indent": ("  radius", " radius"),
    "merge": ("solver:\n", "solver:\n  <<: {duration: 1}\n"), "alias_of_nothing": ("0.03", "*radius"), "alias_of_itself": ("[0, 1, 0]", "&a [0, *a, 0]"),
    "key_list": ("solver:", "[a, b]: 1\nsolver:"), "key_empty": ("solver:", ": 1\nsolver:"), "key_twice": ("radius: 0.03", "radius: 0.03\n  radius: 0.03"),
    "section_twice": ("solver:", "body:\n  count: 7\nsolver:"), "key_unknown": ("radius", "raduis"), "section_unknown": ("solver", "sovler"),
    "key_elsewhere": ("solver:", "duration: 1\nsolver:"), "section_word": ("solver:\n  duration: 0.2", "solver: 7"), "section_list": ("  duration", "  - duration"),
    # values
    "radius_word": ("0.03", "thick"), "radius_unit": ("0.03", "30 mm"), "radius_comma": ("0.03", "0,03"), "radius_list": ("0.03", "[0.03]"),
    "radius_map": ("0.03", "{a: 1}"), "radius_none": ("0.03", ""), "radius_nan": ("0.03", ".nan"), "radius_infinite": ("0.03", ".inf"),
    "radius_too_large": ("0.03", "1e999"), "radius_zero": ("0.03", "0"), "radius_negative": ("0.03", "-0.03"), "radius_by_zero": ("0.03", "1/0"),
    "radius_tiny": ("0.03", "1e-9"), "radius_least": ("0.03", "5e-324"), "radius_wide": ("0.03", "1e300"), "radius_quoted": ("0.03", '"0.03"'),
    "count_huge": ("radius: 0.03", "count: 2000000000"), "count_beyond": ("radius: 0.03", "count: 99999999999"), "count_half": ("radius: 0.03", "count: 2.5"),
    "count_and_radius": ("0.03", "0.03\n  count: 9"), "no_radius": ("  radius: 0.03\n", ""), "no_mesh": ("  mesh: box.obj\n", ""),
    "no_skeleton": ("skeleton:", "#"), "no_tail": ("      tail: [0, 0, 0.34648]\n", ""), "no_name": ("name: lower", "head: [0, 0, 0]"),
    "vector_of_two": ("[0, 0, 0]", "[0, 0]"), "vector_of_words": ("[0, 0, 0]", "[a, b, c]"), "vector_nan": ("[0, 0, 0]", "[0, .nan, 0]"),
    "vector_number": ("[0, 0, 0]", "0"), "text_list": ("name: lower", "name: [lower]"), "text_empty": ("name: lower", 'name: ""'),
    "text_lines": ("name: lower", 'name: "lower\\nroot"'), "packing": ("radius", "packing: fc\n  radius"),
    # files
    "mesh_missing": ("box.obj", "none.obj"), "mesh_folder": ("box.obj", "."), "mesh_above": ("box.obj", "../../../../../../none/box.obj"),
    "mesh_device": ("box.obj", "/dev/zero"), "mesh_format": ("box.obj", "box.fbx"), "mesh_itself": ("box.obj", "file.yaml"),
    "mesh_shell": ("box.obj", "$(touch gone).obj"), "mesh_pipe": ("box.obj", "'|touch gone'"), "rig_missing": ("skeleton:\n", "skeleton:\n  file: none.yaml\n"),
    # what belongs together
    "parent_unknown": ("parent: lower", "parent: lowr"), "parent_itself": ("parent: lower", "parent: upper"), "name_twice": ("name: upper", "name: lower"),
    "bone_without_length": ("[0, 0, 0.69296]", "[0, 0, 0.34648]"), "track_of_nothing": ("bone: upper", "bone: thumb"), "keys_fall": ("time: 0.2", "time: -0.2"),
    "keys_twice": ("time: 0.2", "time: 0"), "no_time": ("time: 0.2", "twist: 1"), "axis_of_no_length": ("[0, 1, 0]", "[0, 0, 0]"),
    "duration_negative": ("duration: 0.2", "duration: -1"), "duration_endless": ("duration: 0.2", "duration: 1e300"), "interval": ("duration: 0.2", "duration: 0.2\noutput:\n  interval: 9"),
    "step_zero": ("duration: 0.2", "duration: 0.2\n  time_step: 0"), "step_tiny": ("duration: 0.2", "duration: 0.2\n  time_step: 1e-300"),
    "interval_tiny": ("duration: 0.2", "duration: 0.2\noutput:\n  interval: 1e-300"),
    "a_beyond_b": ("solver:", "material:\n  a: 2.7\nsolver:"), "density_nan": ("solver:", "material:\n  density: .nan\nsolver:"),
    "modulus_twice": ("solver:", "material:\n  young_modulus: 1\n  k1: 1\nsolver:"), "array_unknown": ("solver:", "output:\n  arrays: speeed\nsolver:"),
    "integrator": ("solver:\n", "solver:\n  integrator: euler\n"), "obstacle_of_no_shape": ("solver:", "world:\n  obstacles: [{name: a}]\nsolver:"),
    "obstacle_mesh": ("solver:", "world:\n  obstacles: [{name: a, shape: mesh, mesh: none.obj}]\nsolver:"),
    "preset": ("solver:", "material:\n  preset: stone\nsolver:"), "scale_zero": ("radius", "scale: 0\n  radius"), "up_along_forward": ("radius", "up: x\n  forward: -x\n  radius")}


def alias_bomb():
    lines = [b"a0: &a0 [x, x, x, x, x, x, x, x, x, x]"]
    lines += [b"a%d: &a%d [%s]" % (k, k, b", ".join([b"*a%d" % (k - 1)] * 10)) for k in range(1, 10)]
    return b"\n".join(lines) + b"\n"


def scene():
    files = FOREIGN | NOT_FILES
    del files["pipe"]  # a scene may come through one, and waits for it
    for name, (old, new) in CHANGES.items():
        files[name] = replaced(SCENE, old, new)
    files["alias_bomb"] = alias_bomb() + SCENE
    files["deep_lists"] = SCENE + b"world: " + b"[" * 100_000
    files["deep_maps"] = b"{a: " * 50_000 + b"}" * 50_000
    files["deep_blocks"] = b"".join(b" " * k + b"a:\n" for k in range(1500))
    files["deep_dashes"] = b"- " * 100_000
    files["many_values"] = SCENE + b"world: [" + b"1," * 150_000 + b"1]\n"
    files["many_bones"] = replaced(SCENE, b"motion:", b"".join(
        b"    - {name: b%d, parent: lower, tail: [0, 0, 1]}\n" % k for k in range(60_000)) + b"motion:")
    files["long_key"] = SCENE + b"x" * 100_000 + b": 1\n"
    files["long_name"] = replaced(SCENE, b"parent: lower", b"parent: " + b"x" * 1_000_000)
    files["long_scene"] = SCENE + b"# a comment\n" * 6_000_000
    return SCENE, files
