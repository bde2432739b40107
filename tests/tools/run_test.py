#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Whole commands on small scenes: what they leave behind, and how they end.

usage: run_test.py BIN SOURCE      folder of the programs, folder of the project
"""
import csv
import html
import json
import os
import pty
import re
import struct
import sys
import unittest

import meshio
import numpy

from small_run import BIN, HAS_GROUPS, SERIES, SOURCE, SmallRun, sinew


def on_a_terminal(words, variables):
    """What a terminal shows of a command."""
    pid, terminal = pty.fork()
    if pid == 0:
        kept = {key: value for key, value in os.environ.items() if key not in ("NO_COLOR", "TERM")}
        os.execve(words[0], [str(word) for word in words], kept | variables)
    shown = b""
    while True:
        try:
            part = os.read(terminal, 4096)
        except OSError:  # the end of a terminal
            break
        if not part:
            break
        shown += part
    os.waitpid(pid, 0)
    os.close(terminal)
    return shown.decode()


class Commands(SmallRun):
    def test_run_leaves_everything_behind(self):
        sinew("run", self.scene, "-o", self.out, "--no-movie", check=0)
        for name in ["scene.yaml", "run.json", "log.txt", "body.vtu", "metrics.csv", "metrics.json",
                     "report.html", "view.pvsm", "pictures/contact_sheet.png"]:
            self.assertGreater((self.out / name).stat().st_size, 0, name)
        for name in SERIES:
            self.assertEqual(len(list((self.out / name).glob("*.vtu"))), 13, name)
        record = self.record()
        self.assertEqual(record["schema_version"], 1)
        self.assertEqual(list(record["series"])[:4], SERIES)
        self.assertEqual(record["series"]["skin_lbs"]["asked_by"], "output.skin_lbs")
        rows = list(csv.DictReader((self.out / "metrics.csv").open()))
        self.assertEqual(len(rows), 13)
        self.assertEqual(list(rows[0])[0], "time")
        record = self.record()
        for key in ["version", "command", "host", "particles", "steps", "frames", "time_step",
                    "particle_steps_per_second", "seconds", "state_hash", "arrays", "instruction_set"]:
            self.assertIn(key, record)
        self.assertEqual((record["precision"], record["neighbor_search"]), ("double", "lists"))
        self.assertGreaterEqual(record["lists"]["pieces_listed"], record["lists"]["rebuilds"])
        self.assertGreater(record["lists"]["rebuilds"], 0)
        self.assertEqual(record["status"], "finished")
        self.assertEqual(record["frames"], 13)
        self.assertEqual(list(self.folder.rglob("*.tmp")), [])

    def test_one_strain_has_one_range_in_pictures_page_and_paraview(self):
        self.check_range()

    def test_one_strain_has_one_range_where_every_second_frame_is_written(self):
        self.check_range("--set", "output.every=2")

    def check_range(self, *words):
        """The 0.5th and 99.5th percentile of all frames, as NumPy finds them."""
        sinew("run", self.scene, "-o", self.out, "--no-movie", *words, check=0)
        all_strains = numpy.concatenate([meshio.read(frame).point_data["strain_eq"]
                                         for frame in sorted((self.out / "particles").glob("*.vtu"))])
        low, high = self.record()["ranges"]["strain_eq"]
        wanted = numpy.percentile(all_strains, [0.5, 99.5])
        self.assertAlmostEqual(high / wanted[1], 1, delta=5e-3)
        self.assertEqual(low, 0 if wanted[0] < high / 2 else low)
        for views in ("cut,halves,section", "strain"):
            told = json.loads(sinew("render", self.out, "--view", views, "--times", "0.2", "--no-movie", "--json", check=0).stdout)
            self.assertEqual(told["ranges"]["strain_eq"], [low, high])
        playback = json.loads(re.search(r'id="playback">(.*?)</script>', (self.out / "report.html").read_text(), re.S)[1])
        strain = next(field for field in playback["fields"] if field["name"] == "strain")
        self.assertEqual((strain["low"], strain["high"]), (low, high))
        points = re.search(r'name="RGBPoints".*?</Property>', (self.out / "view.pvsm").read_text(), re.S)[0]
        values = [float(value) for value in re.findall(r'value="([^"]*)"', points)][::4]
        self.assertAlmostEqual(values[0], low, delta=1e-6)
        self.assertAlmostEqual(values[-1] / high, 1, delta=1e-6)
        sinew("measure", self.out, check=0)
        self.assertEqual(self.record()["ranges"]["strain_eq"], [low, high])

    def test_a_run_that_begins_in_a_pose_says_what_relaxing_took(self):
        pose = "- time: 0\n          axis: [0, 1, 0]\n          angle: 40\n"
        self.scene.write_text(self.scene.read_text().replace("- time: 0\n", pose, 1))
        self.simulate("--set", "motion.begin=rest")
        self.assertNotIn("relaxing", self.record()["seconds"])
        self.simulate("--force", "--set", "motion.begin=pose")
        self.assertGreater(self.record()["seconds"]["relaxing"], 0)

    def test_bones_csv_has_a_row_per_bone_and_frame(self):
        self.simulate()
        rows = list(csv.DictReader((self.out / "bones.csv").open()))
        self.assertEqual([row["bone"] for row in rows], 13 * ["lower", "upper"])
        values = [f"{what}_{axis}" for what in ("force", "moment") for axis in "xyz"] + ["power"]
        self.assertEqual(list(rows[0]), ["time", "bone"] + [part + value for part in ("", "spring_", "pin_", "obstacle_")
                                                            for value in values])
        for row in rows:  # nothing is pinned here
            self.assertEqual([row[value] for value in values], [row["spring_" + value] for value in values])
        self.assertEqual(float(rows[0]["power"]), 0)
        self.assertGreater(max(float(row["power"]) for row in rows if row["bone"] == "upper"), 0)
        self.assertEqual({float(row["power"]) for row in rows if row["bone"] == "lower"}, {0})  # it rests

    def test_power_in_bones_csv_is_that_of_its_force_and_moment(self):
        """Of what acts on the body: F v + M omega of the row, with the velocities that frames have."""
        self.simulate("--set", "output.double_precision=true", "--set", "output.encoding=none")
        rows = list(csv.DictReader((self.out / "bones.csv").open()))
        powers = []
        for number, frame in enumerate(sorted((self.out / "frames").glob("*.vtu"))):
            arrays = meshio.read(frame).point_data
            for bone, row in enumerate(rows[2 * number:2 * number + 2]):
                force, moment = (numpy.array([float(row[f"{what}_{axis}"]) for axis in "xyz"])
                                 for what in ("force", "moment"))
                power = force @ arrays["velocity"][bone] + moment @ arrays["angular_velocity"][bone]
                self.assertAlmostEqual(power, float(row["power"]), delta=1e-9)
                numpy.testing.assert_allclose(-force, arrays["reaction_force"][bone], atol=1e-12)
                numpy.testing.assert_allclose(-moment, arrays["reaction_moment"][bone], atol=1e-12)
                powers.append(power)
        self.assertGreater(max(powers), 0.01)

    def test_bonded_bodies_turn_undamped_unless_they_have_groups(self):
        """damping_form auto: central for bonds, eq. 2 for the paper's model and where there are groups."""
        forms = [(["material.model=bonded"], "central"), (["material.model=paper"], "paper")]
        if HAS_GROUPS:
            forms.append((["material.model=bonded", "hierarchy.enabled=true", "hierarchy.min_particles=64"], "paper"))
        for words, form in forms:
            hashes = []
            for more in ([], [f"material.damping_form={form}"]):
                sets = [part for word in [*words, *more] for part in ("--set", word)]
                self.simulate("--force", *sets)
                hashes.append(self.record()["state_hash"])
            self.assertEqual(*hashes)

    def test_skinning_and_export_are_written_on_request(self):
        asked = [f"--set=output.{key}=true" for key in ("skin_lbs", "skin_dqs", "export")]
        self.simulate(*asked)
        for name in ("skin_lbs", "skin_dqs"):
            self.assertEqual(len(list((self.out / name).glob("*.vtu"))), 13)
            self.assertIn(f"{name}_000012.vtu", (self.out / f"{name}.pvd").read_text())
        cache = (self.out / "surface.pc2").read_bytes()
        version, points, start, rate, samples = struct.unpack("<iiffi", cache[12:32])
        self.assertEqual((cache[:12], version, start, rate, samples), (b"POINTCACHE2\0", 1, 0, 1, 13))
        self.assertEqual(len(cache), 32 + 12 * points * samples)
        vertices = [line.split()[1:] for line in (self.out / "surface.obj").read_text().splitlines()
                    if line.startswith("v ")]
        self.assertEqual(len(vertices), points)
        rest = struct.unpack(f"<{3 * points}f", cache[32:32 + 12 * points])
        for found, expected in zip(rest, [float(x) for vertex in vertices for x in vertex]):
            self.assertAlmostEqual(found, expected, 6)
        moving = (self.out / "surface.glb").read_bytes()
        size = struct.unpack("<I", moving[12:16])[0]
        document = json.loads(moving[20:20 + size])
        self.assertEqual(len(document["meshes"][0]["primitives"][0]["targets"]), 12)
        self.assertEqual(document["buffers"][0]["byteLength"], len(moving) - size - 28)
        again = json.loads(sinew("info", self.out / "surface.glb", "--up", "y", "--json", check=0).stdout)
        self.assertEqual((again["points"], again["closed"]), (points, True))
        self.simulate("--force")
        for name in ("skin_lbs.pvd", "skin_dqs.pvd", "surface.pc2", "surface.obj", "surface.glb"):
            self.assertFalse((self.out / name).exists(), name)

    def test_far_from_the_origin_a_run_is_as_at_it(self):
        """At 1e6 sizes: the same metrics, and surfaces that count from the origin that run.json tells."""
        def points(origin):
            data = (self.out / "surface.pc2").read_bytes()
            return numpy.frombuffer(data, "<f4", offset=32).reshape(-1, 3) + numpy.array(origin) - far

        exact = ("--force", "--set=output.export=true", "--set=output.double_precision=true", "--set=material.model=bonded")
        rows, surfaces, exported = [], [], []
        for far in (numpy.zeros(3), numpy.array([2.0 ** 20, 0, 0])):
            moved = [f"--set={key}.offset={far.tolist()}" for key in ("body", "skeleton")]
            self.simulate(*exact, *moved)
            sinew("measure", self.out, check=0)
            rows.append(list(csv.DictReader((self.out / "metrics.csv").read_text().splitlines()))[-1])
            beside = self.out / "surface.pc2.origin.json"
            self.assertEqual(beside.exists(), far.any())
            surfaces.append(points(json.loads(beside.read_text())["origin"] if far.any() else far))
            stl = self.folder / f"at_{far[0]:.0f}.stl"
            told = json.loads(sinew("export", self.out, "--to", "stl", "--times", "0", "-o", stl, "--json", check=0).stdout)
            self.assertEqual(told.get("origin", [0, 0, 0]), far.tolist())
            exported.append(numpy.frombuffer(stl.read_bytes()[84:], numpy.dtype("(12,)<f4, <u2"))["f0"])
        self.assertEqual(self.record()["origin"], far.tolist())
        self.assertIn("surface.pc2.origin.json", (self.out / "checksums.sfv").read_text())
        moving = (self.out / "surface.glb").read_bytes()
        document = json.loads(moving[20:20 + struct.unpack("<I", moving[12:16])[0]])
        self.assertEqual(document["nodes"][0]["translation"], [0, 0, far[0]])
        numpy.testing.assert_allclose(*surfaces, atol=1e-6)
        numpy.testing.assert_allclose(*exported, atol=1e-6)
        for name in ("limb_turn_max", "volume_error", "strain_95", "angular_momentum_y", "tip_angle", "pair_energy"):
            near, other = (float(row[name]) for row in rows)
            self.assertAlmostEqual(near, other, delta=1e-5 * abs(near), msg=name)

    def test_exported_surface_keeps_the_look_of_its_mesh(self):
        (self.folder / "my meshes").mkdir()
        mesh = self.folder / "my meshes/box.obj"
        lines, corners = ["mtllib skin.mtl"], 0
        for line in (SOURCE / "data/meshes/box.obj").read_text().splitlines():
            words = line.split()
            if line.startswith("f "):
                if corners in (0, 999):
                    lines += [f"g part {corners}", "usemtl " + ("cloth" if corners else "wood")]
                names = []
                for back, word in zip(range(1 - len(words), 0), words[1:]):
                    point = int(word.split("/")[0])
                    lines.append(f"vt {point / 4096} {corners / 8192}")
                    corners += 1
                    names.append(f"{point}/{corners}" if corners % 2 else f"{point}/{back}")
                line = "f " + " ".join(names)
            lines.append(line)
        mesh.write_text("\n".join(lines) + "\n")
        self.scene.write_text(self.scene.read_text().replace(str(SOURCE / "data/meshes/box.obj"),
                                                             "my meshes/box.obj"))
        self.simulate("--set", "body.scale=0.9", "--set", "output.export=true")
        found = (self.out / "surface.obj").read_text().splitlines()
        self.assertEqual(found[1], "mtllib ../my meshes/skin.mtl")
        given = [line.split()[1:] for line in lines if line.startswith("vt ")]
        taken = [line.split()[1:] for line in found if line.startswith("vt ")]
        self.assertTrue([list(map(float, uv)) for uv in taken] == [list(map(float, uv)) for uv in given])
        group, faces = None, {}
        for line in found:
            group = line[2:] if line.startswith("g ") else group
            if line.startswith("f "):
                for corner in line.split()[1:]:
                    point, uv = map(int, corner.split("/"))
                    self.assertEqual(float(taken[uv - 1][0]), point / 4096)
                    faces.setdefault(group, set()).add(uv)
        self.assertLessEqual(max(faces["part 0"]), 999)
        self.assertGreater(min(faces["part 999"]), 999)
        self.assertEqual(len(faces["part 0"] | faces["part 999"]), corners)
        self.assertEqual([line for line in found if line.startswith("usemtl")], ["usemtl wood", "usemtl cloth"])

    def test_bindings_are_all_of_the_scenes_choice(self):
        text = self.scene.read_text()
        hashes = set()
        for binding in ["{}", "{method: inside}", "{core_radius: 0.06}", "{joint_zone: 1, method: inside}",
                        "{explicit: [{bone: upper, low: [-1, -1, 0.3], high: [1, 1, 1]}]}",
                        "{explicit: [{bone: lower, ids: [0, 1]}, {center: [0, 0, 0.6], radius: 0.1}]}"]:
            self.scene.write_text(text + "binding: " + binding + "\n")
            # Flesh without a bone may move a quarter of a radius per step in the scene, bone or no bone.
            self.simulate("--force", "--set", "solver.time_step_factor=0.1")
            self.assertEqual(self.record()["status"], "finished")
            hashes.add(self.record()["state_hash"])
            again = self.folder / "again"
            sinew("simulate", self.out / "scene.yaml", "-o", again, "--force", check=0)
            self.assertEqual(self.record(again)["state_hash"], self.record()["state_hash"])
            sinew("measure", self.out, check=0)
        self.assertGreaterEqual(len(hashes), 5)  # inside a bar the nearest bone is the nearest

    def test_mistakes_of_bindings_name_their_line(self):
        bad = self.folder / "bad.yaml"
        for binding, *parts in [("explicit: [{bone: uper, ids: [0]}]", "uper", "did you mean 'upper'"),
                                ("explicit: [{bone: upper, ids: [123456789]}]", "no particle 123456789"),
                                ("explicit: [{bone: upper, ids: [0.5]}]", "no particle 0.5"),
                                ("explicit: [{bone: upper, ids: []}]", "without values"),
                                ("explicit: [{bone: upper, low: [0, 0, 0]}]", "one corner"),
                                ("explicit: [{bone: upper, radius: 1}]", "center"),
                                ("explicit: [{bone: upper}]", "names no particles"),
                                ("explicit: [{bone: upper, low: [5, 5, 5], high: [6, 6, 6]}]", "no particle in this"),
                                ("explicit: [{center: [0, 0, 9], radius: 1}]", "no particle in this", "reaches into"),
                                ("explicit: {bone: upper}", "must be a list"),
                                ("method: file", "no glTF file"), ("method: near", "nearest")]:
            bad.write_text(self.scene.read_text() + f"binding:\n  {binding}\n")
            line = len(self.scene.read_text().splitlines()) + 2
            self.assert_one_line(sinew("simulate", bad, "-o", self.out), 2, f"{bad}:{line}:", *parts)

    def test_default_folder_is_out_and_the_scenes_name(self):
        sinew("simulate", self.scene, "--set", "solver.duration=0", check=0, cwd=self.folder)
        self.assertTrue((self.folder / "out/small/particles.pvd").exists())

    def test_used_folder_is_refused_unless_forced_or_resumed(self):
        self.simulate()
        before = self.record()["state_hash"]
        keep = self.out / "notes.txt"
        keep.write_text("mine")
        self.assert_one_line(self.simulate(check=2), 2, "--force")
        self.assertIn("finished", self.simulate("--resume").stderr)
        self.simulate("--force")
        self.assertEqual(self.record()["state_hash"], before)
        self.assertEqual(keep.read_text(), "mine")

    def test_broken_scene_leaves_the_old_run_alone(self):
        self.simulate()
        self.simulate("--force", "--set", "body.mesh=missing.obj", check=2)
        self.assertEqual(self.record()["status"], "finished")

    def test_resolved_scene_gives_the_same_run(self):
        self.simulate("--set", "material.lambda=0.8")
        again = self.folder / "again"
        sinew("simulate", self.out / "scene.yaml", "-o", again, check=0)
        self.assertEqual(self.record(again)["state_hash"], self.record()["state_hash"])

    def test_record_tells_how_the_steps_were_done(self):
        for words, used in [
                (["solver.precision=single"], ("single", "lists")),
                (["solver.neighbor_search=cells"], ("double", "cells")),
                (["solver.precision=single", "solver.neighbor_search=cells"], ("double", "cells")),
                (["material.model=bonded", "solver.precision=single"], ("single", "lists")),
                (["material.damping_form=central"], ("double", "lists")),
                (["binding.force=anchor"], ("double", "lists"))]:
            sets = [part for word in ["solver.duration=0.1", *words] for part in ["--set", word]]
            self.simulate("--force", *sets)
            record = self.record()
            self.assertEqual((record["precision"], record["neighbor_search"]), used, words)
            self.assertEqual(record["stepper"], "kernel" if used[1] == "lists" else "reference")
            self.assertEqual(record["lists"]["rebuilds"] > 0, used[1] == "lists", words)
            self.assertEqual(record["instruction_set"] == "plain", used[1] == "cells", words)

    def test_precision_and_search_change_no_result_much(self):
        reference = None
        for word in ["neighbor_search=cells", "neighbor_search=lists", "precision=single"]:
            self.simulate("--force", "--set", "solver." + word)
            sinew("measure", self.out, check=0)
            rows = list(csv.DictReader((self.out / "metrics.csv").open()))
            most = max(float(row["displacement_max"]) for row in rows)
            reference = reference or most
            self.assertAlmostEqual(most / reference, 1, places=3)

    def test_state_does_not_depend_on_the_number_of_threads(self):
        hashes = set()
        for threads in [1, 2, 3, 8]:
            self.simulate("--force", "--threads", threads, "--set", "body.radius=0.012",
                          "--set", "solver.duration=0.1")
            hashes.add(self.record()["state_hash"])
        self.assertEqual(len(hashes), 1)

    def test_body_filled_before_is_used_again_only_if_it_fits(self):
        self.out.mkdir()
        sinew("fill", self.scene, "-o", self.out / "body.vtu", check=0)
        self.simulate("--set", "solver.duration=0")
        count = self.record()["particles"]
        self.simulate("--force", "--set", "solver.duration=0", "--set", "body.radius=0.02")
        self.assertGreater(self.record()["particles"], count)

    def test_limits_decide_the_exit_code_of_measure(self):
        self.simulate()
        sinew("measure", self.out, "--fail-on", "volume_error > 0.5", check=0)
        done = sinew("measure", self.out, "--fail-on", "displacement_max > 0.001", check=1)
        self.assertIn("displacement_max", done.stderr)
        checks = json.loads((self.out / "metrics.json").read_text())["checks"]
        self.assertFalse(checks[0]["pass"])
        self.assert_one_line(sinew("measure", self.out, "--fail-on", "volume_eror > 1"), 2,
                             "volume_error")

    def test_files_that_are_no_runs_are_never_touched(self):
        self.out.mkdir()
        (self.out / "pictures").mkdir()
        (self.out / "pictures/holiday.png").write_text("mine")
        (self.out / "surface").mkdir()
        (self.out / "surface/notes").write_text("mine")
        self.simulate("--set", "solver.duration=0")
        self.simulate("--force", "--set", "solver.duration=0")
        self.assertEqual((self.out / "pictures/holiday.png").read_text(), "mine")
        self.assertEqual((self.out / "surface/notes").read_text(), "mine")
        foreign = self.folder / "foreign"
        foreign.mkdir()
        (foreign / "scene.yaml").write_text(self.scene.read_text())
        for words in [[], ["--force"], ["--resume"]]:
            done = sinew("simulate", foreign / "scene.yaml", "-o", foreign, *words)
            self.assert_one_line(done, 2, "scene.yaml")
        self.assertEqual((foreign / "scene.yaml").read_text(), self.scene.read_text())
        (foreign / "scene.yaml").unlink()
        (foreign / "body.vtu").write_text("mine")
        done = sinew("simulate", self.scene, "-o", foreign, "--force")
        self.assert_one_line(done, 2, "body.vtu")
        self.assertEqual((foreign / "body.vtu").read_text(), "mine")

    def test_deeply_nested_files_are_refused(self):
        self.simulate("--set", "solver.duration=0")
        deep = "<a>" * 400000 + "</a>" * 400000
        for name in ["body.vtu", "particles.pvd"]:
            (self.out / name).write_text(f'<?xml version="1.0"?><VTKFile type="Collection">{deep}</VTKFile>')
            self.assert_one_line(sinew("measure", self.out), 2, name)
            self.simulate("--force", "--set", "solver.duration=0")

    def test_fill_replaces_neither_its_input_nor_a_special_file(self):
        mesh = self.folder / "mine.obj"
        mesh.write_bytes((SOURCE / "data/meshes/box.obj").read_bytes())
        before = mesh.read_bytes()
        words = ["fill", mesh, "--radius", "0.02", "-o"]
        self.assert_one_line(sinew(*words, mesh), 2, "mine.obj")
        self.assertEqual(mesh.read_bytes(), before)
        pipe = self.folder / "pipe.vtu"
        os.mkfifo(pipe)
        self.assert_one_line(sinew(*words, pipe), 4, "pipe")
        self.assertTrue(pipe.is_fifo())

    def test_no_command_replaces_a_file_of_a_run(self):
        self.simulate("--set", "solver.duration=0", "--set", "output.volume=true")
        other, box = self.folder / "other", SOURCE / "data/meshes/box.obj"
        sinew("simulate", self.scene, "-o", other, "--set", "solver.duration=0", check=0)
        (self.out / "meshes").mkdir()
        (self.out / "pictures").mkdir()
        files = {path: path.read_bytes() for path in self.out.rglob("*") if path.is_file()}
        os.symlink(self.out, self.folder / "link")
        for command in (("fill", box, "--radius", "0.03", "-o", self.out / "body.vtu"),
                        ("fill", self.scene, "-o", self.folder / "link/particles/particles_000000.vtu"),
                        ("fill", self.scene, "--to", "tetrahedra", "-o", self.out / "blowup.vtu"),
                        ("fill", self.scene, "--to", "csv", "-o", self.out / "bones.csv"),
                        ("info", box, "-o", self.out / "surface/surface_000000.vtu"),
                        ("info", box, "-o", self.out / "meshes/box.vtu"),
                        ("check", self.scene, "--picture", self.out / "pictures/contact_sheet.png"),
                        ("render", other, "-o", self.out / "pictures"),
                        ("view", other, "--picture", self.out / "pictures/scene.png"),
                        ("export", other, "--to", "csv", "-o", self.out / "bones.csv"),
                        ("export", other, "--to", "gltf", "-o", self.out / "surface.glb"),
                        ("export", other, "--to", "volume", "-o", self.out)):
            self.assert_one_line(sinew(*command), 2, "is of the run", "give another name")
        self.assertEqual({path: path.read_bytes() for path in self.out.rglob("*") if path.is_file()}, files)
        sinew("info", box, "-o", self.out / "defects.vtu", check=0)
        sinew("render", other, "-o", other / "pictures", "--no-movie", check=0)
        done = sinew("fill", self.scene, cwd=self.out)
        self.assert_one_line(done, 2, "body.vtu", "is of the run")

    def test_mistakes_reached_through_a_scene_name_its_line(self):
        self.assert_one_line(self.simulate("--set", "body.mesh=none.obj", check=2), 2, "none.obj")
        bad = self.folder / "bad.yaml"
        bad.write_text(self.scene.read_text().replace("box.obj", "nobox.obj"))
        self.assert_one_line(sinew("check", bad), 2, f"{bad}:3:", "nobox.obj")
        bad.write_text(self.scene.read_text().replace("0.025", "1e-9"))
        self.assert_one_line(sinew("fill", bad), 2, f"{bad}:4:")
        bad.write_text(self.scene.read_text().replace("bone: upper", "bone: uper"))
        self.assert_one_line(sinew("simulate", bad, "-o", self.out), 2, f"{bad}:15:", "uper")

    def test_foreign_and_damaged_run_folders_are_refused(self):
        self.assert_one_line(sinew("measure", self.folder), 2, "not the folder of a run")
        self.simulate("--set", "solver.duration=0.1")
        (self.out / "particles/particles_000002.vtu").write_bytes(b"<VTKFile torn")
        self.assert_one_line(sinew("measure", self.out), 2, "particles_000002.vtu")
        self.assert_one_line(sinew("render", self.out), 2, "particles_000002.vtu")

    def test_check_warns_with_number_and_cure(self):
        done = sinew("check", self.scene, "--set", "material.b=2.83", "--json", check=0)
        self.assertEqual(json.loads(done.stdout)["warnings"], 3)
        self.assertIn("times the volume", done.stderr)  # the scene's particles are coarse
        self.assertIn("% softer", done.stderr)  # and thin
        self.assertIn("2.83", done.stderr)
        self.assertIn("material.b", done.stderr)
        text = self.scene.read_text()
        for old, new, word in [("angle: 30", "twist: 30", "cuts the body"),
                               ("axis: [0, 1, 0]\n          angle: 30", "axis: [0, 0, 1]\n          angle: 30",
                                "cuts the body"),
                               ("0.34648]\n    - name: upper\n      parent: lower\n      tail: [0, 0, 0.69296]",
                                "0.05]\n    - name: upper\n      parent: lower\n      tail: [0, 0, 0.1]",
                                "farther from it than"),
                               ("- time: 0\n", "- time: 0\n          twist: 9\n", "begin at rest"),
                               ("- bone: upper", "- bone: upper\n      interpolation: step", "jumps"),
                               ("skeleton:\n  bones:\n", "skeleton:\n  bones:\n    - name: idle\n"
                                "      head: [9, 9, 9]\n      tail: [9, 9, 10]\n", "no particle follows")]:
            doubtful = self.folder / "doubtful.yaml"
            changed = text.replace(old, new, 1)
            if word == "cuts the body" and "twist" in new:
                changed = changed.replace("axis: [0, 1, 0]\n          twist", "twist", 1)
            self.assertNotEqual(changed, text)
            doubtful.write_text(changed)
            self.assertIn(word, sinew("check", doubtful, check=0).stderr)
        doubtful.write_text(text.replace("time: 0.2", "time: 0.02"))
        self.assertIn("cannot follow", sinew("check", doubtful, "--set", "solver.time_step=0.002", check=0).stderr)
        by_itself = sinew("check", doubtful, "--json", check=0)
        self.assertNotIn("cannot follow", by_itself.stderr)
        self.assertGreater(json.loads(by_itself.stdout)["intervals_of_shorter_steps"], 0)

    def test_check_tells_how_steps_are_done(self):
        for sets, used in [(["solver.precision=single"], ("single", "lists")),
                           (["material.damping_form=symmetric", "binding.force=anchor"], ("double", "lists")),
                           (["solver.neighbor_search=cells"], ("double", "cells"))]:
            words = [part for word in sets for part in ["--set", word]]
            found = json.loads(sinew("check", self.scene, *words, "--json", check=0).stdout)
            self.assertEqual((found["precision"], found["neighbor_search"]), used)

    def test_explicit_euler_without_damping_takes_a_step_for_the_duration(self):
        printed = ["--set", "solver.integrator=explicit_euler", "binding.bone_damping=0"]
        done = sinew("check", self.scene, "--json", *printed, "solver.duration=100", check=0)
        self.assertIn("lets every vibration grow", done.stderr)
        longer = sinew("check", self.scene, "--json", *printed, "solver.duration=200", check=0)
        steps = [json.loads(one.stdout)["time_step"] for one in (done, longer)]
        self.assertAlmostEqual(steps[0] / steps[1], 2, delta=0.02)
        sinew("simulate", self.scene, "-o", self.folder / "printed", *printed, "solver.duration=0.5", check=0)

    def test_every_command_explains_itself(self):
        for command in ["run", "check", "fill", "simulate", "measure", "render", "view", "info"]:
            help_text = sinew(command, "--help", check=0).stdout
            self.assertIn("Examples:", help_text)
            self.assertIn("--threads", help_text)
            self.assertLessEqual(len(help_text.splitlines()), 50)  # a screen
            self.assertIn("sinew 0.", sinew(command, "--version", check=0).stdout)

    def test_the_end_of_a_run_reads_as_in_the_readme(self):
        block = (SOURCE / "README.md").read_text().partition("```\nstatus:")[2].partition("```")[0]
        keys = [line.partition(":")[0] for line in ("status:" + block).splitlines()]
        box = self.folder / "box.yaml"
        box.write_text((SOURCE / "configs/box_bend.yaml").read_text().replace("../data", str(SOURCE / "data")))
        shown = sinew("run", box, "-o", self.out, "--set", "solver.duration=0.1", check=0).stdout.splitlines()
        self.assertRegex(shown[-1], r"^time: .*; [0-9.e-]+ s per frame\)$")
        self.assertLessEqual(len(shown), 12)
        self.assertEqual([line.partition(":")[0] for line in shown], keys)

    def test_a_run_ends_with_what_check_warns_of(self):
        words = ["--set", "material.b=2.83"]
        told = sinew("check", self.scene, *words, check=0).stderr.splitlines()
        self.assertEqual(len(told), 3)
        self.assertEqual(" ".join(told).count("67 % softer"), 1)  # by direction and size: one modulus in one sentence
        self.assertNotIn("bends 52", sinew("check", self.scene, *words, check=0).stdout)
        warnings = [line.removeprefix("sinew: warning: ") for line in told]
        self.assertEqual(warnings, sorted(warnings, key=len))
        for command in "run", "simulate":
            done = sinew(command, self.scene, "-o", self.out, "--force", *words, check=0)
            self.assertEqual(done.stderr.splitlines()[-3:], told)
            self.assertLessEqual(len(done.stdout.splitlines()), 12)
            self.assertEqual(self.record()["warnings"], warnings)
            log = (self.out / "log.txt").read_text()
            page = html.unescape((self.out / "report.html").read_text()) if command == "run" else log
            for text in warnings:
                self.assertEqual([part.count(text) for part in (done.stderr, log, page)], [1, 1, 1])
                self.assertIn(text, page.partition("<h2>")[0])
        done = sinew("run", self.scene, "-o", self.out, "--force", "--set", "solver.time_step=0.02", check=3)
        self.assertEqual(done.stderr.count("will become unstable"), 1)
        self.assertTrue(done.stderr.splitlines()[-1].startswith("sinew: warning: "))

    def test_a_run_tells_what_the_fill_is_doubtful_of(self):
        text = (SOURCE / "data/meshes/box.obj").read_text()
        (self.folder / "open.obj").write_text(text[:text.rindex("\nf ")] + "\n")
        done = sinew("simulate", self.scene, "-o", self.out, "--set", f"body.mesh={self.folder}/open.obj", check=0)
        self.assertIn("warning: the surface is open", done.stderr)

    def test_the_keys_of_scenes_are_a_help_of_their_own(self):
        self.assertIn("young_modulus", sinew("run", "--help-settings", check=0).stdout)
        self.assertNotIn("young_modulus", sinew("run", "--help", check=0).stdout)
        self.assert_one_line(sinew("measure", self.out, "--help-settings"), 2, "unknown option")

    def test_colors_are_for_terminals_alone(self):
        for variables, colors in ({"TERM": "xterm"}, True), ({"TERM": "xterm", "NO_COLOR": "1"}, False), \
                                 ({"TERM": "dumb"}, False):
            shown = on_a_terminal([BIN / "sinew", "info", "no/such.obj"], variables)
            self.assertIn("no/such.obj", shown)
            self.assertEqual("\033[" in shown, colors, shown)
        self.assertNotIn("\033[", sinew("info", "no/such.obj").stderr)


if __name__ == "__main__":
    unittest.main(argv=["run_test", "-v", *sys.argv[3:]])
