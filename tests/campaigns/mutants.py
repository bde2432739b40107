#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Flips operators and constants of a room of lib one at a time, in a copy of the project, builds the
room's tests and runs them, cheapest first: shows which changes the tests notice and which survive.

usage: mutants.py SOURCE ROOM [--count 60] [--seed 1] [--work FOLDER] [--at FILE[:LINE]] [--slowest 6] [--list]
SOURCE: of the project, which is only read; ROOM: metrics, or one of material to stepping; --work: where the copy and its build
are, kept for the next time (a temporary folder otherwise); --at: only changes there; --slowest: leaves out
tests that take longer, s; --list: shows the changes and builds nothing.
Leaves with 1 when fewer than 90 of 100 are noticed. A change that runs into a time limit counts as noticed,
one that does not compile as none.
"""
import argparse
import json
import os
import random
import re
import resource
import selectors
import shlex
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from collections import Counter
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from mutations import mutants_of, sample

STEPPING = ["stepping_tests", "world_tests", "groups_tests", "laws_tests"]
PROGRAMS = {"metrics": ["metrics_tests"]}
PROGRAMS |= {room: [f"{room}_tests", *(test for test in STEPPING if test != f"{room}_tests")]
             for room in ("material", "body", "world", "analysis", "lists", "groups", "stepping")}
PROGRAMS["kernel"] = STEPPING
LEFT_OUT = shutil.ignore_patterns("build*", "out", ".git", "__pycache__")
ENOUGH = 0.9
FAST = ["-O1", "-DNDEBUG", "-w", "-D_GLIBCXX_ASSERTIONS"]
COMMON_HEADERS = ["Eigen/Core", "Eigen/Geometry", "algorithm", "array", "cmath", "functional", "map", "memory",
                  "optional", "string", "variant", "vector"]
MEMORY = 6 << 30  # bytes a test may take


def files_of(folder):
    return sorted(path for path in folder.rglob("*") if path.suffix in (".cpp", ".h"))


def all_mutants(source, room):
    return [mutant for path in files_of(source / "lib" / "sinew" / room)
            for mutant in mutants_of(str(path.relative_to(source)), path.read_text())]


def is_at(mutant, place):
    file, _, line = place.partition(":")
    return file in mutant.file and line in ("", str(mutant.line))


def copy_if_other(source, target):
    """Files that are the same keep their times, and what was built of them."""
    if not os.path.exists(target) or Path(source).read_bytes() != Path(target).read_bytes():
        shutil.copyfile(source, target)
        shutil.copymode(source, target)


def within_limits():
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
    os.setpgrp()


class Program:
    """A program of tests, with the seconds each took when nothing was changed."""

    patience = 15  # s that any test may take

    def __init__(self, path, slowest):
        self.path = path
        told = path.with_suffix(".json")
        # Those that were too slow the last time are left out at once.
        slow = [name for name, seconds in self.seconds_in(told).items() if seconds >= slowest]
        done = subprocess.run([path, f"--gtest_output=json:{told}.new", f"--gtest_filter=*-{':'.join(slow)}"],
                              capture_output=True, text=True)
        assert done.returncode == 0, f"{path} fails without any change:\n{done.stdout[-3000:]}"
        self.seconds = self.seconds_in(Path(f"{told}.new"))
        if not told.exists():
            os.replace(f"{told}.new", told)
        self.stages = [[name for name, seconds in self.seconds.items() if low <= seconds < high]
                       for low, high in ((0, 0.1), (0.1, min(0.5, slowest)), (0.5, slowest))]

    @staticmethod
    def seconds_in(told):
        if not told.exists():
            return {}
        return {f"{suite['name']}.{test['name']}": float(test["time"].rstrip("s"))
                for suite in json.loads(told.read_text())["testsuites"] for test in suite["testsuite"]}

    def run(self, path, names):
        """None, or what noticed: the first test that fails, or takes far longer than it should."""
        with subprocess.Popen([path, "--gtest_fail_fast", "--gtest_filter=" + ":".join(names)],
                              stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, preexec_fn=within_limits) as child:
            try:
                test, in_time = self.follow(child)
                return None if in_time and child.wait() == 0 else (test, "killed" if in_time else "timeout")
            finally:
                if child.poll() is None:
                    os.killpg(child.pid, signal.SIGKILL)

    def follow(self, child):
        test, said, deadline = "its start", b"", time.monotonic() + 2 * self.patience
        with selectors.DefaultSelector() as waiting:
            waiting.register(child.stdout, selectors.EVENT_READ)
            while waiting.select(max(0, deadline - time.monotonic())):
                more = os.read(child.stdout.fileno(), 1 << 16)
                if not more:
                    failed = re.search(rb"\[  FAILED  \] (\S+)", said)
                    return failed[1].decode() if failed else test, True
                said = (said + more)[-(1 << 16):]
                if begun := re.findall(rb"\[ RUN      \] (\S+)", said):
                    if begun[-1].decode() != test:
                        test = begun[-1].decode()
                        deadline = time.monotonic() + self.patience + 10 * self.seconds.get(test, 0)
        return test, False

    def notice(self, path):
        """The same for the program at that path, by all tests, the cheapest first."""
        return next((noticed for names in self.stages if names and (noticed := self.run(path, names))), None)


class Build:
    """A whole build, and how single objects of it are made anew beside it."""

    def __init__(self, folder, beside):
        self.folder, self.beside = folder, beside
        entries = json.loads((folder / "compile_commands.json").read_text())
        self.entries = {entry["command"].partition(" -o ")[2].split()[0]: entry for entry in entries}
        self.users = {}  # of a file, by its path: objects made of it
        said = subprocess.run(["ninja", "-t", "deps"], cwd=folder, check=True, capture_output=True, text=True).stdout
        for block in said.split("\n\n"):
            made, *needed = block.splitlines() or [""]
            for file in needed:
                self.users.setdefault((folder / file.strip()).resolve(), []).append(made.partition(":")[0])
        beside.mkdir(parents=True, exist_ok=True)
        self.common = beside / "common.h"
        self.common.write_text("".join(f"#include <{name}>\n" for name in COMMON_HEADERS))
        self.precompile("of_lib", ["-fPIC"])
        self.precompile("of_tests", [])

    def precompile(self, name, words):
        """What takes most of the time of compiling; the compiler takes the one that fits, or none."""
        target = Path(f"{self.common}.gch") / name
        target.parent.mkdir(exist_ok=True)
        subprocess.run(["c++", "-x", "c++-header", "-std=gnu++20", "-isystem", "/usr/include/eigen3", *words,
                        "-ffp-contract=off", *FAST, self.common, "-o", target], check=True)

    def beside_of(self, made):
        return str(self.beside / made.replace("/", "_"))

    def compiles(self, made):
        entry = self.entries[made]
        words = [word for word in shlex.split(entry["command"]) if not word.endswith("ccache")]
        words[words.index("-o") + 1] = self.beside_of(made)
        words[1:1] = ["-include", str(self.common)]
        return subprocess.run([*words, *FAST], cwd=entry["directory"], capture_output=True).returncode == 0

    def link_words(self, name):
        target = f"tests/{name}"
        said = subprocess.run(["ninja", "-t", "commands", target], cwd=self.folder, check=True,
                              capture_output=True, text=True).stdout.splitlines()[-1]
        return shlex.split(next(piece for piece in said.split("&&") if f"-o {target} " in piece))

    def parts_of(self, name, made):
        """Those of the objects that the program of that name is made of: its own, and of its rooms."""
        rooms = {str(Path(word).parent) for word in self.link_words(name) if word.endswith(".a")}
        return [one for one in made if f"/{name}.dir/" in one or one.partition("/CMakeFiles/")[0] in rooms]

    def link(self, name, made):
        """The program of that name with these objects in place of those of the build; its path."""
        target, words = f"tests/{name}", self.link_words(name)
        words = [self.beside_of(word) if word in made else word for word in words]
        words[words.index("-o") + 1] = self.beside_of(target)
        # What an archive holds of the same names is not taken from there.
        library = next(at for at, word in enumerate(words) if word.endswith(".a"))
        words[library:library] = [self.beside_of(one) for one in made if one.startswith("lib/")]
        subprocess.run(words, cwd=self.folder, check=True, capture_output=True)
        return Path(self.beside_of(target))


class Workshop:
    """A copy of the project with a build of its own."""

    def __init__(self, source, folder, room, slowest):
        self.tree = folder / "tree"
        self.copy(source)
        build, names = folder / "build", PROGRAMS[room]
        launcher = ["-DCMAKE_CXX_COMPILER_LAUNCHER=ccache"] if shutil.which("ccache") else []
        # Neither our asserts nor warnings notice anything: only tests do, with the standard library's
        # assertions, as they are in the presets. Headers compiled beforehand would need another room's tests.
        self.call("cmake", "-S", self.tree, "-B", build, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=None",
                  f"-DCMAKE_CXX_FLAGS={' '.join(FAST)}", "-DSINEW_STRICT=OFF",
                  "-DCMAKE_DISABLE_PRECOMPILE_HEADERS=ON", *launcher)
        self.call("cmake", "--build", build, "-j2", "--target", *names)
        self.set_out(build, folder / "beside", room, slowest)

    def set_out(self, build, beside, room, slowest):
        self.build = Build(build, beside)
        self.programs = [Program(build / "tests" / name, slowest) for name in PROGRAMS[room]]
        for program in self.programs:
            noticed = program.notice(program.path)
            assert noticed is None, f"{program.path} notices {noticed} without any change"

    def copy(self, source):
        shutil.copytree(source, self.tree, ignore=LEFT_OUT, copy_function=copy_if_other, dirs_exist_ok=True)

    def call(self, *command):
        done = subprocess.run(command, capture_output=True, text=True)
        assert done.returncode == 0, done.stdout[-3000:] + done.stderr[-3000:]

    def compile(self, objects):
        with ThreadPoolExecutor(2) as pool:
            return all(pool.map(self.build.compiles, objects))

    def fate(self, file):
        """Of the copy as it is, when that file of it is another."""
        users, compiled = self.build.users.get((self.tree / file).resolve(), []), set()
        for program in self.programs:
            parts = self.build.parts_of(program.path.name, users)
            if not self.compile([made for made in parts if made not in compiled]):
                return "does not compile", ""
            compiled.update(parts)
            if noticed := program.notice(self.build.link(program.path.name, parts)):
                return noticed[1], noticed[0]
        return "survived", ""

    def fate_of(self, mutant):
        path = self.tree / mutant.file
        text, times = path.read_text(), path.stat()
        path.write_text(mutant.applied_to(text))
        try:
            return self.fate(mutant.file)
        finally:
            path.write_text(text)
            os.utime(path, ns=(times.st_atime_ns, times.st_mtime_ns))


def share(fates):
    noticed = fates["killed"] + fates["timeout"]
    return noticed / max(1, noticed + fates["survived"])


def go(arguments, mutants, folder):
    workshop = Workshop(arguments.source, folder, arguments.room, arguments.slowest)
    tests = sum(len(names) for program in workshop.programs for names in program.stages)
    print(f"{tests} tests of up to {arguments.slowest:g} s; {len(mutants)} changes", flush=True)
    fates, survivors = Counter(), []
    for mutant in mutants:
        begun = time.monotonic()
        fate, by = workshop.fate_of(mutant)
        fates[fate] += 1
        survivors += [mutant] if fate == "survived" else []
        print(f"{fate:16} {mutant}  {by} ({time.monotonic() - begun:.0f} s)", flush=True)
    print(*("", "Survivors:", *survivors) if survivors else "", sep="\n")
    print(", ".join(f"{count} {fate}" for fate, count in fates.most_common()))
    print(f"noticed: {100 * share(fates):.1f} % of {fates.total() - fates['does not compile']} (seed {arguments.seed})")
    return 0 if share(fates) >= ENOUGH else 1


def main():
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(1))  # so that the copy is put right before
    parser = argparse.ArgumentParser()
    parser.add_argument("source", type=lambda text: Path(text).resolve())
    parser.add_argument("room", choices=PROGRAMS)
    parser.add_argument("--count", type=int, default=60)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--work", type=lambda text: Path(text).resolve())
    parser.add_argument("--at", action="append", default=[])
    parser.add_argument("--slowest", type=float, default=6)
    parser.add_argument("--list", action="store_true")
    arguments = parser.parse_args()
    mutants = all_mutants(arguments.source, arguments.room)
    if arguments.at:
        mutants = [mutant for mutant in mutants if any(is_at(mutant, place) for place in arguments.at)]
    chance = random.Random(arguments.seed)
    mutants = sample(mutants, arguments.count, chance)
    if arguments.list:
        print(*mutants, sep="\n")
        return 0
    chance.shuffle(mutants)  # what is tried first is a fair sample too
    with tempfile.TemporaryDirectory() as temporary:
        return go(arguments, mutants, arguments.work or Path(temporary))


if __name__ == "__main__":
    sys.exit(main())
