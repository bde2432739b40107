// SPDX-License-Identifier: GPL-3.0-or-later
// The readers as fuzzers call them. Any bytes are a file that gives sound values, or bad input in
// one line that says what to do; all else ends the program.
#pragma once

#include <filesystem>
#include <ostream>
#include <string_view>
#include <vector>

namespace sinew::fuzz {

void bvh(std::string_view bytes);
void checkpoint(std::string_view bytes);
void frd(std::string_view bytes);
void gltf(std::string_view bytes);
void obj(std::string_view bytes);
void off(std::string_view bytes);
void play(std::string_view bytes);
void ply(std::string_view bytes);
void pvd(std::string_view bytes);
void record(std::string_view bytes);
void scene(std::string_view bytes);
void stl(std::string_view bytes);
void vtk(std::string_view bytes);
void vtu(std::string_view bytes);

/// A reader by its name, which is that of its corpus too.
struct Target {
  const char* name;
  void (*try_one)(std::string_view bytes);
};
inline void PrintTo(const Target& target, std::ostream* out) { *out << target.name; }

/// Returns targets that this program tries on their corpora.
std::vector<Target> tried_targets();

/// Ends the program where something that always holds does not.
void require(bool holds);

/// Whether there is nothing in it that a terminal would obey.
bool is_one_line(std::string_view text);

/// Does `job`; what it throws must be bad input in one line.
template <class Job>
void expect_sound_or_refused(Job&& job);

/// Puts the bytes into a file of that name, in a folder of this process.
std::filesystem::path file_of(std::string_view bytes, const char* name);

}  // namespace sinew::fuzz

#include "expect.h"
