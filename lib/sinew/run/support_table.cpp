// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/run/support_table.h>

#include <string>

#include <sinew/core/text.h>

namespace sinew {
namespace {

constexpr const char* columns =
    "time,name,kind,force_x,force_y,force_z,moment_x,moment_y,moment_z,power,displacement_x,"
    "displacement_y,displacement_z,pivot_x,pivot_y,pivot_z";

std::string row_of(double time, const std::string& name, const SupportFrame& now,
                   const Vec3& pivot) {
  std::string row = number_text(time) + ',' + csv_cell(name) + (now.load ? ",load" : ",support");
  add_cells(now.force, row);
  add_cells(now.moment, row);
  add_cell(now.power, row);
  add_cells(now.displacement, row);
  add_cells(pivot, row);
  return row + '\n';
}

SupportFrame frame_of(bool load, const Vec3& place, const Vec3& rest, const Reaction& on) {
  return {load, place, place - rest, on.force, on.moment, on.power};
}

Vec3 mean_of(const Support& support, const Points& places) {
  Vec3 sum = Vec3::Zero();
  for (const std::uint32_t i : support.particles) sum += places[i];
  return sum / static_cast<double>(support.particles.size());
}

Vec3 mean_of(const Load& load, const Points& places) {
  Vec3 sum = Vec3::Zero();
  for (std::size_t n = 0; n < load.particles.size(); ++n)
    sum += load.weight[n] * places[load.particles[n]];
  return sum;
}

}  // namespace

std::vector<SupportFrame> support_frames(const World& world, const MachineMoment& now,
                                         const Points& rest) {
  std::vector<SupportFrame> frames;
  for (std::size_t k = 0; k < world.supports.size(); ++k)
    frames.push_back(frame_of(false, mean_of(world.supports[k], now.positions),
                              mean_of(world.supports[k], rest), now.support_reactions[k]));
  for (std::size_t k = 0; k < world.loads.size(); ++k)
    frames.push_back(frame_of(true, mean_of(world.loads[k], now.positions),
                              mean_of(world.loads[k], rest), now.load_reactions[k]));
  return frames;
}

SupportTable::SupportTable(const std::filesystem::path& path, const World& world, std::size_t kept)
    : world_(world), table_(path, columns, world.supports.size() + world.loads.size(), kept) {}

void SupportTable::add(const MachineMoment& now, std::span<const SupportFrame> frames) {
  std::string rows;
  const std::size_t supports = world_.supports.size();
  for (std::size_t k = 0; k < supports; ++k)
    rows += row_of(now.time, world_.supports[k].name, frames[k], now.supports[k].frame.origin);
  for (std::size_t k = 0; k < world_.loads.size(); ++k)
    rows += row_of(now.time, world_.loads[k].name, frames[supports + k], world_.loads[k].pivot);
  table_.add(rows);
}

}  // namespace sinew
