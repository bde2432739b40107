// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/run/volume_frames.h>

#include <algorithm>
#include <type_traits>
#include <utility>

#include <sinew/core/arrays.h>
#include <sinew/core/error.h>
#include <sinew/core/particles.h>
#include <sinew/fill/fill_warnings.h>
#include <sinew/io/checksums.h>
#include <sinew/io/series.h>
#include <sinew/io/vtu.h>
#include <sinew/material/laws.h>
#include <sinew/scene/body_mesh.h>
#include <sinew/scene/filling.h>

namespace sinew {

Dataset VolumeFrames::at(const Dataset& particles, const std::vector<char>& apart) const {
  const VolumeCells& rest = cells_.rest();
  Dataset data = dataset_of(rest);
  data.time = particles.time;
  data.cycle = particles.cycle;
  data.meta = particles.meta;
  data.points = cells_.at(particles.points);
  for (const Column& of_particles : particles.point_columns) {
    if (of_particles.name == "id") continue;
    Column found = cells_.at_points(of_particles);
    if (found.name == "displacement") {
      auto& values = std::get<std::vector<double>>(found.values);
      for (std::size_t i = 0; i < rest.id.size(); ++i)
        for (int axis = 0; axis < 3 && rest.id[i] < 0; ++axis)
          values[3 * i + axis] = data.points[i][axis] - rest.points[i][axis];
    }
    data.point_columns.push_back(std::move(found));
  }
  std::vector<double> ratios = cells_.volume_ratios(data.points);
  std::vector<std::int32_t> torn = cells_.torn(apart, ratios);
  data.cell_columns = {column("J", std::move(ratios)), column("torn", std::move(torn))};
  return data;
}

std::vector<char> VolumeFrames::apart_beyond(const Points& positions, double range) const {
  const auto& pairs = cells_.pairs();
  std::vector<char> apart(pairs.size());
  for (std::size_t k = 0; k < pairs.size(); ++k)
    apart[k] = cells_.touching()[k] &&
               (positions[pairs[k][0]] - positions[pairs[k][1]]).squaredNorm() >= range * range;
  return apart;
}

std::vector<char> apart_if_broken(std::span<const ParticlePair> pairs,
                                  std::span<const ParticlePair> broken) {
  std::vector<char> apart(pairs.size());
  for (std::size_t k = 0; k < pairs.size(); ++k)
    apart[k] = std::binary_search(broken.begin(), broken.end(), pairs[k]);
  return apart;
}

Dataset in_single_precision(Dataset particles, double radius) {
  if (!beyond_float32(particles.points, radius))
    for (Vec3& point : particles.points) point = point.cast<float>().cast<double>();
  for (Column& one : particles.point_columns) {
    const WrittenArray* row = find_written("particles", ArrayPlace::point, one.name);
    if (row != nullptr && row->numbers == ArrayNumbers::exact) continue;
    if (auto* values = std::get_if<std::vector<double>>(&one.values))
      for (double& value : *values) value = static_cast<float>(value);
  }
  return particles;
}

std::optional<VolumeCells> cells_to_write(const Prepared& prepared) {
  if (!prepared.settings.output.volume) return std::nullopt;
  return cells_of_body(prepared.settings, prepared.surface, prepared.body.rest,
                       prepared.body.material.pair.r);
}

std::optional<std::string> lost_by_cells(const VolumeCells& cells, const Particles& particles,
                                         double density, const Surface& surface) {
  const double volume = particles.mass * static_cast<double>(particles.size()) / density;
  return cell_warning(quality_of(cells).volume, volume, particles.radius, surface);
}

namespace {

/// The bones of particles as the run has written them.
Binding binding_of(const std::vector<std::int32_t>& bones) {
  Binding binding;
  binding.first = {0};
  for (const std::int32_t bone : bones) {
    if (bone >= 0) binding.influences.push_back({bone, 1, 0});
    binding.first.push_back(static_cast<std::uint32_t>(binding.influences.size()));
  }
  return binding;
}

/// The longest pairs of each particle that has lost bonds, as many as it has lost, where this holds
/// for both.
std::vector<char> apart_by_counts(std::span<const ParticlePair> pairs, const Points& now,
                                  const std::vector<std::int32_t>& lost) {
  std::vector<std::vector<std::pair<double, std::size_t>>> of_particle(lost.size());
  for (std::size_t k = 0; k < pairs.size(); ++k)
    for (const std::uint32_t i : pairs[k])
      if (lost[i] > 0) of_particle[i].push_back({-(now[pairs[k][0]] - now[pairs[k][1]]).norm(), k});
  std::vector<char> ends(pairs.size());
  for (std::size_t i = 0; i < lost.size(); ++i) {
    std::sort(of_particle[i].begin(), of_particle[i].end());
    const std::size_t count = std::min(of_particle[i].size(), static_cast<std::size_t>(lost[i]));
    for (std::size_t n = 0; n < count; ++n) ++ends[of_particle[i][n].second];
  }
  for (char& end : ends) end = end == 2;
  return ends;
}

/// The broken ones of a frame of bonds.
std::vector<ParticlePair> broken_in(const std::filesystem::path& file) {
  const Dataset data = read_vtu(file);
  const std::vector<std::int32_t>& broken = integers(data.cell_columns, "broken");
  std::vector<ParticlePair> pairs;
  for (std::size_t c = 0; c < broken.size() && 2 * c + 1 < data.connectivity.size(); ++c)
    if (broken[c])
      pairs.push_back({static_cast<std::uint32_t>(data.connectivity[2 * c]),
                       static_cast<std::uint32_t>(data.connectivity[2 * c + 1])});
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

VolumeFrames frames_of(const RunFiles& run, std::optional<std::string>& warning) {
  if (!run.ids.empty())
    throw bad_input(Place{run.folder.path.string()}, "has not written all particles",
                    "run the scene without output.region and output.inside_every");
  const Points rest = positions_of(run.body.particles);
  const double radius = run.body.particles.radius;
  const Surface surface = read_mesh(run.settings);
  VolumeCells cells = cells_of_body(run.settings, surface, rest, radius);
  warning = lost_by_cells(cells, run.body.particles, run.settings.material.density, surface);
  return {std::move(cells), rest, radius, run.skeleton, binding_of(*run.body.bone)};
}

std::vector<char> apart_in(const RunFiles& run, std::size_t frame, const Dataset& particles,
                           const VolumeFrames& volume) {
  const std::span<const ParticlePair> pairs = volume.pairs();
  if (!law_of(run.material).has_bonds)
    return volume.apart_beyond(particles.points, run.material.pair.b);
  if (frame < run.bond_rows.size())
    return apart_if_broken(pairs, broken_in(run.folder.path / run.bond_rows[frame].file));
  if (find(particles.point_columns, "broken_bonds"))
    return apart_by_counts(pairs, particles.points,
                           integers(particles.point_columns, "broken_bonds"));
  return std::vector<char>(pairs.size());
}

/// Adds the files to the list that a run's own folder has of its files.
void list_files(const std::filesystem::path& folder, const std::vector<PvdRow>& rows) {
  if (!std::filesystem::exists(folder / "checksums.sfv")) return;
  std::vector<Checksum> kept = read_checksums(folder);
  std::erase_if(kept, [](const Checksum& one) { return one.name.starts_with("volume"); });
  Checksums list(folder, kept);
  for (const PvdRow& row : rows) list.add(row.file);
  for (const std::string& of_volume : series_files("volume")) list.add(of_volume);
}

}  // namespace

RunVolume::RunVolume(const RunFiles& run) : run_(&run), frames_(frames_of(run, warning_)) {}

Dataset RunVolume::at(std::size_t index, const Dataset& particles) const {
  return frames_.at(particles, apart_in(*run_, index, particles, frames_));
}

ExportedVolume export_volume(const RunFiles& run, const std::vector<std::size_t>& frames,
                             const std::filesystem::path& folder) {
  const RunVolume volume(run);
  const OutputSettings& output = run.settings.output;
  Series series(folder, {.encoding = output.encoding,
                         .double_precision = output.double_precision,
                         .series = "volume",
                         .radius = run.body.particles.radius});
  for (const std::size_t frame : frames) {
    const auto file = run.folder.path / run.particle_rows[frame].file;
    const Dataset particles = read_vtu(file);
    if (particles.points.size() != run.body.particles.size())
      throw bad_input(Place{file.string()}, "is of another body",
                      "run the scene again with --force");
    series.add(volume.at(frame, particles));
  }
  series.close();
  if (std::filesystem::equivalent(folder, run.folder.path)) list_files(folder, series.rows());
  return {frames.size(), volume.cells(), folder / "volume.pvd", volume.warning()};
}

}  // namespace sinew
