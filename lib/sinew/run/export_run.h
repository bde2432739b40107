// SPDX-License-Identifier: GPL-3.0-or-later
// Writes the particles of a run's frames for other programs.
//
//     const RunFiles run = open_run({"out/bend"});
//     export_frames(run, format_of("xyz", "bend.xyz"), frames_at(run, {0, 0.5}), "bend.xyz");
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include <sinew/io/particle_formats/formats.h>
#include <sinew/run/run_files.h>

namespace sinew {

/// The frames nearest to these times (s), ascending, each once; all where no time is given. Throws
/// bad input for times outside the run.
std::vector<std::size_t> frames_at(const RunFiles& run, const std::vector<double>& times);

/// "FOLDER/NAME_000012.EXTENSION".
std::filesystem::path numbered(const std::filesystem::path& folder, const std::string& name,
                               std::size_t frame, std::string_view extension);

/// The particles of a run at rest, with the pairs that touch then if the format has bonds.
ParticleCloud rest_cloud(const RunFiles& run, const ParticleFormat& format);

struct ExportedFrames {
  std::vector<std::filesystem::path> files;
  std::size_t broken_bonds = 0;  ///< most of a frame, written as bonds all the same
};

/// Writes these frames to one file, where the format allows it or there is one frame; else as
/// particles_000000.EXTENSION and so on, by frame, in the folder `target`, which is created. Bonds
/// are the unbroken ones of the frame where the run has written them, else those at rest. Throws
/// what read_frame() does, and not written.
ExportedFrames export_frames(const RunFiles& run, const ParticleFormat& format,
                             const std::vector<std::size_t>& frames,
                             const std::filesystem::path& target);

}  // namespace sinew
