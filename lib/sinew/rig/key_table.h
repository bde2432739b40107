// SPDX-License-Identifier: GPL-3.0-or-later
// Keys of bones as a table of comma-separated values, as posing by hand records them: a row for
// each key with its time (s), the bone, a quaternion w x y z (from rest, in the directions of the
// parent), a translation (m) and, where a bone twists, degrees about its axis. Between keys motion
// is linear.
//
//     file << key_table_header(false);
//     for (const auto& [bone, key] : keys) file << key_row(bone, key, false);
//     const std::vector<TrackDefinition> tracks = tracks_of_keys(text, "wave.keys.csv");
#pragma once

#include <string>
#include <vector>

#include <sinew/core/options.h>

namespace sinew {

/// time,bone,qw,qx,qy,qz,tx,ty,tz and, where bones `twist`, twist
std::string key_table_header(bool twist);

/// A row, with its line end: numbers in the shortest texts that are read as the same doubles.
std::string key_row(const std::string& bone, const KeyDefinition& key, bool twist);

/// A track for each bone, in the order in which they appear. A row without a line end is one that
/// was being written, and left out. The column twist may be missing. Throws bad input with the
/// line for another header, a row of another length, what is no number, and keys of a bone that are
/// not in ascending time.
std::vector<TrackDefinition> tracks_of_keys(const std::string& text, const std::string& name);

}  // namespace sinew
