// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/io/series.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <set>
#include <string_view>
#include <utility>

#include <sinew/core/error.h>
#include <sinew/core/file.h>
#include <sinew/core/text.h>
#include <sinew/io/detail/xml.h>

namespace sinew {

namespace {

constexpr std::uint64_t largest_pvd = std::uint64_t{256} << 20;  // bytes

Error no_series(const std::string& what) { return bad_input(what, "use a PVD file of a run"); }

double time_of(const std::string& text) {
  double time = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), time);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(time))
    throw no_series("timestep '" + text.substr(0, 40) + "' is not a number");
  return time;
}

/// A PVD from elsewhere must not cause reads outside its folder.
void check_inside(const std::filesystem::path& file) {
  if (!stays_below(file))
    throw no_series("'" + file.string().substr(0, 200) + "' does not lie below the PVD's folder");
}

PvdRow row_of(const XmlElement& element) {
  const auto& given = element.attributes;
  if (!given.contains("timestep") || !given.contains("file"))
    throw no_series("a DataSet lacks its timestep or file");
  std::string file = given.at("file");
  std::replace(file.begin(), file.end(), '\\', '/');  // paths as Windows writes them
  check_inside(file);
  return {time_of(given.at("timestep")), std::move(file)};
}

std::vector<PvdRow> rows_of(const std::vector<XmlElement>& elements) {
  bool collection = false;
  std::vector<PvdRow> rows;
  for (const XmlElement& element : elements) {
    collection = collection || element.path == "VTKFile/Collection";
    if (element.path == "VTKFile/Collection/DataSet") rows.push_back(row_of(element));
  }
  if (!collection) throw no_series("it is not a PVD file");
  return rows;
}

}  // namespace

std::string pvd_text(const std::vector<PvdRow>& rows) {
  std::string text =
      "<?xml version=\"1.0\"?>\n"
      "<VTKFile type=\"Collection\" version=\"1.0\" byte_order=\"LittleEndian\">\n"
      "  <Collection>\n";
  for (const PvdRow& row : rows)
    text += "    <DataSet timestep=\"" + number_text(row.time) +
            "\" group=\"\" part=\"0\" file=\"" + row.file + "\"/>\n";
  return text + "  </Collection>\n</VTKFile>\n";
}

std::string series_text(const std::vector<PvdRow>& rows) {
  std::string text = "{\"file-series-version\": \"1.0\", \"files\": [";
  const char* before = "\n";
  for (const PvdRow& row : rows) {
    text += before + std::string("  {\"name\": \"") + row.file +
            "\", \"time\": " + number_text(row.time) + "}";
    before = ",\n";
  }
  return text + "\n]}\n";
}

std::vector<PvdRow> read_pvd(const std::filesystem::path& path) {
  const std::string text = read_file(path, largest_pvd);
  try {
    return rows_of(xml_elements(text));
  } catch (const Error& error) {
    throw error.with_context({path.string()});
  }
}

namespace {

namespace fs = std::filesystem;

/// Often enough to follow a run, rarely enough to be negligible beside the frames.
constexpr std::chrono::seconds pause_between_lists{1};

/// Whether a series of this name writes a file of this name: "body_000016.vtu", or its beginnings.
bool is_frame_of(const std::string& series, std::string_view name) {
  const auto takes = [&](std::string_view part) {
    const bool here = name.starts_with(part);
    if (here) name.remove_prefix(part.size());
    return here;
  };
  takes(".");
  if (!takes(series + "_")) return false;
  const std::size_t digits = std::min(name.find_first_not_of("0123456789"), name.size());
  name.remove_prefix(digits);
  if (digits < 6 || !takes(".vtu")) return false;
  takes(".tmp");
  return name.empty();
}

/// Only files that a series of this name writes; others are not removed.
void remove_older(const fs::path& folder, const std::string& series,
                  const std::vector<PvdRow>& kept) {
  std::set<std::string> stay;
  for (const PvdRow& row : kept) stay.insert(fs::path(row.file).filename().string());
  if (kept.empty())
    for (const std::string& list : series_files(series)) fs::remove(folder / list);
  for (const auto& entry : fs::directory_iterator(folder / series))
    if (const std::string name = entry.path().filename().string();
        is_frame_of(series, name) && !stay.contains(name))
      fs::remove(entry.path());
}

}  // namespace

std::array<std::string, 2> series_files(const std::string& series) {
  return {series + ".pvd", series + ".vtu.series"};
}

std::string frame_name(const std::string& series, std::size_t number) {
  char digits[24];
  std::snprintf(digits, sizeof digits, "_%06zu", number);
  return series + '/' + series + digits + ".vtu";
}

namespace {

void write_lists_of(const fs::path& folder, const std::string& name,
                    const std::vector<PvdRow>& rows) {
  const auto [pvd, series] = series_files(name);
  write_file(folder / pvd, pvd_text(rows));
  write_file(folder / series, series_text(rows));
}

}  // namespace

void keep_frames(const fs::path& folder, const std::string& series,
                 const std::vector<PvdRow>& rows) {
  try {
    // The lists are truncated first: they never name a file that does not exist.
    if (!rows.empty()) write_lists_of(folder, series, rows);
    remove_older(folder, series, rows);
  } catch (const fs::filesystem_error& error) {
    throw not_written((folder / series).string(), error.code().message(),
                      "choose a place you may write to");
  }
}

Series::Series(fs::path folder, VtuFormat format, std::span<const double> kept)
    : folder_(std::move(folder)), format_(std::move(format)) {
  format_.finite = true;
  keep(kept);
  create_inner_folder(folder_ / format_.series);
  keep_frames(folder_, format_.series, rows_);
  rows_listed_ = rows_.size();
}

void Series::keep(std::span<const double> times) {
  for (const double time : times) {
    rows_.push_back({time, frame_name(format_.series, rows_.size())});
    const fs::path file = folder_ / rows_.back().file;
    if (!fs::exists(file))
      throw bad_input({file.string()}, "is missing, and the run cannot go on without it",
                      "begin again with --force");
  }
}

Series::~Series() {
  try {
    close();
  } catch (const Error&) {
    // An exception is already in flight, or the caller ignores errors.
  }
}

void Series::add(const Dataset& frame) {
  const std::string file = frame_name(format_.series, rows_.size());
  write_vtu(folder_ / file, frame, format_);
  add_row(frame.time, file);
}

void Series::finish(const Dataset& frame) {
  const std::string file = frame_name(format_.series, rows_.size());
  finish_vtu(folder_ / file, frame, format_);
  add_row(frame.time, file);
}

void Series::drop_begun() const {
  std::error_code failed;
  for (const auto& entry : fs::directory_iterator(folder_ / format_.series, failed))
    if (const std::string name = entry.path().filename().string();
        name.ends_with(".tmp") && is_frame_of(format_.series, name))
      fs::remove(entry.path(), failed);
}

void Series::add_row(double time, std::string file) {
  rows_.push_back({time, std::move(file)});
  if (std::chrono::steady_clock::now() - listed_ >= pause_between_lists) write_lists();
}

void Series::close() {
  if (rows_listed_ < rows_.size()) write_lists();
}

void Series::write_lists() {
  write_lists_of(folder_, format_.series, rows_);
  rows_listed_ = rows_.size();
  listed_ = std::chrono::steady_clock::now();
}

}  // namespace sinew
