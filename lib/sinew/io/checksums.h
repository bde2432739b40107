// SPDX-License-Identifier: GPL-3.0-or-later
// checksums.sfv: a line "NAME CRC32" for each file of a run once it is complete, so that damage
// shows. The format is Simple File Verification, which cksfv and rhash check as well.
//
//     Checksums checksums("out/bend");
//     checksums.add("particles/particles_000000.vtu");
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include <sinew/core/file.h>

namespace sinew {

struct Checksum {
  std::string name;  ///< relative to the list's folder
  std::uint32_t crc = 0;
};

/// The last one of each file, in the order of the list; none where there is no list. Throws bad
/// input where a line is none of a list.
std::vector<Checksum> read_checksums(const std::filesystem::path& folder);

/// The list of a run while it writes. If the program dies, the list is a prefix of it.
class Checksums {
 public:
  /// Starts the list in `folder` with `kept` of an older one. Throws not written.
  explicit Checksums(std::filesystem::path folder, const std::vector<Checksum>& kept = {});

  /// Adds a complete file, named relative to the folder. Throws bad input where it cannot be read,
  /// and not written.
  void add(const std::string& name);

 private:
  std::filesystem::path folder_;
  GrowingFile file_;
};

/// What the list says of the files as they are now.
struct VerifiedFiles {
  std::size_t files = 0;                      ///< listed ones
  std::vector<std::string> damaged, missing;  ///< names, relative to the folder
};

/// Reads all listed files. Throws bad input where there is no list, and as read_checksums() does.
VerifiedFiles verify_checksums(const std::filesystem::path& folder);

}  // namespace sinew
