// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/bone_table.h"

#include "core/number_text.h"

namespace sinew {
namespace {

/// In quotes where a comma or a quote would end it (RFC 4180).
std::string cell(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == text.npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + '"';
}

void add_numbers(const Vec3& vector, std::string& row) {
  for (const double value : vector) row += ',' + number_text(value);
}

}  // namespace

BoneTable::BoneTable(const std::filesystem::path& path) : file_(path) {
  const std::string head = "time,bone,force_x,force_y,force_z,moment_x,moment_y,moment_z,power\n";
  file_.write(head.data(), head.size());
}

void BoneTable::add(double time, const Skeleton& skeleton, const Reactions& reactions,
                    std::span<const double> power) {
  std::string rows;
  for (std::size_t b = 0; b < skeleton.size(); ++b) {
    rows += number_text(time) + ',';
    rows += cell(skeleton.bones[b].name);
    add_numbers(reactions.force[b], rows);
    add_numbers(reactions.moment[b], rows);
    rows += ',' + number_text(power[b]) + '\n';
  }
  file_.write(rows.data(), rows.size());
}

void BoneTable::close() { file_.finish(); }

}  // namespace sinew
