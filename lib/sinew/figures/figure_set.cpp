// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/figures/figure_set.h>

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include <sinew/core/error.h>
#include <sinew/core/system.h>
#include <sinew/core/text.h>
#include <sinew/render/figure.h>
#include <sinew/render/movie.h>
#include <sinew/run/run_record.h>
#include <sinew/run/world_shown.h>
#include <sinew/scene/check/needs.h>

namespace sinew {
namespace {

std::string numbered(std::size_t frame) {
  const std::string digits = std::to_string(frame);
  return std::string(6 - std::min<std::size_t>(6, digits.size()), '0') + digits;
}

void check_times(const std::vector<double>& times, const RunFiles& run) {
  constexpr double slack = 1e-6;  // fraction of the run: times are typed in a few digits
  const double first = run.particle_rows.front().time,
               last = run.particle_rows[run.frames() - 1].time;
  for (const double time : times)
    if (!(time >= first && time <= last + slack * (last - first)))
      throw bad_input("there is no picture at " + number_text(time) + " s",
                      "give times from " + number_text(first) + " to " + number_text(last) +
                          " s, as --times " + number_text(first) + ',' + number_text(last));
}

struct Label {
  std::string_view array, words;
};
constexpr std::array<Label, 11> labels = {{{"strain", "equivalent strain"},
                                           {"strain_eq", "equivalent strain"},
                                           {"von_mises", "von Mises stress"},
                                           {"stress", "largest principal stress"},
                                           {"stretch", "largest stretch"},
                                           {"J", "change of volume J"},
                                           {"D2min", "non-affine motion D2min"},
                                           {"force_pair", "force of neighbors"},
                                           {"force_damping", "force of damping"},
                                           {"force_bone", "force of bones"},
                                           {"pose_error", "distance from the bones' pose"}}};

/// What an array shows, in words.
std::string label_of(const std::string& array) {
  for (const Label& label : labels)
    if (label.array == array) return std::string(label.words);
  return array;
}

std::string grouped_by_thousands(std::size_t count) {
  std::string digits = std::to_string(count);
  for (std::size_t place = digits.size(); place > 3; place -= 3) digits.insert(place - 3, ",");
  return digits;
}

/// What a run is of, as the title of its pictures.
std::string subject_of(const DrawnRun& run) {
  const Particles& particles = run.files().body.particles;
  const bool paper = run.files().settings.material.model == MaterialModel::paper;
  return scene_name(run.files().folder) + ":  " + grouped_by_thousands(particles.size()) +
         " particles of radius r = " + three_digits(1e3 * particles.radius) + " mm, " +
         (paper ? "the paper's material" : "bonded");
}

}  // namespace

void check_memory(int width, int height, double available) {
  const double needed = memory_of_picture(width, height);
  if (needed <= available) return;
  throw bad_input("pictures of " + std::to_string(width) + " x " + std::to_string(height) +
                      " pixels need about " + bytes_text(needed) + " of memory, " +
                      bytes_text(available) + " are free",
                  "choose a smaller --width and --height");
}

FigureSet::FigureSet(std::vector<const DrawnRun*> runs, std::size_t preset,
                     FigureSetOptions options)
    : runs_(std::move(runs)), preset_(preset), options_(std::move(options)) {
  check_times(options_.times, runs_.front()->files());
  if (options_.range && drawn(0).pulls)
    throw bad_input("the colors of the view binding have no range",
                    "leave out --range, or choose another view: --view forces");
  check_memory(options_.width, options_.height, available_memory());
  for (const DrawnRun* run : runs_) painters_.emplace_back(run->files().surface, scale());
}

/// Says how strong a pull the longest arrow of a run is.
std::string FigureSet::arrow_scale(std::size_t run) const {
  if (drawn(run).preset.view == View::arrows)
    return ", longest arrow " + quantity_text(drawn(run).range.high, drawn(run).unit());
  if (!drawn(run).pulls) return "";
  if (!drawn(run).is_pulled()) return ", no force";
  return ", longest arrow " + quantity_text(drawn(run).range.high, "N");
}

ColorScale FigureSet::scale() const {
  if (drawn(0).pulls) {
    ColorScale scale{"force of the bone", "", 0, 2};
    if (runs_.size() == 1) scale.name += arrow_scale(0);  // else in the runs' titles
    scale.names = {"radial", "twist", "axial"};
    scale.colors.assign(palette::pulls.begin(), palette::pulls.end());
    return scale;
  }
  ColorScale scale{label_of(drawn(0).name()), drawn(0).unit(), drawn(0).range.low,
                   drawn(0).range.high, options_.colors};
  for (std::size_t run = 1; run < runs_.size(); ++run) {
    scale.low = std::min(scale.low, drawn(run).range.low);
    scale.high = std::max(scale.high, drawn(run).range.high);
  }
  if (drawn(0).name() == "material") {
    scale.names = names_of_materials(runs_.front()->files());
    scale.low = 0, scale.high = std::max(1.0, static_cast<double>(scale.names.size()) - 1);
  }
  if (drawn(0).preset.view == View::arrows) scale.note = arrow_scale(0);
  if (scale.note.empty() && !options_.range && scale.names.empty() && scale.high > scale.low)
    scale.note = ", 0.5th to 99.5th percentile";
  if (options_.range) scale.low = options_.range->low, scale.high = options_.range->high;
  if (!(scale.high > scale.low)) scale.high = scale.low + 1;  // nothing moves
  return scale;
}

/// Frames of the first run.
std::vector<KeyMoment> FigureSet::moments() const {
  if (options_.times.empty()) return runs_.front()->key_moments();
  std::vector<KeyMoment> asked;
  for (const double time : options_.times) asked.push_back({runs_.front()->frame_at(time), ""});
  return asked;
}

/// Takes a snapshot of each run, at the time of the first one's frame.
std::vector<Snapshot> FigureSet::snapshots(std::size_t frame) const {
  const double time = runs_.front()->files().particle_rows[frame].time;
  std::vector<Snapshot> snapshots;
  for (std::size_t run = 0; run < runs_.size(); ++run)
    snapshots.push_back(runs_[run]->snapshot(runs_[run]->frame_at(time), drawn(run)));
  return snapshots;
}

std::string FigureSet::title(std::size_t run) const {
  return runs_.size() > 1 ? runs_[run]->name() + arrow_scale(run) : "";
}

/// What a moment shows. How each of two runs has come back stands beside its own name.
std::string FigureSet::words_of(const KeyMoment& moment) const {
  return runs_.size() > 1 && moment.what.starts_with("returned") ? "the end" : moment.what;
}

std::string FigureSet::row_title(std::size_t run) const {
  const std::string returned = runs_[run]->return_in_words();
  return runs_.size() == 1 || returned.empty() ? title(run) : title(run) + ":  " + returned;
}

std::string FigureSet::name() const {
  return (runs_.size() > 1 ? "compare_" : "") + std::string(drawn(0).preset.name);
}

FigureOptions FigureSet::figure_options(Finish finish) const {
  FigureOptions figure;
  figure.camera.view = options_.view;
  for (const DrawnRun* run : runs_) figure.camera.frame.extend(run->overview().frame);
  figure.width = options_.width;
  figure.height = options_.height;
  figure.finish = finish;
  figure.paper = options_.files.backdrop.paper;
  figure.axes = options_.axes;
  return figure;
}

/// It turns evenly from the first frame to the last.
Camera FigureSet::movie_camera(std::size_t frame) const {
  const double turned = options_.orbit * static_cast<double>(frame) /
                        static_cast<double>(std::max<std::size_t>(2, movie_frames()) - 1);
  Cylinder around = runs_.front()->overview().around;
  for (const DrawnRun* run : runs_) around.extend(run->overview().around);
  return orbiting(around, options_.view, turned);
}

std::vector<Panel> FigureSet::panels(const std::vector<Snapshot>& snapshots) {
  std::vector<Panel> panels;
  for (std::size_t run = 0; run < snapshots.size(); ++run)
    panels.push_back({&painters_[run], &snapshots[run], drawn(run).preset.view, title(run)});
  return panels;
}

/// At the moments, of each run; pictures and sheet share what is read.
const std::vector<std::vector<Snapshot>>& FigureSet::at_moments() {
  if (at_moments_.empty())
    for (const KeyMoment& moment : moments()) at_moments_.push_back(snapshots(moment.frame));
  return at_moments_;
}

int FigureSet::pictures() {
  const std::vector<KeyMoment> chosen = moments();
  FigureOptions options = figure_options(Finish::fine);
  options.camera.frame = {};
  for (const std::vector<Snapshot>& moment : at_moments())
    for (const Snapshot& snapshot : moment)
      options.camera.frame.extend(seen(options_.view, snapshot));
  for (std::size_t k = 0; k < chosen.size(); ++k) {
    const std::size_t frame = chosen[k].frame;
    const std::string what = words_of(chosen[k]);
    std::vector<Snapshot> moment = at_moments()[k];
    if (!what.empty()) moment.front().caption = what + ",  " + moment.front().caption;
    const auto on = [&](const Paper& paper) {
      options.paper = paper;
      return figure(panels(moment), options);
    };
    write_page(on, options_.files, place(name() + '_' + numbered(frame) + ".png"));
    options_.drawn();
  }
  return static_cast<int>(chosen.size());
}

/// Whether the sheet shows a cloud of dots rather than spheres.
bool FigureSet::particles_are_small(const SheetOptions& sheet) const {
  constexpr double smallest = 7;  // pixels across
  const Vec3 size = runs_.front()->overview().frame.sizes();
  const double scale = std::min(sheet.row_height / size.y(),
                                sheet.width / (size.x() * static_cast<double>(moments().size())));
  return 2 * runs_.front()->files().body.particles.radius * scale < smallest;
}

/// The body at the same moments, cut open; none where its cells would take long or cannot be made.
std::vector<Snapshot> FigureSet::cut_open() const {
  constexpr std::size_t many = 200'000;  // particles, whose cells take 3 s
  const DrawnRun& run = *runs_.front();
  if (run.files().body.particles.size() > many) return {};
  std::vector<Snapshot> snapshots;
  try {
    const DrawnView cut = run.cut_open(drawn(0));
    for (const KeyMoment& moment : moments()) snapshots.push_back(run.snapshot(moment.frame, cut));
  } catch (const Error&) {  // particles that are not written, or a mesh that is not there
    return {};
  }
  return snapshots;
}

void FigureSet::sheet() {
  const std::vector<KeyMoment> chosen = moments();
  std::vector<std::vector<Snapshot>> over_time(runs_.size());
  for (std::size_t k = 0; k < chosen.size(); ++k) {
    std::vector<Snapshot> moment = at_moments()[k];
    moment.front().caption += '\n' + words_of(chosen[k]);
    for (std::size_t run = 0; run < runs_.size(); ++run)
      over_time[run].push_back(std::move(moment[run]));
  }
  SheetOptions sheet;
  sheet.view = options_.view;
  sheet.axes = options_.axes;
  sheet.rulers = true;
  sheet.strongest_force = runs_.front()->strongest_force();
  if (runs_.size() == 1) sheet.title = subject_of(*runs_.front());
  if (runs_.size() == 1 && !of_body())
    sheet.title += '\n' + name() + ":  " + std::string(drawn(0).preset.help);
  const auto write = [&](const std::vector<SheetRow>& rows, const std::string& file) {
    const auto on = [&](const Paper& paper) {
      sheet.paper = paper;
      return contact_sheet(rows, sheet);
    };
    write_page(on, options_.files, place(file));
  };
  // Several moments need more space.
  sheet.width = std::min(largest_picture, options_.width * 5 / 4);
  sheet.row_height = options_.height * 7 / 9;
  if (of_body()) {
    std::vector<SheetRow> rows = surface_above_particles(painters_[0], over_time[0]);
    std::vector<Snapshot> cuts;
    if (particles_are_small(sheet)) cuts = cut_open();
    if (!cuts.empty()) rows[1] = {&painters_[0], &cuts, View::cut, ""};
    return write(rows, "contact_sheet.png");
  }
  std::vector<SheetRow> rows;
  for (std::size_t run = 0; run < runs_.size(); ++run)
    rows.push_back({&painters_[run], &over_time[run], drawn(run).preset.view, row_title(run)});
  write(rows, name() + "_sheet.png");
}

std::size_t FigureSet::movie_frames() const { return runs_.front()->files().frames(); }

MovieOptions FigureSet::movie_options() const {
  MovieOptions movie;
  movie.width = options_.width & ~1;  // H.264 requires even sizes
  movie.height = options_.height & ~1;
  const double interval = runs_.front()->files().settings.output.interval;
  movie.frames_per_second = std::clamp(1 / interval, 0.1, 240.0);
  return movie;
}

Image FigureSet::movie_frame(std::size_t frame) {
  FigureOptions options = figure_options(Finish::quick);
  options.width = movie_options().width;
  options.height = movie_options().height;
  if (options_.orbit != 0) options.camera = movie_camera(frame);
  const std::vector<Snapshot> moment = snapshots(frame);
  std::vector<Panel> side_by_side = panels(moment);
  if (of_body())
    side_by_side = {{&painters_[0], &moment[0], View::surface, ""},
                    {&painters_[0], &moment[0], View::particles, ""}};
  return figure(side_by_side, options).pixels();
}

void FigureSet::movie(std::span<const FrameSource> others) {
  Movie playback(place(of_body() ? "movie.mp4" : name() + ".mp4"), movie_options());
  for (std::size_t frame = 0; frame < movie_frames(); ++frame) {
    const std::size_t source = frame % (others.size() + 1);
    playback.add(source == 0 ? movie_frame(frame) : others[source - 1](frame));
    options_.drawn();
  }
  playback.finish();
}

}  // namespace sinew
