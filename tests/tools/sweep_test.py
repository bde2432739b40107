#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Sweeps: what is planned, what comes out, what is refused, and that a sweep goes on wherever it was ended.

usage: sweep_test.py BIN SOURCE      folder of the programs, folder of the project
"""
import csv
import json
import random
import re
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

import report_test
import schemas
from small_run import BIN, SOURCE, sinew

SCENE = f"""
body: {{mesh: {SOURCE}/data/meshes/box.obj, radius: 0.025}}
material: {{young_modulus: 10000}}
skeleton:
  bones:
    - {{name: lower, head: [0, 0, 0], tail: [0, 0, 0.34648232]}}
    - {{name: upper, parent: lower, tail: [0, 0, 0.69296465]}}
motion: {{tracks: [{{bone: upper, keys: [{{time: 0}}, {{time: 0.1, euler: [0, 20, 0]}}]}}]}}
loads: [{{name: tip, force: [0, 0, 1], low: [-1, -1, 0.6], high: [1, 1, 1]}}]
solver: {{duration: 0.1}}
output: {{interval: 0.02}}
"""
VARY = """
vary:
  material.young_modulus: [5e3, 1e4]
  body.radius: [0.025, 0.03]
"""
TABLES = ("index.csv", "results.csv")


class Sweeps(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.root = Path(tempfile.mkdtemp())
        (cls.root / "scene.yaml").write_text(SCENE)
        cls.study = cls.write("study.yaml", VARY + "results: [volume_error, {name: displacement_max, of: final}, "
                              "'tip: force_z']\n")
        cls.out = cls.root / "out/study"
        cls.done = sinew("sweep", "study.yaml", check=0, cwd=cls.root)

    @classmethod
    def tearDownClass(cls):
        shutil.rmtree(cls.root)

    @classmethod
    def write(cls, name, text):
        path = cls.root / name
        path.write_text("scene: scene.yaml\n" + text)
        return path

    def rows(self, file, out=None):
        with open((out or self.out) / file, newline="", encoding="utf-8") as table:
            return list(csv.DictReader(table))

    def refused(self, text, *words):
        done = sinew("sweep", self.write("refused.yaml", text))
        self.assertEqual(done.returncode, 2, done.stderr)
        self.assertEqual(len(done.stderr.splitlines()), 1, done.stderr)
        for word in words:
            self.assertIn(word, done.stderr)

    def test_tables_have_a_row_of_each_run_with_the_values_as_written(self):
        index, results = self.rows("index.csv"), self.rows("results.csv")
        self.assertEqual([(row["material.young_modulus"], row["body.radius"]) for row in index],
                         [(a, b) for a in ("5e3", "1e4") for b in ("0.025", "0.03")])
        for row, result in zip(index, results):
            self.assertEqual((row["status"], row["reason"]), ("finished", ""))
            self.assertGreater(float(row["seconds"]), 0)
            self.assertEqual(row["folder"], result["folder"])
            metrics = json.loads((self.out / row["folder"] / "metrics.json").read_text())["metrics"]
            self.assertEqual(float(result["volume_error"]), metrics["volume_error"]["max"])
            self.assertEqual(float(result["displacement_max, final"]), metrics["displacement_max"]["final"])
            self.assertAlmostEqual(float(result["tip: force_z, largest"]), 1, delta=0.01)

    def test_a_run_has_the_bits_that_it_has_alone(self):
        row = self.rows("index.csv")[1]
        alone = self.root / "alone"
        sinew("simulate", "scene.yaml", "--set", "material.young_modulus=5e3", "--set", "body.radius=0.03", "-o", alone,
              check=0, cwd=self.root)
        hashes = [json.loads((folder / "run.json").read_text())["state_hash"] for folder in (alone, self.out / row["folder"])]
        self.assertEqual(*hashes)

    def test_only_the_last_moment_stays_and_paraview_steps_through_the_runs(self):
        row = self.rows("index.csv")[0]
        self.assertEqual(len(list((self.out / row["folder"] / "particles").iterdir())), 1)
        self.assertEqual((self.out / "sweep.pvd").read_text().count("<DataSet"), 4)
        moment = next((self.out / "moments").glob("*radius=0.03*")).read_text()
        self.assertIn('Name="body.radius"', moment)
        self.assertTrue(all((self.out / row["folder"] / "picture.png").exists() for row in self.rows("index.csv")))

    def test_files_are_as_their_schemas_say(self):
        self.assertEqual(schemas.check_written(self.out), 1 + 3 * 4)
        text = subprocess.run(["/usr/bin/python3", "-c", "import json, sys, yaml; json.dump(yaml.safe_load(sys.stdin), sys.stdout)"],
                              input=self.study.read_text(), capture_output=True, text=True, check=True).stdout
        schemas.check(json.loads(text), "sweep_study")
        for wrong in ({"scene": "a"}, {"scene": "a", "vary": {}}, {"scene": "a", "vary": {"a.b": [1]}, "vari": 1}):
            with self.assertRaises(Exception):
                schemas.check(wrong, "sweep_study")

    def test_a_narrow_page_needs_no_sideways_scrolling(self):
        report_test.RUN = self.out
        for width in (1400, 420):
            found = report_test.framed(width)
            self.assertLessEqual(found["overflow"], 0, (width, found["beyond"]))

    def test_what_is_done_is_not_done_again(self):
        before = {file: (self.out / file).read_bytes() for file in TABLES}
        again = sinew("sweep", "study.yaml", check=0, cwd=self.root)
        self.assertIn("all runs are done", again.stderr)
        self.assertEqual(before, {file: (self.out / file).read_bytes() for file in TABLES})

    def test_a_dry_run_makes_nothing_and_tells_all(self):
        plan = json.loads(sinew("sweep", self.study, "--dry-run", "--json", "-o", self.root / "none", check=0).stdout)
        self.assertFalse((self.root / "none").exists())
        self.assertEqual(len(plan["runs"]), 4)
        for run in plan["runs"]:
            for key in ("particles", "steps", "seconds", "memory", "disk"):
                self.assertGreater(run[key], 0, key)
        self.assertEqual(plan["disk"], sum(sorted((run["disk"] for run in plan["runs"]), reverse=True)[:plan["jobs"]]))

    def test_the_page_has_the_limit_for_small_particles(self):
        rows, page = self.rows("results.csv"), (self.out / "report.html").read_text()
        fine, coarse = (sum(float(row["volume_error"]) for row in rows if row["body.radius"] == radius) / 2
                        for radius in ("0.025", "0.03"))
        limit, error = re.search(r"volume_error.{0,80}Limit: (\S+) ± ([\d.e-]+)", page).groups()
        self.assertAlmostEqual(float(limit) / (fine + (fine - coarse) * 5), 1, delta=1e-3)
        self.assertAlmostEqual(float(error) / abs(float(limit) - fine), 1, delta=1e-3)

    def test_runs_are_packed_as_they_end_soonest(self):
        for durations, packed in ((".1, .11, .12, .13", (2, 1)), (".1, .11, 40", (1, 2))):
            study = self.write("packed.yaml", f"vary: {{solver.duration: [{durations}]}}\n")
            plan = json.loads(sinew("sweep", study, "--dry-run", "--json", "--threads", 2, check=0).stdout)
            self.assertEqual((plan["jobs"], plan["threads"]), packed)

    def test_many_runs_need_few_handles_and_leave_metrics_alone(self):
        study = self.write("many.yaml", "vary: {material.young_modulus: {from: 5e3, to: 2e4}}\nkeep: metrics\n"
                           "design: {kind: sobol, samples: 16}\nset: {body.radius: 0.05, solver.duration: 0.02}\n")
        out = self.root / "many"
        done = sinew("sweep", study, "-o", out, check=0, preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_NOFILE, (20, 20)))
        self.assertIn("no sweep.pvd", done.stderr)
        self.assertEqual({row["status"] for row in self.rows("index.csv", out)}, {"finished"})
        self.assertEqual(len(list((out / "runs").glob("*/picture.png"))), 16)
        self.assertFalse([*out.glob("*.pvd"), *out.glob("runs/*/particles/*")])

    def test_shards_together_are_the_whole(self):
        for k in (1, 2, 3):
            sinew("sweep", self.study, "--shard", f"{k}/3", "-o", self.root / f"part{k}", check=0)
        merged = self.root / "merged"
        sinew("sweep", self.study, "--merge", *(self.root / f"part{k}" for k in (1, 2, 3)), "-o", merged, check=0)
        self.assertEqual((merged / "results.csv").read_bytes(), (self.out / "results.csv").read_bytes())
        self.assertEqual([row["status"] for row in self.rows("index.csv", merged)], ["finished"] * 4)
        # Of runs that two machines did, the same one is taken in any order, and when merged again.
        folders, told = [self.out, merged, self.root / "part2"], set()
        for out, order in (("one", folders), ("one", folders), ("other", folders[::-1])):
            sinew("sweep", self.study, "--merge", *order, "-o", self.root / out, check=0)
            told.add((self.root / out / "index.csv").read_bytes())
        self.assertEqual(len(told), 1)
        seconds = [{row["folder"]: float(row["seconds"]) for row in self.rows("index.csv", folder)} for folder in folders[:2]]
        self.assertEqual([float(row["seconds"]) for row in self.rows("index.csv", self.root / "one")],
                         [min(one[folder] for one in seconds) for folder in seconds[0]])

    def test_killed_at_random_it_goes_on(self):
        out, rng = self.root / "killed", random.Random(1)
        for _ in range(4):
            process = subprocess.Popen([BIN / "sinew", "sweep", self.study, "-o", out, "--quiet"], stderr=subprocess.DEVNULL,
                                       stdout=subprocess.DEVNULL)
            time.sleep(rng.uniform(0.2, 1.2))
            process.send_signal(rng.choice([signal.SIGKILL, signal.SIGTERM]))
            process.wait(60)
            self.assertNotIn("failed", (out / "index.csv").read_text() if (out / "index.csv").exists() else "")
        sinew("sweep", self.study, "-o", out, check=0)
        self.assertEqual((out / "results.csv").read_bytes(), (self.out / "results.csv").read_bytes())

    def test_whoever_still_works_in_a_folder_is_waited_for(self):
        """As the programs of a sweep that was killed do for a moment."""
        out = self.root / "busy"
        shutil.copytree(self.out, out)
        folder = out / self.rows("index.csv", out)[0]["folder"]
        shutil.rmtree(folder)
        folder.mkdir()
        holder = subprocess.Popen(["flock", folder / ".lock", "sleep", "2"])
        time.sleep(0.2)
        sinew("sweep", self.study, "-o", out, check=0)
        self.assertIsNotNone(holder.poll())
        self.assertEqual([row["status"] for row in self.rows("index.csv", out)], ["finished"] * 4)

    def test_a_run_that_fails_is_a_row_with_its_reason(self):
        study = self.write("fails.yaml", "vary: {solver.time_step: [0.0005, 0.02]}\nset: {body.radius: 0.03}\n")
        out = self.root / "fails"
        done = sinew("sweep", study, "-o", out, check=0)
        self.assertIn("1 of 2 runs failed", done.stderr)
        bad = self.rows("index.csv", out)[1]
        self.assertEqual(bad["status"], "failed")
        self.assertGreater(len(bad["reason"]), 10)
        self.assertEqual(self.rows("results.csv", out)[1]["volume_error"], "nan")
        self.assertIn(bad["reason"].split(";")[0][:30].replace("'", "&#39;"), (out / "report.html").read_text())
        self.assertIn("all runs are done", sinew("sweep", study, "-o", out, check=0).stderr)
        sinew("sweep", study, "-o", out, "--strict", check=3)
        self.assertNotIn("all runs are done", sinew("sweep", study, "-o", out, "--retry-failed", check=0).stderr)

    def test_all_failed_is_no_success(self):
        study = self.write("all_fail.yaml", "vary: {solver.time_step: [0.02, 0.03]}\nset: {body.radius: 0.03}\n")
        sinew("sweep", study, "-o", self.root / "all_fail", check=3)

    def test_a_run_that_takes_too_long_is_ended(self):
        study = self.write("late.yaml", "vary: {body.radius: [0.006]}\nset: {solver.duration: 20}\n")
        out = self.root / "late"
        sinew("sweep", study, "-o", out, "--timeout", 2, check=3)
        self.assertIn("took over 2 s", self.rows("index.csv", out)[0]["reason"])

    def test_a_study_that_changes_keeps_what_it_still_has(self):
        study = self.write("grows.yaml", "vary: {body.radius: [0.03, 0.035]}\n")
        out = self.root / "grows"
        sinew("sweep", study, "-o", out, check=0)
        first = self.rows("index.csv", out)[1]
        self.write("grows.yaml", "vary: {body.radius: [0.035, 0.04]}\nresults: [J_min]\n")
        done = sinew("sweep", study, "-o", out, check=0)
        self.assertIn("is not in the study", done.stderr)
        self.assertEqual(self.rows("index.csv", out)[0], first)
        self.assertEqual(list(self.rows("results.csv", out)[0])[-1], "J_min")
        self.write("grows.yaml", "vary: {body.radius: [0.035, 0.04]}\nresults: [J_max]\n")
        self.write("grows.yaml", "vary: {body.radius: [0.035, 0.04]}\nresults: [inverted]\n")
        sinew("sweep", out, "--table", check=0)
        self.assertEqual(list(self.rows("results.csv", out)[0])[-1], "inverted")

    def test_another_mesh_below_a_finished_run_is_refused(self):
        mesh = self.root / "own.obj"
        shutil.copy(SOURCE / "data/meshes/box.obj", mesh)
        study = self.write("mesh.yaml", "vary: {body.radius: [0.03]}\nset: {body.mesh: own.obj}\n")
        out = self.root / "mesh"
        sinew("sweep", study, "-o", out, check=0)
        mesh.write_text(mesh.read_text() + "# changed\n")
        self.assertIn("another mesh", sinew("sweep", study, "-o", out, check=2).stderr)
        sinew("sweep", study, "-o", out, "--force", check=0)

    def test_wrong_studies_are_refused_with_their_line(self):
        self.refused("vary: {}\n", "vary names no setting")
        self.refused("vary: {body.radius: [0.03, 0.030]}\n", "refused.yaml:2:8", "same scene")
        self.refused("vary: {body.radius: [0.03], body.count: [100]}\n", "set the same")
        self.refused("vary: {body.radius: [-1]}\n", "refused.yaml:2:8", "body.radius")
        self.refused("vary: {'loads[tap].force': [[0, 0, 1]]}\n", "'loads' has no entry 'tap'", "tip")
        self.refused("vary: {'loads[tip].force': [[0, 0, 1]], 'loads[0].force': [[0, 0, 2]]}\n", "are one setting")
        self.refused("vary: {body.radius: [0.03]}\nresults: [volume_eror]\n", "did you mean volume_error")
        self.refused("vary: {body.radius: [0.03]}\ndesign: gird\n", "did you mean grid")
        self.refused("vary: {body.radius: {from: 0.02, to: 0.03}}\n", "count must be a number")
        self.refused("vary: {body.radius: {from: 0.02, to: 0.03}}\ndesign: sobol\n", "no samples")
        self.refused("vary: {body.radius: [0.03, 0.02], material.young_modulus: [1e4]}\ndesign: list\n", "as many")
        self.refused("vari: {body.radius: [0.03]}\n", "did you mean vary")

    def test_results_of_the_wrong_kind_are_refused(self):
        vary = "vary: {body.radius: [0.03]}\n"
        self.refused(vary + "results: 5\n", "refused.yaml:3:10", "no metric '5'")
        self.refused(vary + "results: {}\n", "results")
        self.refused(vary + "set: 5\n", "refused.yaml:3:6", "set")
        self.refused(vary + "results: ['tap: force_z']\n", "refused.yaml:3:11", "no support, load or probe 'tap'", "tip")
        self.refused(vary + "results: [{name: J_min, of: at, time: 7}]\n", "refused.yaml:3:11", "0.1 s")
        for text in ("", "- a\n", "5\n"):
            (self.root / "odd.yaml").write_text(text)
            self.assertEqual(sinew("sweep", self.root / "odd.yaml").returncode, 2, text)

    def test_no_folder_of_something_else_is_written_into(self):
        other = self.root / "other"
        other.mkdir()
        (other / "report.html").write_text("mine")
        self.assertIn("holds", sinew("sweep", self.study, "-o", other, check=2).stderr)
        self.assertEqual((other / "report.html").read_text(), "mine")
        run = self.out / self.rows("index.csv")[0]["folder"]
        self.assertIn("holds", sinew("sweep", self.study, "-o", run, check=2).stderr)
        study = other / "study.yaml"
        study.write_text("scene: ../scene.yaml\nvary: {material.young_modulus: [5e3]}\n")
        self.assertIn("holds", sinew("sweep", study, "-o", other, check=2).stderr)
        (other / "report.html").unlink()  # a folder that holds the study alone is the sweep's
        sinew("sweep", study, "-o", other, check=0)
        self.assertEqual(len(self.rows("results.csv", other)), 1)

    def test_damaged_records_are_no_accident(self):
        out = self.root / "damaged"
        shutil.copytree(self.out, out)
        folders = [out / row["folder"] for row in self.rows("index.csv", out)]
        for folder, text in zip(folders, ("", "[1]", '{"status": 5, "seconds": "x", "reason": []}')):
            (folder / "sweep.json").write_text(text)
        (folders[3] / "metrics.csv").unlink()
        sinew("sweep", self.study, "-o", out, check=0)
        self.assertEqual((out / "results.csv").read_bytes(), (self.out / "results.csv").read_bytes())
        (out / "sweep.json").write_text('{"study": 5}')
        self.assertIn("is not the folder of a sweep", sinew("sweep", out, "--table", check=2).stderr)

    def test_a_failed_run_that_is_done_again_leaves_the_others_alone(self):
        """Those under way go on; frames that a kill left behind are removed."""
        study = self.write("again.yaml", "vary: {body.radius: [0.03, 0.035, 0.04]}\n")
        out = self.root / "again"
        sinew("sweep", study, "-o", out, check=0)
        failed, under_way, done = [out / row["folder"] for row in self.rows("index.csv", out)]
        state = json.loads((failed / "sweep.json").read_text())
        (failed / "sweep.json").write_text(json.dumps({**state, "status": "failed"}))
        (under_way / "sweep.json").unlink()
        sinew("simulate", "scene.yaml", "--set", "body.radius=0.035", "-o", under_way, "--force", check=0, cwd=self.root)
        started = [json.loads((folder / "run.json").read_text())["started"] for folder in (failed, under_way)]
        (done / "particles/particles_000001.vtu").write_text("left behind")
        time.sleep(1.1)
        sinew("sweep", study, "-o", out, "--retry-failed", check=0)
        for folder in (failed, under_way, done):
            self.assertEqual(len(list((folder / "particles").iterdir())), 1)
        again = [json.loads((folder / "run.json").read_text())["started"] for folder in (failed, under_way)]
        self.assertNotEqual(again[0], started[0])
        self.assertEqual(again[1], started[1])

    def test_shards_of_another_mesh_are_not_merged(self):
        mesh = self.root / "part.obj"
        shutil.copy(SOURCE / "data/meshes/box.obj", mesh)
        study = self.write("part.yaml", "vary: {body.radius: [0.03]}\nset: {body.mesh: part.obj}\n")
        sinew("sweep", study, "-o", self.root / "shard", check=0)
        mesh.write_text(mesh.read_text() + "# changed\n")
        self.assertIn("another mesh", sinew("sweep", study, "--merge", self.root / "shard", "-o", self.root / "whole",
                                            check=2).stderr)

    def test_values_with_commas_and_line_ends_come_back(self):
        study = self.write("odd.yaml", "vary: {'loads[tip].force': [[0, 0, 1], [0, 0.5, 1]]}\n")
        out = self.root / "odd"
        sinew("sweep", study, "-o", out, check=0)
        self.assertEqual([row["loads[tip].force"] for row in self.rows("index.csv", out)], ["[0, 0, 1]", "[0, 0.5, 1]"])

    def test_random_designs_are_the_same_again(self):
        text = "vary: {body.radius: {from: 0.02, to: 0.04, scale: log}, material.model: [paper, bonded]}\n"
        for kind in ("latin_hypercube", "sobol"):
            study = self.write("random.yaml", text + f"design: {{kind: {kind}, samples: 12, seed: 7}}\n")
            plans = [json.loads(sinew("sweep", study, "--dry-run", "--json", check=0).stdout) for _ in range(2)]
            values = [[run["values"] for run in plan["runs"]] for plan in plans]
            self.assertEqual(*values)
            self.assertEqual(sum(one["material.model"] == "paper" for one in values[0]), 6)

    def test_a_new_study_runs_as_it_is(self):
        sinew("new", "--study", self.root / "scene.yaml", check=0)
        study = self.root / "scene_study.yaml"
        plan = json.loads(sinew("sweep", study, "--dry-run", "--json", check=0).stdout)
        self.assertEqual(len(plan["runs"]), 12)
        self.assertIn("is there already", sinew("new", "--study", self.root / "scene.yaml", check=2).stderr)

    def test_a_baseline_tells_what_changed(self):
        run = self.out / self.rows("index.csv")[0]["folder"]
        alone, file = self.root / "measured", self.root / "baseline.csv"
        sinew("simulate", "scene.yaml", "-o", alone, check=0, cwd=self.root)
        sinew("measure", alone, "--write-baseline", file, check=0)
        sinew("measure", alone, "--baseline", file, check=0)
        lines = file.read_text().splitlines()
        changed = [line.replace(",0,1e-06", ",0,ignored") if line.startswith("J_min,") else line for line in lines]
        changed = ["speed_max,worst,99,0,1e-06" if line.startswith("speed_max,worst") else line for line in changed]
        file.write_text("\n".join([line for line in changed if not line.startswith("area,final")] + ["gone,final,1,0,0", ""]))
        done = sinew("measure", alone, "--baseline", file, check=1)
        for words in ("3 results", "speed_max, worst", "recorded 99", "gone, final: not there", "area, final"):
            self.assertIn(words, done.stderr)
        self.assertTrue(run.is_dir())
        file.write_text("no table\n")
        sinew("measure", alone, "--baseline", file, check=2)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1] + sys.argv[3:])
