// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/io/point_cache.h>

#include <bit>
#include <cassert>
#include <cstring>
#include <string>
#include <utility>
#include <vector>

#include <sinew/core/error.h>
#include <sinew/core/text.h>

namespace sinew {
namespace {

constexpr char magic[] = {'P', 'O', 'I', 'N', 'T', 'C', 'A', 'C', 'H', 'E', '2', '\0'};
constexpr std::size_t place_of_samples = 28, header_size = 32;  // bytes
constexpr std::size_t point_size = 12;

void add_bytes(std::uint32_t value, std::string& text) {
  for (int byte = 0; byte < 4; ++byte) text += static_cast<char>((value >> (8 * byte)) & 0xff);
}

std::uint32_t bits_of(double value) {
  return std::bit_cast<std::uint32_t>(static_cast<float>(value));
}

std::uint32_t word_of(const char* bytes) {
  std::uint32_t word = 0;
  for (int byte = 0; byte < 4; ++byte)
    word |= static_cast<std::uint32_t>(static_cast<unsigned char>(bytes[byte])) << (8 * byte);
  return word;
}

Error no_cache(const std::filesystem::path& path) {
  return bad_input({path.string()}, "is not a complete point cache", "run the scene again");
}

}  // namespace

namespace {

/// The lines by which a face's part differs from that before it.
std::string part_lines(const SurfaceLook::Part& before, const SurfaceLook::Part& part) {
  std::string text;
  if (part.object != before.object) text += "o " + part.object + '\n';
  if (part.group != before.group) text += "g " + part.group + '\n';
  if (part.material != before.material) text += "usemtl " + part.material + '\n';
  return text;
}

/// "7", "7/1", "7//3" or "7/1/3"
std::string corner_text(int point, int coordinates, int normal) {
  std::string text = std::to_string(point + 1);
  if (coordinates >= 0 || normal >= 0) text += '/';
  if (coordinates >= 0) text += std::to_string(coordinates + 1);
  if (normal >= 0) text += '/' + std::to_string(normal + 1);
  return text;
}

std::string point_line(const char* keyword, const Vec3& point) {
  std::string text = keyword;
  for (const double coordinate : point) text += ' ' + number_text(coordinate);
  return text + '\n';
}

}  // namespace

void write_obj(const std::filesystem::path& path, const Triangles& surface,
               const SurfaceLook& look) {
  NewFile file(path);
  std::string text = "# surface at rest, m\n";
  for (const std::string& library : look.libraries) text += "mtllib " + library + '\n';
  for (const Vec3& point : surface.points) text += point_line("v", point);
  for (const auto& [u, v] : look.coordinates)
    text += "vt " + number_text(u) + ' ' + number_text(v) + '\n';
  for (const Vec3& normal : look.normals) text += point_line("vn", normal);
  constexpr SurfaceLook::Corners none{-1, -1, -1};
  SurfaceLook::Part before;
  for (std::size_t i = 0; i < surface.faces.size(); ++i) {
    const int part = look.part.empty() ? -1 : look.part[i];
    if (part >= 0) text += part_lines(std::exchange(before, look.parts[part]), look.parts[part]);
    const auto& coordinates = look.corners.empty() ? none : look.corners[i];
    const auto& normals = look.normal_corners.empty() ? none : look.normal_corners[i];
    text += 'f';
    for (int k = 0; k < 3; ++k)
      text += ' ' + corner_text(surface.faces[i][k], coordinates[k], normals[k]);
    text += '\n';
  }
  file.write(text.data(), text.size());
  file.finish();
}

std::filesystem::path origin_file(const std::filesystem::path& cache) {
  return cache.string() + ".origin.json";
}

namespace {

void write_origin(const std::filesystem::path& path, const Vec3& origin) {
  NewFile file(path);
  const std::string text = "{\"origin\": [" + number_text(origin.x()) + ", " +
                           number_text(origin.y()) + ", " + number_text(origin.z()) +
                           "], \"unit\": \"m\"}\n";
  file.write(text.data(), text.size());
  file.finish();
}

}  // namespace

PointCache::PointCache(const std::filesystem::path& path, std::size_t points, std::size_t kept,
                       const Vec3& origin)
    : points_(points),
      samples_(kept),
      origin_(origin),
      file_(path, kept > 0 ? header_size + kept * points * point_size : 0) {
  if (!origin.isZero(0)) write_origin(origin_file(path), origin);
  if (kept > 0) {
    count_samples();
    return;
  }
  std::string header(magic, sizeof magic);
  add_bytes(1, header);
  add_bytes(static_cast<std::uint32_t>(points), header);
  add_bytes(bits_of(0), header);  // first frame
  add_bytes(bits_of(1), header);  // frames per sample
  add_bytes(0, header);           // samples
  file_.add(header.data(), header.size());
}

void PointCache::add(const Points& points) {
  assert(points.size() == points_);
  std::string bytes;
  bytes.reserve(point_size * points_);
  for (const Vec3& point : points)
    for (int axis = 0; axis < 3; ++axis) add_bytes(bits_of(point[axis] - origin_[axis]), bytes);
  file_.add(bytes.data(), bytes.size());
  ++samples_;
  count_samples();
}

void PointCache::count_samples() {
  std::string count;
  add_bytes(static_cast<std::uint32_t>(samples_), count);
  file_.write_at(place_of_samples, count.data(), count.size());
}

void PointCache::close() { file_.close(); }
CachedPoints::CachedPoints(const std::filesystem::path& path)
    : path_(path), file_(path, std::ios::binary) {
  char header[header_size] = {};
  if (!file_.read(header, sizeof header) || std::memcmp(header, magic, sizeof magic) != 0)
    throw no_cache(path_);
  points_ = word_of(header + 16);
  samples_ = word_of(header + place_of_samples);
  std::error_code unreadable;
  if (std::filesystem::file_size(path_, unreadable) != header_size + 12 * points_ * samples_)
    throw no_cache(path_);
}

std::vector<float> CachedPoints::sample(std::size_t index) {
  std::vector<char> bytes(12 * points_);
  file_.seekg(static_cast<std::streamoff>(header_size + index * bytes.size()));
  if (!file_.read(bytes.data(), static_cast<std::streamsize>(bytes.size()))) throw no_cache(path_);
  std::vector<float> coordinates(3 * points_);
  for (std::size_t i = 0; i < coordinates.size(); ++i)
    coordinates[i] = std::bit_cast<float>(word_of(bytes.data() + 4 * i));
  return coordinates;
}

}  // namespace sinew
