#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""What mutants.py changes and what it leaves alone, without a build.

usage: mutants_test.py SOURCE      of the project
"""
import random
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import mutants
from mutations import code_of, mutants_of, sample

SOURCE = Path(sys.argv[1]).resolve()
TEXT = '''// a + b < c
#include <a + b>
/* 0.5 * x */
constexpr double half = 0.5;
constexpr int particles_per_piece = 512;
std::vector<std::array<double, 3>> f(int& n, const char* text) {
  double sums[4];
  if (n < 2 && text[0] == 'a') throw bad_input("n + 1 is " + std::to_string(n * 2), "less" + x);
  for (int i = 0; i < n; ++i)
    sum += std::min(i, n) *
           n - half;
}
'''


def changes(text):
    return [(mutant.line, mutant.old.strip(), mutant.new.strip()) for mutant in mutants_of("f.cpp", text)]


class Changes(unittest.TestCase):
    def test_are_these_and_no_others(self):
        self.assertEqual(changes(TEXT), [
            (4, "0.5", "0.6"),
            (8, "n < 2 && text[0] == 'a'", "!(n < 2 && text[0] == 'a')"),
            (8, "<", ">="), (8, "2", "3"), (8, "&&", "||"), (8, "0", "1"), (8, "==", "!="),
            (9, "0", "1"), (9, "<", "<="), (9, "++", "--"),
            (10, "+=", "-="), (10, "std::min(", "std::max("), (10, "*", "/"), (11, "-", "+")])

    def test_go_both_ways(self):
        self.assertEqual(changes("a - b / c;"), [(1, "-", "+"), (1, "/", "*")])
        self.assertEqual(changes("a <= b || c >= d;"), [(1, "<=", ">"), (1, "||", "&&"), (1, ">=", "<")])
        self.assertEqual(changes("for (int i = f(0, n); a[i] < b; ++i) {"),
                         [(1, "0", "1"), (1, "<", "<="), (1, "++", "--")])
        self.assertEqual(changes("if (a < b) c();"), [(1, "<", ">=")])
        self.assertEqual(changes("x != 1e-3; --y;"), [(1, "!=", "=="), (1, "1e-3", "0.0012"), (1, "--", "++")])
        self.assertEqual(changes("a.minCoeff() + 0.0"), [(1, "minCoeff", "maxCoeff"), (1, "+", "-"), (1, "0.0", "1.0")])

    def test_keep_every_place(self):
        for path in mutants.files_of(SOURCE / "lib" / "sinew" / "stepping"):
            text = path.read_text()
            self.assertEqual(len(code_of(text)), len(text), path)
            self.assertEqual(code_of(text).count("\n"), text.count("\n"), path)

    def test_are_one_at_a_time(self):
        path = "lib/sinew/material/pair_force.h"
        text = (SOURCE / path).read_text()
        found = mutants_of(path, text)
        self.assertGreater(len(found), 30)
        for mutant in found:
            changed = mutant.applied_to(text)
            lines = [at for at, (a, b) in enumerate(zip(text.splitlines(), changed.splitlines()), 1) if a != b]
            self.assertEqual(lines, [mutant.line], mutant)


class Samples(unittest.TestCase):
    def test_are_spread_evenly_and_told_by_the_seed(self):
        whole = list(range(1000))
        some = sample(whole, 50, random.Random(3))
        self.assertEqual({b - a for a, b in zip(some, some[1:])}, {20})
        self.assertEqual(some, sample(whole, 50, random.Random(3)))
        self.assertNotEqual(some, sample(whole, 50, random.Random(5)))
        self.assertEqual(sample(whole, 2000, random.Random(3)), whole)

    def test_list_of_the_command_needs_no_build(self):
        command = [sys.executable, mutants.__file__, SOURCE, "metrics", "--list", "--count", "12"]
        listed = subprocess.run(command, check=True, capture_output=True, text=True).stdout.splitlines()
        self.assertEqual(len(listed), 12)
        for line in listed:
            self.assertRegex(line, r"^lib/sinew/metrics/\S+:\d+: .+ -> .+$")


class Trial(mutants.Workshop):
    """A copy that nobody builds: its fate is what stands in it."""

    def __init__(self, source, folder):
        self.tree = folder / "tree"
        self.copy(source)

    def fate(self, file):
        return (self.tree / file).read_text()


class Copy(unittest.TestCase):
    def test_alone_is_changed_and_only_for_a_while(self):
        file = "lib/sinew/material/pair_force.h"
        text = (SOURCE / file).read_text()
        mutant = mutants_of(file, text)[0]
        with tempfile.TemporaryDirectory() as folder:
            trial = Trial(SOURCE, Path(folder))
            self.assertEqual(trial.fate_of(mutant), mutant.applied_to(text))
            self.assertNotEqual(mutant.applied_to(text), text)
            self.assertEqual(trial.fate(file), text)
            self.assertFalse((trial.tree / ".git").exists())
        self.assertEqual((SOURCE / file).read_text(), text)

    def test_of_what_did_not_change_keeps_its_time(self):
        with tempfile.TemporaryDirectory() as folder:
            trial = Trial(SOURCE, Path(folder))
            before = (trial.tree / "CMakeLists.txt").stat().st_mtime_ns
            trial.copy(SOURCE)
            self.assertEqual((trial.tree / "CMakeLists.txt").stat().st_mtime_ns, before)


class Runs(unittest.TestCase):
    """Of a program that behaves like one of tests."""

    def fate(self, body):
        with tempfile.TemporaryDirectory() as folder:
            program = object.__new__(mutants.Program)
            program.seconds, program.patience = {}, 0.5
            path = Path(folder) / "tests"
            path.write_text("#!/bin/sh\necho '[ RUN      ] A.b'\n" + body)
            path.chmod(0o755)
            return program.run(path, ["A.b"])

    def test_tell_what_noticed(self):
        self.assertIsNone(self.fate("exit 0"))
        self.assertEqual(self.fate("exit 1"), ("A.b", "killed"))
        self.assertEqual(self.fate("kill -SEGV $$"), ("A.b", "killed"))
        self.assertEqual(self.fate("sleep 60"), ("A.b", "timeout"))


if __name__ == "__main__":
    unittest.main(argv=["mutants_test", "-v"])
