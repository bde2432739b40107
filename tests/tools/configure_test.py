#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""configure_test.py SOURCE: packages that sinew can do without never end a configuration, whatever their state."""
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

SOURCE = Path(sys.argv[1]).resolve()
PROJECT = """cmake_minimum_required(VERSION 3.25)
project(tried CXX)
include({lib}/optional.cmake)
sinew_optional(GADGET WHAT "the gadget" PACKAGES libgadget-dev gadget
  FIND "find_package(Gadget REQUIRED)" LINK Gadget::gadget SOURCE "#include <gadget.h>\\nint a = gadget;")
message(STATUS "has gadget: ${{SINEW_HAS_GADGET}}")
if(SINEW_HAS_GADGET)
  find_package(Gadget REQUIRED)
endif()
"""
IMPORTED = """add_library(Gadget::gadget INTERFACE IMPORTED)
target_include_directories(Gadget::gadget INTERFACE ${CMAKE_CURRENT_LIST_DIR})
"""


class OptionalPackages(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.folder = Path(scratch.name)
        self.package = self.folder / "package"
        self.package.mkdir()
        (self.folder / "CMakeLists.txt").write_text(PROJECT.format(lib=SOURCE / "lib"))

    def install(self, config, header=None):
        (self.package / "GadgetConfig.cmake").write_text(config)
        if header is not None:
            (self.package / "gadget.h").write_text(header)

    def configure(self, *settings):
        done = subprocess.run(["cmake", "-G", "Ninja", "-S", self.folder, "-B", self.folder / "build",
                               f"-DCMAKE_PREFIX_PATH={self.package}", *settings],
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=50)
        about = [line for line in done.stdout.splitlines() if "gadget" in line]
        return done.returncode, about, " ".join(done.stdout.split())

    def assert_left_out(self, why):
        code, about, all_of_it = self.configure()
        self.assertEqual(code, 0, all_of_it)
        self.assertEqual(about, [f"-- Without the gadget: {why} (Debian: apt-get install libgadget-dev gadget)",
                                 "-- has gadget: FALSE"])
        code, _, all_of_it = self.configure("-DSINEW_GADGET=ON")
        self.assertNotEqual(code, 0)
        self.assertIn(f"SINEW_GADGET is ON, and {why}; on Debian: apt-get install --reinstall libgadget-dev gadget",
                      all_of_it)

    def test_a_sound_package_is_used(self):
        self.install(IMPORTED, "constexpr int gadget = 1;")
        self.assertEqual(self.configure()[:2], (0, ["-- has gadget: TRUE"]))

    def test_a_missing_package_is_a_line(self):
        self.assert_left_out("its packages are missing or incomplete")

    def test_a_package_whose_own_files_end_the_configuration_is_a_line(self):
        self.install('message(FATAL_ERROR "names a file that is in another package")')
        self.assert_left_out("its packages are missing or incomplete")

    def test_a_package_without_its_header_is_a_line(self):
        self.install(IMPORTED)
        self.assert_left_out("a program that uses it does not build")

    def test_a_package_without_its_library_is_a_line(self):
        self.install(IMPORTED + "target_link_libraries(Gadget::gadget INTERFACE gadget_that_is_missing)",
                     "constexpr int gadget = 1;")
        self.assert_left_out("a program that uses it does not build")

    def test_off_leaves_out_what_is_there(self):
        self.install(IMPORTED, "constexpr int gadget = 1;")
        code, about, _ = self.configure("-DSINEW_GADGET=OFF")
        self.assertEqual((code, about), (0, ["-- Without the gadget (SINEW_GADGET is OFF)", "-- has gadget: FALSE"]))

    def test_another_word_is_refused(self):
        code, _, all_of_it = self.configure("-DSINEW_GADGET=perhaps")
        self.assertNotEqual(code, 0)
        self.assertIn("SINEW_GADGET is perhaps; set it to AUTO, ON or OFF", all_of_it)


if __name__ == "__main__":
    unittest.main(argv=["configure_test", "-v"])
