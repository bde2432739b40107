#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Words that shells complete, and the manual page of scenes.

usage: completion_test.py BIN SOURCE TABLES      folder of the programs, folder of the project, sinew-tables
"""
import os
import re
import shutil
import subprocess
import sys
import unittest
from pathlib import Path

BIN, SOURCE, TABLES = (Path(word).resolve() for word in sys.argv[1:4])
SCRIPTS = SOURCE / "tools/packaging"
PATHS = os.environ | {"PATH": f"{BIN}:{os.environ['PATH']}"}


def bash(*words):
    line = " ".join(f"'{word}'" for word in words)
    script = (f"compopt() {{ :; }}; . {SCRIPTS}/sinew.bash; COMP_WORDS=({line}); "
              f"COMP_CWORD={len(words) - 1}; _sinew; printf '%s\\n' \"${{COMPREPLY[@]}}\"")
    return subprocess.run(["bash", "-c", script], env=PATHS, capture_output=True, text=True, check=True).stdout.split()


class Completion(unittest.TestCase):
    def test_commands(self):
        listed = re.findall(r"^  (\w+)  ", subprocess.run([BIN / "sinew", "--help"], capture_output=True,
                                                            text=True, check=True).stdout, re.M)
        self.assertEqual(set(bash("sinew", "")) - {"--help", "--version"}, set(listed))
        for script in ("_sinew", "sinew.fish"):
            text = (SCRIPTS / script).read_text()
            for command in listed:
                self.assertRegex(text, rf"\b{command}\b")

    def test_options_and_keys(self):
        self.assertEqual(bash("sinew", "render", "--cam"), ["--camera"])
        self.assertIn("--radius", bash("sinew", "fill", "--r"))
        self.assertEqual(bash("sinew", "run", "--set", "material.young"), ["material.young_modulus="])
        self.assertEqual(bash("sinew", "fill", "--packing", "h"), ["hcp"])

    def test_words_that_no_help_has_are_not_offered(self):
        for command in ("run", "simulate", "render", "measure", "info"):
            text = subprocess.run([BIN / "sinew", command, "--help"], capture_output=True, text=True, check=True).stdout
            offered = bash("sinew", command, "--")
            self.assertEqual(set(offered), set(re.findall(r"(--[\w-]+)", text)) & set(offered))
            self.assertNotIn("--completions", offered)

    def test_lists_of_words_are_those_of_the_help(self):
        views = set(re.findall(r"(\w+) \(", subprocess.run([BIN / "sinew", "render", "--help"], capture_output=True,
                                                           text=True).stdout.split("--view")[1].split("--compare")[0]))
        self.assertEqual(set(bash("sinew", "render", "--view", "")), views)
        settings = subprocess.run([BIN / "sinew", "run", "--help-settings"], capture_output=True, text=True).stdout
        arrays = settings.split("or all: ")[1].splitlines()[0].split("; ")[0].split(", ")
        self.assertEqual(set(bash("sinew", "measure", "--arrays", "")), {*arrays, "all"})
        fill = subprocess.run([BIN / "sinew", "fill", "--help"], capture_output=True, text=True).stdout
        formats = re.findall(r"(\w+) \(", fill.split("--to FORMAT")[1].split("--verify")[0])
        self.assertEqual(set(bash("sinew", "fill", "--to", "")), set(formats))
        self.assertEqual(set(bash("sinew", "export", "--to", "")), {*formats, "calculix", "volume", "obj", "ply", "stl"} - {"tetrahedra"})
        said = subprocess.run([BIN / "sinew", "fill", SOURCE / "data/meshes/box.obj", "--radius", "1", "--packing", "zzz"],
                              capture_output=True, text=True).stderr
        packings = said.split("use one of ")[1].strip().split(", ")
        self.assertEqual(set(bash("sinew", "fill", "--packing", "")), set(packings))
        for script in ("_sinew", "sinew.fish"):
            for word in views | (set(arrays) if script == "_sinew" else set()):
                self.assertRegex((SCRIPTS / script).read_text(), rf"\b{word}\b")

    @unittest.skipUnless(shutil.which("fish"), "fish is not installed")
    def test_fish(self):
        done = subprocess.run(["fish", "-c", f"source {SCRIPTS}/sinew.fish; complete -C 'sinew run --set material.yo'"],
                              env=PATHS, capture_output=True, text=True)
        self.assertIn("material.young_modulus=", done.stdout)

    def test_the_manual_of_scenes_is_clean_roff(self):
        page = subprocess.run([TABLES, "manual"], capture_output=True, text=True, check=True).stdout
        for key in ("young_modulus", "bodies[]"):
            self.assertIn(key, page)
        if shutil.which("man"):
            done = subprocess.run(["man", "--warnings", "-E", "UTF-8", "-l", "-Tutf8", "-Z", "-"], input=page,
                                  capture_output=True, text=True)
            self.assertEqual(done.stderr, "")


if __name__ == "__main__":
    unittest.main(argv=["completion_test", "-v", *sys.argv[4:]])
