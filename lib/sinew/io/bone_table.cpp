// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/io/bone_table.h>

#include <sinew/core/text.h>

namespace sinew {
namespace {

void add_numbers(const BoneRow& on, std::string& row) {
  add_cells(on.force, row);
  add_cells(on.moment, row);
  add_cell(on.power, row);
}

std::string columns_line() {
  std::string line = "time,bone";
  for (const char* part : {"", "spring_", "pin_", "obstacle_"})
    for (const char* value :
         {"force_x", "force_y", "force_z", "moment_x", "moment_y", "moment_z", "power"})
      line += std::string(",") + part + value;
  return line;
}

}  // namespace

BoneTable::BoneTable(const std::filesystem::path& path, std::size_t bones, std::size_t kept)
    : table_(path, columns_line(), bones, kept) {}

void BoneTable::add(double time, const Skeleton& skeleton, std::span<const BoneRow> sums,
                    const std::array<std::span<const BoneRow>, 3>& parts) {
  std::string rows;
  for (std::size_t b = 0; b < skeleton.size(); ++b) {
    rows += number_text(time) + ',';
    rows += csv_cell(skeleton.bones[b].name);
    add_numbers(sums[b], rows);
    for (const auto& part : parts)
      add_numbers(part.empty() ? BoneRow{Vec3::Zero(), Vec3::Zero(), 0} : part[b], rows);
    rows += '\n';
  }
  table_.add(rows);
}

}  // namespace sinew
