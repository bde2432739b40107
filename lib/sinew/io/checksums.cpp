// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/io/checksums.h>

#include <libdeflate.h>
#include <charconv>
#include <sstream>
#include <unordered_map>
#include <utility>

#include <sinew/core/error.h>

namespace sinew {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t crc_digits = 8;
constexpr std::uint64_t largest_list = 1 << 30;  // bytes

fs::path list_in(const fs::path& folder) { return folder / "checksums.sfv"; }

std::uint32_t crc_of(const fs::path& path) {
  std::uint32_t crc = 0;
  read_through(path, [&](std::string_view piece) {
    crc = libdeflate_crc32(crc, piece.data(), piece.size());
  });
  return crc;
}

std::string line_of(const Checksum& file) {
  std::string line = file.name + ' ' + std::string(crc_digits, '0') + '\n';
  std::uint32_t crc = file.crc;
  for (std::size_t at = line.size() - 2; crc > 0; --at, crc >>= 4)
    line[at] = "0123456789ABCDEF"[crc & 15];
  return line;
}

/// "NAME CRC32", of a file below the folder of the list.
Checksum checksum_in(const std::string& line, const Place& place) {
  const auto space = line.rfind(' ');
  Checksum file{line.substr(0, std::min(space, line.size())), 0};
  const char* const end = line.data() + line.size();
  const bool sized = space != line.npos && line.size() - space - 1 == crc_digits;
  const bool below = fs::path(file.name).is_relative() && file.name.find("..") == line.npos;
  if (sized && below) {
    const auto read = std::from_chars(end - crc_digits, end, file.crc, 16);
    if (read.ec == std::errc() && read.ptr == end) return file;
  }
  throw bad_input(place, "is no line of a list of checksums", "run the scene again with --force");
}

/// Replaces the list atomically; its size in bytes.
std::uint64_t begun_list(const fs::path& folder, const std::vector<Checksum>& kept) {
  std::string lines = "; CRC-32 of the files of this run; sinew info DIR --verify checks them\n";
  for (const Checksum& file : kept) lines += line_of(file);
  write_file(list_in(folder), lines);
  return lines.size();
}

}  // namespace

std::vector<Checksum> read_checksums(const fs::path& folder) {
  std::error_code unreachable;
  const fs::path path = list_in(folder);
  if (!fs::exists(path, unreachable)) return {};
  std::vector<Checksum> files;
  std::unordered_map<std::string, std::size_t> known;
  std::istringstream text(read_file(path, largest_list));
  int number = 0;
  for (std::string line; std::getline(text, line);) {
    ++number;
    if (line.empty() || line.front() == ';') continue;  // a comment
    Checksum file = checksum_in(line, {path.string(), number});
    const auto [at, is_new] = known.emplace(file.name, files.size());
    if (is_new)
      files.push_back(std::move(file));
    else
      files[at->second] = std::move(file);
  }
  return files;
}

Checksums::Checksums(fs::path folder, const std::vector<Checksum>& kept)
    : folder_(std::move(folder)), file_(list_in(folder_), begun_list(folder_, kept)) {}

void Checksums::add(const std::string& name) {
  const std::string line = line_of({name, crc_of(folder_ / name)});
  file_.add(line.data(), line.size());
}

VerifiedFiles verify_checksums(const fs::path& folder) {
  const std::vector<Checksum> listed = read_checksums(folder);
  if (listed.empty())
    throw bad_input({list_in(folder).string()}, "lists no files",
                    "give the folder of a run that wrote frames");
  VerifiedFiles verified;
  verified.files = listed.size();
  for (const Checksum& file : listed) {
    std::error_code unreachable;
    if (!fs::exists(folder / file.name, unreachable))
      verified.missing.push_back(file.name);
    else if (crc_of(folder / file.name) != file.crc)
      verified.damaged.push_back(file.name);
  }
  return verified;
}

}  // namespace sinew
