# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs the candidates and keeps what they took.

A figure is one round's million particle-steps per second (Mps). Figures are keyed state/particles/kind/threads.
"""
import json
import os
import re
import subprocess
import sys
from collections import defaultdict

STEPS = {3_000: 100, 30_000: 100, 300_000: 100, 3_000_000: 40}  # of a round, as in step_bench's lists
SKIN = {"rest": 0.1, "flowed": 0.15}  # d0; at rest 0.1 just leaves out the second neighbors
SHORTEST = 0.05  # s of measured time per figure of step_bench

# Eq. 1 and nothing else: no damping, no bones. Atoms are sorted and lists built in the first run. Lists are checked
# every 10 steps, which favors LAMMPS: in a flowed body they are too old by then ("dangerous builds"), and checking
# at every step costs it more than half of its speed.
SCRIPT = """
units lj
atom_style atomic
boundary s s s
read_restart {state}.restart
pair_style table linear 1000
pair_coeff 1 1 eq1.table EQ1 {range}
neighbor {skin} bin
neigh_modify delay 0 every 10 check yes
timestep {step}
fix motion all nve
thermo 0
run 10
run {steps}
"""
# The same bonds as harmonic springs, and the repulsion of those that are not bonded.
BONDED_SCRIPT = """
units lj
atom_style bond
boundary s s s
read_data {state}.data
pair_style table linear 1000
pair_coeff 1 1 eq1.table EQ1 {d0}
bond_style harmonic
bond_coeff 1 {half_stiffness} {d0}
special_bonds lj 0 1 1
neighbor {skin} bin
comm_modify cutoff {far}
neigh_modify delay 0 every 10 check yes
timestep {step}
fix motion all nve
thermo 0
run 10
run {steps}
"""
TO_RESTART = """
units lj
atom_style atomic
boundary s s s
read_data {state}.data
pair_style zero {range}
pair_coeff * *
neighbor {skin} bin
run 0
write_restart {state}.restart
"""
LOOP = re.compile(r"Loop time of (\S+) on \d+ procs for (\d+) steps with (\d+) atoms")
COUNTS = {"builds": r"Neighbor list builds = (\d+)", "dangerous": r"Dangerous builds = (\d+)",
          "neighbors": r"Ave neighs/atom = (\S+)"}


def output_of(command, folder=None):
    done = subprocess.run([str(word) for word in command], cwd=folder, text=True, capture_output=True)
    if done.returncode != 0:
        sys.exit(f"compare.py: {command[0]} failed:\n" + (done.stdout + done.stderr)[-2000:])
    return done.stdout


def processor():
    with open("/proc/cpuinfo", encoding="utf-8") as file:
        names = [line.split(":")[1].strip() for line in file if line.startswith("model name")]
    return names[0] if names else os.uname().machine


class Runs:
    def __init__(self, programs, scratch):
        self.programs, self.scratch = programs, scratch
        self.figures, self.hashes = defaultdict(list), defaultdict(set)
        self.limit_figures, self.bytes = defaultdict(list), {}
        self.particles, self.lists, self.worlds = {}, {}, {}

    def prepare(self, state, count, with_lammps):
        """Makes the state that all candidates start from."""
        words = ["lammps"] if with_lammps else []
        world = json.loads(output_of([self.programs / "make_state", state, count, self.scratch, *words]))
        self.worlds[state, count] = world
        self.particles[count] = world["particles"]
        if with_lammps:
            self.run_lammps(TO_RESTART, f"{state}_{count}", range=world["range"], skin=0.1 * world["d0"])
            (self.scratch / f"{state}_{count}.data").unlink()

    def discard(self, state, count):
        for path in self.scratch.glob(f"{state}_{count}.*"):
            path.unlink()

    def benchmarks(self, pattern):
        command = [self.programs / "step_bench", f"--states={self.scratch}", f"--benchmark_filter={pattern}",
                   f"--benchmark_min_time={SHORTEST}", "--benchmark_format=json"]
        return json.loads(output_of(command))["benchmarks"]

    def sinew(self, state, count, kinds):
        for row in self.benchmarks(f"^step/{state}/{count}/({'|'.join(kinds)})/"):
            kind, threads = re.search(r"(\w+)/threads:(\d+)", row["name"]).groups()
            self.figures[f"{state}/{count}/{kind}/{threads}"].append(row["Mps"])
            self.hashes[f"{state}/{count}/{kind}"].add(row["label"])

    def laws(self, count, kinds):
        """All variants, beside the paper's law at rest, in turn."""
        for row in self.benchmarks(f"^law/.*/{count}/({'|'.join(kinds)})/"):
            variant, state, kind, threads = re.search(r"^law/(\w+)/(\w+)/\d+/(\w+)/threads:(\d+)", row["name"]).groups()
            self.figures[f"{variant}, {state}/{count}/{kind}/{threads}"].append(row["Mps"])
            self.hashes[f"{variant}, {state}/{count}/{kind}"].add(row["label"])

    def run_lammps(self, script, state, **values):
        (self.scratch / "in.lammps").write_text(script.format(state=state, **values), encoding="utf-8")
        return output_of(["lmp", "-in", "in.lammps", "-log", "none"], self.scratch)

    def lammps(self, state, count):
        world = self.worlds[state, count]
        text = self.run_lammps(SCRIPT, f"{state}_{count}", range=world["range"], step=world["step"],
                               skin=SKIN[state] * world["d0"], steps=STEPS[count])
        seconds, steps, atoms = map(float, LOOP.findall(text)[-1])
        if atoms != world["particles"]:
            sys.exit(f"compare.py: LAMMPS lost particles: {atoms:.0f} of {world['particles']} are left")
        self.figures[f"{state}/{count}/lammps/1"].append(1e-6 * atoms * steps / seconds)
        self.lists[f"{state}/{count}"] = {name: float(re.findall(pattern, text)[-1])
                                          for name, pattern in COUNTS.items()} | {"steps": steps}

    def prepare_bonded(self, count):
        """A body of bonds at rest, for LAMMPS."""
        self.bonded = json.loads(output_of([self.programs / "make_state", "rest", count, self.scratch, "bonded"]))

    def lammps_bonded(self, count):
        world = self.bonded
        text = self.run_lammps(BONDED_SCRIPT, f"rest_{count}", d0=world["d0"], step=world["step"], steps=STEPS[count],
                               half_stiffness=world["stiffness"] / 2, skin=0.4 * world["d0"], far=3 * world["d0"])
        seconds, steps, atoms = map(float, LOOP.findall(text)[-1])
        self.figures[f"bonded, rest/{count}/lammps/1"].append(1e-6 * atoms * steps / seconds)

    def scene(self, sinew, scene):
        """A shipped scene from its beginning to its end, stepping alone."""
        for precision in ("single", "double"):
            for threads in (1, 2):
                out = self.scratch / "run"
                output_of([sinew, "simulate", scene, "-o", out, "--force", "--threads", threads, "--set",
                           f"solver.precision={precision}", "--set", "output.only=id", "--set", "output.every=1000"])
                run = json.loads((out / "run.json").read_text(encoding="utf-8"))
                name = f"{scene.stem}, whole/{run['particles']}/{precision}"
                self.figures[f"{name}/{threads}"].append(1e-6 * run["particle_steps_per_second"])
                self.hashes[name].add(run["state_hash"])

    def limits(self):
        for row in self.benchmarks("^(peak|triad)"):
            name = row["name"].removesuffix("/real_time")
            for counter in ("GFLOP/s", "GB/s", "traffic"):
                if counter in row:
                    self.limit_figures[f"{name} {counter}"].append(row[counter])

    def memory(self):
        for row in self.benchmarks("^memory"):
            _, variant, kind, *_ = row["name"].split("/")
            self.bytes[kind if variant == "paper" else f"{variant}, {kind}"] = row["bytes"]

    def results(self):
        return {
            "processor": processor(), "cores": len(os.sched_getaffinity(0)), "particles": self.particles,
            "figures": dict(self.figures), "limits": dict(self.limit_figures), "bytes_per_particle": self.bytes,
            "lammps_lists": self.lists, "hashes": {key: sorted(values) for key, values in self.hashes.items()},
            "changed_bits": [key for key, values in self.hashes.items() if len(values) > 1],
        }
