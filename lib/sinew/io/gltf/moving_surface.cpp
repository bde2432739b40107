// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/io/gltf/moving_surface.h>

#include <algorithm>
#include <bit>
#include <nlohmann/json.hpp>

#include <sinew/core/error.h>
#include <sinew/core/file.h>
#include <sinew/io/gltf/document.h>
#include <sinew/io/point_cache.h>

namespace sinew {
namespace {

using OrderedJson = nlohmann::ordered_json;
using Floats = std::vector<float>;

constexpr std::size_t most_samples = 500;
constexpr std::size_t most_bytes = std::size_t{1} << 30;

/// A JSON list of one element.
OrderedJson listed(OrderedJson only) {
  OrderedJson list = OrderedJson::array();
  list.push_back(std::move(only));
  return list;
}

/// The samples taken, ascending: all, or every n-th and the last.
std::vector<std::size_t> taken_samples(const CachedPoints& cache) {
  if (cache.samples() == 0 || cache.points() == 0)
    throw bad_input("the point cache is empty", "run the scene again");
  const std::size_t fit = most_bytes / std::max<std::size_t>(12 * cache.points(), 1);
  const std::size_t most = std::clamp<std::size_t>(fit, 2, most_samples);
  const std::size_t last = cache.samples() - 1, every = last / most + 1;
  std::vector<std::size_t> taken;
  for (std::size_t k = 0; k < last; k += every) taken.push_back(k);
  taken.push_back(last);
  return taken;
}

/// From x forward and z up to z forward and y up: x y z becomes y z x.
Floats turned(Floats xyz) {
  for (auto at = xyz.begin(); at != xyz.end(); at += 3) std::rotate(at, at + 1, at + 3);
  return xyz;
}

/// The samples of the surface in glTF's axes.
class Moments {
 public:
  explicit Moments(const std::filesystem::path& cache)
      : cache_(cache), taken_(taken_samples(cache_)), first_(turned(cache_.sample(0))) {}

  std::size_t points() const { return cache_.points(); }
  std::size_t targets() const { return taken_.size() - 1; }
  const Floats& first() const { return first_; }

  /// Displacements of the points from the first sample to that of a target.
  Floats target(std::size_t index) {
    Floats displacements = turned(cache_.sample(taken_[index + 1]));
    for (std::size_t i = 0; i < displacements.size(); ++i) displacements[i] -= first_[i];
    return displacements;
  }

  Floats times(double interval) const {
    Floats times;
    for (const std::size_t sample : taken_)
      times.push_back(static_cast<float>(static_cast<double>(sample) * interval));
    return times;
  }

  /// The weights of all targets at each sample: one target at a time has weight 1.
  Floats weights() const {
    Floats weights(taken_.size() * targets(), 0);
    for (std::size_t k = 0; k < targets(); ++k) weights[(k + 1) * targets() + k] = 1;
    return weights;
  }

 private:
  CachedPoints cache_;
  std::vector<std::size_t> taken_;
  Floats first_;
};

/// The layout of the file's binary part, one view per accessor.
class Contents {
 public:
  int add(GltfNumber number, const char* type, std::size_t count,
          OrderedJson more = OrderedJson::object()) {
    const std::size_t size =
        count * static_cast<std::size_t>(components_of(type)) * 4;  // all numbers have 4 bytes
    views_.push_back({{"buffer", 0}, {"byteOffset", bytes_}, {"byteLength", size}});
    more.update({{"bufferView", views_.size() - 1},
                 {"componentType", number},
                 {"count", count},
                 {"type", type}});
    accessors_.push_back(std::move(more));
    bytes_ += size;
    return static_cast<int>(accessors_.size()) - 1;
  }

  int add_points(const Floats& xyz) {
    OrderedJson low = OrderedJson::array(), high = OrderedJson::array();
    for (std::size_t axis = 0; axis < 3; ++axis) {
      float least = xyz[axis], most = least;
      for (std::size_t i = axis; i < xyz.size(); i += 3)
        least = std::min(least, xyz[i]), most = std::max(most, xyz[i]);
      low.push_back(least), high.push_back(most);
    }
    return add(GltfNumber::float32, "VEC3", xyz.size() / 3, {{"min", low}, {"max", high}});
  }

  std::size_t bytes() const { return bytes_; }

