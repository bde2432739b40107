// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/blowup.h"

#include "io/vtu.h"

namespace sinew {

Dataset blowup_dataset(const BlowupFrame& frame, Moment moment) {
  const Particles& before = frame.before;
  const std::size_t n = before.size();
  Points displacement(n), velocity(n);
  Dataset data;
  data.time = moment.time;
  data.cycle = moment.cycle;
  data.points.resize(n);
  for (std::size_t i = 0; i < n; ++i) {
    const auto id = static_cast<std::size_t>(before.id[i]);
    data.points[id] = before.position(i);
    displacement[id] = before.position(i) - frame.rest[id];
    velocity[id] = before.velocity(i);
  }
  std::vector<std::int32_t> offence;
  for (const Offence one : frame.offence) offence.push_back(static_cast<std::int32_t>(one));
  data.connectivity = vertex_cells(n);
  data.point_columns = {
      column("id", vertex_cells(n)),
      column("bone", std::vector<std::int32_t>(frame.bone.begin(), frame.bone.end())),
      column("radius", std::vector<double>(n, before.radius)),
      column("displacement", displacement),
      column("velocity", velocity),
      column("offender", std::move(offence)),
      column("moved", std::vector<double>(frame.moved.begin(), frame.moved.end()))};
  return data;
}

void write_blowup(const std::filesystem::path& path, const BlowupFrame& frame, Moment moment) {
  VtuFormat format;
  format.series = "blowup";
  format.radius = frame.before.radius;
  write_vtu(path, blowup_dataset(frame, moment), format);
}

}  // namespace sinew
