// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/run/frame_writer.h>

#include <algorithm>
#include <array>
#include <set>
#include <utility>

#include <sinew/core/error.h>
#include <sinew/core/local_origin.h>
#include <sinew/io/gltf/moving_surface.h>
#include <sinew/io/series_table.h>
#include <sinew/run/run_files.h>
#include <sinew/settings/text_file.h>

namespace sinew {
namespace {

VtuFormat format_of(const OutputSettings& output, std::string_view series, double radius) {
  VtuFormat format;
  format.encoding = output.encoding;
  format.double_precision = output.double_precision;
  format.series = series;
  format.radius = radius;
  return format;
}

/// Whether a series has the frames with particles alone.
bool is_thinned(std::string_view series) {
  return find_series(series)->frames == SeriesFrames::with_particles;
}

std::vector<double> each(std::size_t nth, std::span<const double> times) {
  std::vector<double> some;
  for (std::size_t i = 0; i < times.size(); i += nth) some.push_back(times[i]);
  return some;
}

/// Creates the folder as well.
std::deque<Series> begun_series(const std::filesystem::path& folder, const OutputSettings& output,
                                const std::vector<std::string_view>& names, double radius,
                                std::span<const double> kept) {
  const auto every = static_cast<std::size_t>(output.every);
  std::deque<Series> series;
  for (const std::string_view name : names)
    series.emplace_back(folder, format_of(output, name, radius),
                        each(is_thinned(name) ? every : 1, kept));
  return series;
}

/// Forces of the bones on the body.
std::vector<BoneRow> rows_of(const std::vector<Reaction>& reactions) {
  std::vector<BoneRow> rows;
  rows.reserve(reactions.size());
  for (const Reaction& on : reactions) rows.push_back({-on.force, -on.moment, on.power});
  return rows;
}

}  // namespace

FrameWriter::FrameWriter(const std::filesystem::path& folder, const OutputSettings& output,
                         const Body& body, const FrameScene& scene, std::span<const double> kept,
                         StrainInFrames strain)
    : folder_(folder),
      body_(body),
      data_(output, body, scene, strain),
      every_(static_cast<std::size_t>(output.every)),
      taken_(kept.size()),
      series_(begun_series(folder, output, data_.series(), body.material.pair.r, kept)),
      bone_table_(folder / "bones.csv", body.skeleton.size(), kept.size()),
      faces_(scene.surface.faces),
      written_(static_cast<int>(kept.size())) {
  if (find("supports") != nullptr)
    support_table_.emplace(folder / "supports.csv", *body.world, kept.size());
  if (!scene.probes.empty()) probe_table_.emplace(folder / "probes.csv", scene.probes, kept.size());
  if (output.export_surface) begin_export(scene.surface, kept.size(), scene.look);
  begin_checksums();
}

const Series* FrameWriter::find(std::string_view series) const {
  const auto found = std::find_if(series_.begin(), series_.end(),
                                  [&](const Series& one) { return one.name() == series; });
  return found == series_.end() ? nullptr : &*found;
}

/// Begins with checksums of kept frames, and of what was written before the frames.
void FrameWriter::begin_checksums() {
  std::set<std::string> begun{"body.vtu", "scene.yaml"};
  std::error_code none;
  for (const auto& mesh : std::filesystem::directory_iterator(folder_ / "meshes", none))
    if (mesh.is_regular_file(none)) begun.insert("meshes/" + mesh.path().filename().string());
  std::set<std::string> stay = begun;
  for (const Series& series : series_) {
    for (const PvdRow& row : series.rows()) stay.insert(row.file);
    listed_.push_back(series.rows().size());
  }
  std::vector<Checksum> kept;
  if (written_ > 0) kept = read_checksums(folder_);
  std::erase_if(kept, [&](const Checksum& file) { return !stay.contains(file.name); });
  checksums_.emplace(folder_, kept);
  if (written_ > 0) return;
  for (const std::string& name : begun)
    if (std::filesystem::exists(folder_ / name)) checksums_->add(name);
}

void FrameWriter::list_new_frames() {
  for (std::size_t k = 0; k < series_.size(); ++k) {
    for (const auto& rows = series_[k].rows(); listed_[k] < rows.size(); ++listed_[k])
      checksums_->add(rows[listed_[k]].file);
  }
}

void FrameWriter::begin_export(const Triangles& surface, std::size_t kept, SurfaceLook look) {
  look_ = std::move(look);
  for (std::string& library : look_.libraries) library = path_in(folder_, library);
  write_obj(folder_ / "surface.obj", surface, look_);
  export_origin_ = local_origin(bounds(surface.points));
  export_ = std::make_unique<PointCache>(folder_ / "surface.pc2", surface.points.size(), kept,
                                         export_origin_);
}

FrameWriter::FrameWriter(const std::filesystem::path& folder, const OutputSettings& output,
                         const Prepared& prepared)
    : FrameWriter(folder, output, prepared.body,
                  {prepared.surface.triangles, prepared.obstacles, prepared.look, prepared.probes,
                   prepared.body.neighbors, cells_to_write(prepared)}) {}

void FrameWriter::add(Simulation& simulation, double time, bool begun) {
  writer_.hand([&] {  // there is no other frame now: each takes as much memory as stepping does
    data_.take(simulation, time, taken_++ % every_ == 0);
    return [this, begun] { write(begun); };
  });
}

void FrameWriter::write(bool begun) {
  const FrameMoment& now = data_.now();
  if (support_table_) write_supports();
  if (probe_table_) write_probes(now);
  for (Series& series : series_)
    if (now.with_particles || !is_thinned(series.name())) write_series(series, begun);
  const std::vector<Reaction> sums = now.reactions.sums();
  const auto springs = rows_of(now.reactions.springs), pins = rows_of(now.reactions.pins),
             obstacles = rows_of(now.reactions.obstacles);
  bone_table_.add(now.moment.time, body_.skeleton, rows_of(sums), {springs, pins, obstacles});
  list_new_frames();
  ++written_;
}

void FrameWriter::write_supports() {
  const MachineMoment now = data_.machine();
  support_table_->add(now, support_frames(*body_.world, now, body_.rest));
}

void FrameWriter::write_probes(const FrameMoment& now) {
  static constexpr std::array<std::string_view, 2> tensors = {"strain", "stress"};
  const std::vector<Column> found = data_.measured(tensors);
  const Points& world = now.forces.world;
  Points force(world.size());
  for (std::size_t i = 0; i < world.size(); ++i)
    force[static_cast<std::size_t>(now.particles.id[i])] = world[i];
  probe_table_->add(now.moment.time, now.positions, body_.rest,
                    {std::get<std::vector<double>>(found[0].values),
                     std::get<std::vector<double>>(found[1].values), force});
}

void FrameWriter::write_series(Series& series, bool begun) {
  const bool finishes = begun && &series == &series_.front();
  data_.lend(series.name(), [&](const Dataset& frame) {
    finishes ? series.finish(frame) : series.add(frame);
    if (export_ && series.name() == "surface") export_->add(frame.points);
  });
}

void FrameWriter::close() {
  writer_.finish();
  data_.forget();
  series_.front().drop_begun();
  for (Series& series : series_) {
    series.close();
    if (written_ == 0) continue;  // it has no row, and is none
    for (const std::string& list : series_files(series.name())) checksums_->add(list);
  }
  bone_table_.close();
  checksums_->add("bones.csv");
  if (support_table_) {
    support_table_->close();
    checksums_->add("supports.csv");
  }
  if (probe_table_) {
    probe_table_->close();
    checksums_->add("probes.csv");
  }
  if (!export_) return;
  export_->close();
  for (const char* name : {"surface.obj", "surface.pc2"}) checksums_->add(name);
  if (!export_origin_.isZero(0)) checksums_->add("surface.pc2.origin.json");
  if (written_ == 0) return;  // nothing moves
  std::vector<double> times;
  for (const PvdRow& row : find("surface")->rows()) times.push_back(row.time);
  write_moving_surface(folder_ / "surface.glb", faces_, folder_ / "surface.pc2", times, look_,
                       export_origin_);
  checksums_->add("surface.glb");
}

}  // namespace sinew
