// SPDX-License-Identifier: GPL-3.0-or-later
// The resources that a run will need, and warnings about its scene.
//
//     const Needs needs = needs_of(settings, setup, points, faces);
//     check_space(folder, needs, 0);
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include <sinew/scene/setup.h>
#include <sinew/scene/steps.h>
#include <sinew/settings/settings.h>

namespace sinew {

struct Needs {
  std::uint64_t disk = 0;    ///< bytes of all frames and checkpoints
  std::uint64_t memory = 0;  ///< bytes while stepping
};

Needs needs_of(const Settings& settings, const Setup& setup, std::size_t surface_points,
               std::size_t surface_faces);

/// Bytes a user may still write where `folder` is or will be.
std::uint64_t free_space(const std::filesystem::path& folder);

/// Throws not written when the disk has less space than the run needs; `freed` bytes will be freed
/// before it begins.
void check_space(const std::filesystem::path& folder, const Needs& needs, std::uint64_t freed);

/// "12.3 MB"
std::string bytes_text(std::uint64_t bytes);

// What is doubtful in a scene that can be run all the same.

/// One line each, with the number, the reason and the cure. `surface`: of the body; `bone_speed` in
/// radii per step.
std::vector<std::string> warnings_of(const Setup& setup, const Triangles& surface,
                                     double bone_speed);

/// How stiff the filled body is along a bone, beside the Young's modulus that was asked for.
struct BoneStiffness {
  std::string bone;
  double young_modulus;  ///< of the material along the bone, Pa
  double planes;         ///< half-planes of particles across the body there
  double lack;           ///< share of the bending stiffness that so few of them lack, at most

  /// That a bending body shows, Pa.
  double bending_modulus() const { return young_modulus * (1 - lack); }
};

/// Of the bones that hold particles.
std::vector<BoneStiffness> stiffness_along_bones(const Body& body);

/// Adds a line where a bending body shows another modulus than that, by over 10 % at some bone.
void warn_of_stiffness(const Body& body, std::vector<std::string>& warnings);

}  // namespace sinew
