// SPDX-License-Identifier: GPL-3.0-or-later
// What a run will need before it needs it.
#pragma once

#include <cstdint>
#include <filesystem>

#include "core/settings.h"
#include "scene/setup.h"

namespace sinew {

struct Needs {
  std::uint64_t disk = 0;    ///< bytes of all frames and checkpoints
  std::uint64_t memory = 0;  ///< bytes while stepping
};

Needs needs_of(const Settings& settings, const Setup& setup, std::size_t surface_points,
               std::size_t surface_faces);

/// Bytes a user may still write where `folder` lies or will lie.
std::uint64_t free_space(const std::filesystem::path& folder);

/// Throws not written when the disk has less room than the run needs; `freed` bytes will be given
/// back before it begins.
void check_space(const std::filesystem::path& folder, const Needs& needs, std::uint64_t freed);

/// "12.3 MB"
std::string bytes_text(std::uint64_t bytes);

}  // namespace sinew