  void put_into(OrderedJson& json) const {
    json["accessors"] = accessors_;
    json["bufferViews"] = views_;
    json["buffers"] = listed({{"byteLength", bytes_}});
  }

 private:
  OrderedJson views_ = OrderedJson::array(), accessors_ = OrderedJson::array();
  std::size_t bytes_ = 0;
};

OrderedJson animation_of(const Floats& times, std::size_t targets, Contents& contents) {
  const int input = contents.add(GltfNumber::float32, "SCALAR", times.size(),
                                 {{"min", listed(times.front())}, {"max", listed(times.back())}});
  const int output = contents.add(GltfNumber::float32, "SCALAR", times.size() * targets);
  OrderedJson animation = {{"name", "motion"}};
  animation["samplers"] =
      listed({{"input", input}, {"output", output}, {"interpolation", "LINEAR"}});
  animation["channels"] = listed({{"sampler", 0}, {"target", {{"node", 0}, {"path", "weights"}}}});
  return animation;
}

/// The file's JSON; declares the data in the order in which write_data() writes it.
OrderedJson describe(Moments& moments, std::size_t corners, double interval, Contents& contents) {
  OrderedJson surface = {{"indices", contents.add(GltfNumber::uint32, "SCALAR", corners)}};
  surface["attributes"] = {{"POSITION", contents.add_points(moments.first())}};
  for (std::size_t k = 0; k < moments.targets(); ++k)
    surface["targets"].push_back({{"POSITION", contents.add_points(moments.target(k))}});
  OrderedJson json = {{"asset", {{"version", "2.0"}, {"generator", "sinew"}}}, {"scene", 0}};
  json["scenes"] = listed({{"nodes", listed(0)}});
  json["nodes"] = listed({{"name", "surface"}, {"mesh", 0}});
  OrderedJson mesh = {
      {"primitives", listed(surface)}};  // weights default to 0, but VTK counts them
  if (moments.targets() > 0) mesh["weights"] = std::vector<int>(moments.targets(), 0);
  json["meshes"] = listed(mesh);
  if (moments.targets() > 0)
    json["animations"] = listed(animation_of(moments.times(interval), moments.targets(), contents));
  contents.put_into(json);
  return json;
}

std::string little_endian(std::uint32_t word) {
  std::string bytes;
  for (int byte = 0; byte < 4; ++byte) bytes += static_cast<char>(word >> (8 * byte) & 0xff);
  return bytes;
}

template <class Number>
void write(NewFile& file, const std::vector<Number>& numbers) {
  static_assert(sizeof(Number) == 4);
  std::string bytes;
  bytes.reserve(4 * numbers.size());
  for (const Number number : numbers) bytes += little_endian(std::bit_cast<std::uint32_t>(number));
  file.write(bytes.data(), bytes.size());
}

void write_data(NewFile& file, Moments& moments, const std::vector<std::uint32_t>& corners,
                double interval) {
  write(file, corners);
  write(file, moments.first());
  for (std::size_t k = 0; k < moments.targets(); ++k) write(file, moments.target(k));
  if (moments.targets() == 0) return;
  write(file, moments.times(interval));
  write(file, moments.weights());
}

std::string chunk(std::size_t size, const char* kind) {
  return little_endian(static_cast<std::uint32_t>(size)) + std::string(kind, 4);
}

}  // namespace

void write_moving_surface(const std::filesystem::path& path,
                          const std::vector<std::array<int, 3>>& faces,
                          const std::filesystem::path& cache, double interval) {
  Moments moments(cache);
  std::vector<std::uint32_t> corners;
  for (const auto& face : faces) corners.insert(corners.end(), face.begin(), face.end());
  Contents contents;
  std::string json = describe(moments, corners.size(), interval, contents).dump();
  json.resize((json.size() + 3) / 4 * 4, ' ');
  const std::size_t size = 12 + 8 + json.size() + 8 + contents.bytes();
  const std::string head = "glTF" + little_endian(2) +
                           little_endian(static_cast<std::uint32_t>(size)) +
                           chunk(json.size(), "JSON") + json + chunk(contents.bytes(), "BIN\0");
  NewFile file(path);
  file.write(head.data(), head.size());
  write_data(file, moments, corners, interval);
  file.finish();
}

}  // namespace sinew
