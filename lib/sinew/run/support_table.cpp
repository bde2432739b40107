// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/run/support_table.h>

#include <string>

#include <sinew/core/text.h>

namespace sinew {
namespace {

constexpr const char* columns =
    "time,name,kind,force_x,force_y,force_z,moment_x,moment_y,moment_z,power,displacement_x,"
    "displacement_y,displacement_z,pivot_x,pivot_y,pivot_z";

/// One support or load.
struct MachinePart {
  const std::string& name;
  const char* kind;
  const Reaction& on_body;
  Vec3 displacement, pivot;
};

std::string row_of(double time, const MachinePart& part) {
  std::string row = number_text(time) + ',' + csv_cell(part.name) + ',' + part.kind;
  add_cells(part.on_body.force, row);
  add_cells(part.on_body.moment, row);
  add_cell(part.on_body.power, row);
  add_cells(part.displacement, row);
  add_cells(part.pivot, row);
  return row + '\n';
}

}  // namespace

SupportTable::SupportTable(const std::filesystem::path& path, const World& world, std::size_t kept)
    : world_(world), table_(path, columns, world.supports.size() + world.loads.size(), kept) {}

void SupportTable::add(const MachineMoment& now, const Points& rest) {
  std::string rows;
  for (std::size_t k = 0; k < world_.supports.size(); ++k) {
    const Support& support = world_.supports[k];
    Vec3 moved = Vec3::Zero();
    for (const std::uint32_t i : support.particles) moved += now.positions[i] - rest[i];
    moved /= static_cast<double>(support.particles.size());
    rows += row_of(now.time, {support.name, "support", now.of_supports[k], moved,
                              now.supports[k].frame.origin});
  }
  for (std::size_t k = 0; k < world_.loads.size(); ++k) {
    const Load& load = world_.loads[k];
    Vec3 moved = Vec3::Zero();
    for (std::size_t n = 0; n < load.particles.size(); ++n)
      moved += load.share[n] * (now.positions[load.particles[n]] - rest[load.particles[n]]);
    rows += row_of(now.time, {load.name, "load", now.of_loads[k], moved, load.pivot});
  }
  table_.add(rows);
}

}  // namespace sinew
