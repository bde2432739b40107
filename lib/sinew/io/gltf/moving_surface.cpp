// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/io/gltf/moving_surface.h>

#include <algorithm>
#include <bit>
#include <nlohmann/json.hpp>
#include <optional>

#include <sinew/core/error.h>
#include <sinew/core/file.h>
#include <sinew/core/json.h>
#include <sinew/io/gltf/detail/materials.h>
#include <sinew/io/gltf/detail/split_surface.h>
#include <sinew/io/gltf/document.h>
#include <sinew/io/point_cache.h>

namespace sinew {
namespace {

using OrderedJson = nlohmann::ordered_json;
using Floats = std::vector<float>;

constexpr std::size_t max_clip_samples = 500;
// Browsers keep a buffer in one array, of up to 2 GiB, beside what they draw of it.
constexpr std::size_t max_bytes = std::size_t{1} << 30;

/// A JSON list of one element.
OrderedJson list_of(OrderedJson only) {
  OrderedJson list = OrderedJson::array();
  list.push_back(std::move(only));
  return list;
}

/// The samples taken, ascending: all, or every n-th and the last. `bytes` of one.
std::vector<std::size_t> taken_samples(const CachedPoints& cache, std::size_t bytes) {
  if (cache.samples() == 0 || cache.points() == 0)
    throw bad_input("the point cache is empty", "run the scene again");
  const std::size_t fit = max_bytes / std::max<std::size_t>(bytes, 1);
  const std::size_t most = std::clamp<std::size_t>(fit, 2, max_clip_samples);
  const std::size_t last = cache.samples() - 1, every = last / most + 1;
  std::vector<std::size_t> taken;
  for (std::size_t k = 0; k < last; k += every) taken.push_back(k);
  taken.push_back(last);
  return taken;
}

/// Turns x forward and z up to z forward and y up: x y z becomes y z x.
Floats turned(Floats xyz) {
  for (auto at = xyz.begin(); at != xyz.end(); at += 3) std::rotate(at, at + 1, at + 3);
  return xyz;
}

Points turned(const Points& points) {
  Points out;
  for (const Vec3& point : points) out.push_back({point.y(), point.z(), point.x()});
  return out;
}

Floats difference(Floats values, const Floats& from) {
  for (std::size_t i = 0; i < values.size(); ++i) values[i] -= from[i];
  return values;
}

/// The samples of the surface's vertices in glTF's axes.
class Moments {
 public:
  Moments(const std::filesystem::path& cache, const SplitSurface& surface)
      : cache_(cache),
        surface_(surface),
        taken_(taken_samples(cache_, surface.point.size() * (surface.has_normals ? 24 : 12))),
        first_(sample(0)) {
    if (!surface.has_normals) return;
    moved_.emplace(surface, first_, turned(surface.normals));
    first_normals_ = moved_->at(first_);
  }

  std::size_t targets() const { return taken_.size() - 1; }
  const Floats& first() const { return first_; }
  const Floats& first_normals() const { return first_normals_; }  ///< empty: none

  /// Change from the first sample to that of a target.
  struct Change {
    Floats places, normals;
  };
  Change target(std::size_t index) {
    const Floats places = sample(taken_[index + 1]);
    Change change{difference(places, first_), {}};
    if (moved_) change.normals = difference(moved_->at(places), first_normals_);
    return change;
  }

  Floats times(std::span<const double> of_samples) const {
    Floats times;
    for (const std::size_t sample : taken_) times.push_back(static_cast<float>(of_samples[sample]));
    return times;
  }

  /// The weights of all targets at each sample: one target at a time has weight 1.
  Floats weights() const {
    Floats weights(taken_.size() * targets(), 0);
    for (std::size_t k = 0; k < targets(); ++k) weights[(k + 1) * targets() + k] = 1;
    return weights;
  }

 private:
  Floats sample(std::size_t index) {
    const Floats points = turned(cache_.sample(index));
    Floats vertices;
    vertices.reserve(3 * surface_.point.size());
    for (const int point : surface_.point)
      vertices.insert(vertices.end(), points.begin() + 3 * point, points.begin() + 3 * point + 3);
    return vertices;
  }

  CachedPoints cache_;
  const SplitSurface& surface_;
  std::vector<std::size_t> taken_;
  Floats first_, first_normals_;
  std::optional<MovedNormals> moved_;
};

/// The layout of the file's binary part, one view per accessor.
class Contents {
 public:
  int add(GltfNumber number, const char* type, std::size_t count,
          OrderedJson more = OrderedJson::object()) {
    const std::size_t size =
        count * static_cast<std::size_t>(components_of(type)) * 4;  // all numbers have 4 bytes
    more.update({{"bufferView", add_view(size)},
                 {"componentType", number},
                 {"count", count},
                 {"type", type}});
    accessors_.push_back(std::move(more));
    return static_cast<int>(accessors_.size()) - 1;
  }

  std::size_t add_view(std::size_t size) {
    views_.push_back({{"buffer", 0}, {"byteOffset", bytes_}, {"byteLength", size}});
    bytes_ += (size + 3) / 4 * 4;
    return views_.size() - 1;
  }

  int add_floats(const Floats& values, const char* type) {
    const auto components = static_cast<std::size_t>(components_of(type));
    return add(GltfNumber::float32, type, values.size() / components);
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
    json["buffers"] = list_of({{"byteLength", bytes_}});
  }

 private:
  OrderedJson views_ = OrderedJson::array(), accessors_ = OrderedJson::array();
  std::size_t bytes_ = 0;
};

OrderedJson animation_of(const Floats& times, std::size_t targets, Contents& contents) {
  const int input = contents.add(GltfNumber::float32, "SCALAR", times.size(),
                                 {{"min", list_of(times.front())}, {"max", list_of(times.back())}});
  const int output = contents.add(GltfNumber::float32, "SCALAR", times.size() * targets);
  OrderedJson animation = {{"name", "motion"}};
  animation["samplers"] =
      list_of({{"input", input}, {"output", output}, {"interpolation", "LINEAR"}});
  animation["channels"] = list_of({{"sampler", 0}, {"target", {{"node", 0}, {"path", "weights"}}}});
  return animation;
}

const char* type_of(const SurfaceLook::Layer& layer) {
  return layer.components == 2 ? "VEC2" : "VEC4";
}

/// The attributes of the vertices at first.
OrderedJson attributes_of(const Moments& moments, const SplitSurface& surface, Contents& contents) {
  OrderedJson attributes = {{"POSITION", contents.add_points(moments.first())}};
  if (surface.has_normals)
    attributes["NORMAL"] = contents.add_floats(moments.first_normals(), "VEC3");
  if (!surface.coordinates.empty())
    attributes["TEXCOORD_0"] = contents.add_floats(surface.coordinates, "VEC2");
  for (const SurfaceLook::Layer& layer : surface.layers)
    attributes[layer.name] = contents.add_floats(layer.values, type_of(layer));
  return attributes;
}

OrderedJson targets_of(Moments& moments, Contents& contents) {
  OrderedJson targets = OrderedJson::array();
  for (std::size_t k = 0; k < moments.targets(); ++k) {
    const Moments::Change change = moments.target(k);
    OrderedJson target = {{"POSITION", contents.add_points(change.places)}};
    if (!change.normals.empty()) target["NORMAL"] = contents.add_floats(change.normals, "VEC3");
    targets.push_back(std::move(target));
  }
  return targets;
}

/// Returns materials of the mesh's file for the patches that name them; others that patches name
/// are added.
GltfMaterials materials_of(SplitSurface& surface, const SurfaceLook& look) {
  GltfMaterials materials = look.gltf;
  for (SplitSurface::Patch& patch : surface.patches) {
    if (patch.gltf_material >= 0 || patch.material.empty()) continue;
    SurfaceLook::Material material;
    material.name = patch.material;
    for (const SurfaceLook::Material& described : look.materials)
      if (described.name == patch.material) material = described;
    patch.gltf_material = add_material(materials, material);
  }
  return materials;
}

void put_into(OrderedJson& json, const GltfMaterials& materials, Contents& contents) {
  std::vector<std::size_t> views;
  for (const std::string& image : materials.images)
    views.push_back(contents.add_view(image.size()));
  if (materials.json.empty()) return;
  OrderedJson own = parsed_json<OrderedJson>(materials.json);
  if (own.contains("images"))
    for (OrderedJson& image : own["images"])
      if (image.is_object() && image.contains("bufferView"))
        image["bufferView"] = views[image["bufferView"].get<std::size_t>()];
  json.update(own);
}

/// The faces of each material, on the same vertices.
OrderedJson primitives_of(Moments& moments, const SplitSurface& surface, Contents& contents) {
  OrderedJson primitives = OrderedJson::array();
  for (const SplitSurface::Patch& patch : surface.patches) {
    primitives.push_back(
        {{"indices", contents.add(GltfNumber::uint32, "SCALAR", patch.corners.size())}});
    if (patch.gltf_material >= 0) primitives.back()["material"] = patch.gltf_material;
  }
  const OrderedJson attributes = attributes_of(moments, surface, contents);
  const OrderedJson targets = targets_of(moments, contents);
  for (OrderedJson& primitive : primitives) {
    primitive["attributes"] = attributes;
    if (!targets.empty()) primitive["targets"] = targets;
  }
  return primitives;
}

/// The file's JSON; declares the data in the order in which write_data() writes it.
OrderedJson describe(Moments& moments, const SplitSurface& surface, const GltfMaterials& materials,
                     std::span<const double> times, const Vec3& origin, Contents& contents) {
  OrderedJson json = {{"asset", {{"version", "2.0"}, {"generator", "sinew"}}}, {"scene", 0}};
  json["scenes"] = list_of({{"nodes", list_of(0)}});
  json["nodes"] = list_of({{"name", "surface"}, {"mesh", 0}});
  if (!origin.isZero(0)) json["nodes"][0]["translation"] = {origin.y(), origin.z(), origin.x()};
  OrderedJson mesh = {{"primitives", primitives_of(moments, surface, contents)}};
  // Weights default to 0, but VTK counts them.
  if (moments.targets() > 0) mesh["weights"] = std::vector<int>(moments.targets(), 0);
  json["meshes"] = list_of(mesh);
  if (moments.targets() > 0)
    json["animations"] = list_of(animation_of(moments.times(times), moments.targets(), contents));
  put_into(json, materials, contents);
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

void write_image(NewFile& file, const std::string& image) {
  file.write(image.data(), image.size());
  const std::string padding((4 - image.size() % 4) % 4, '\0');
  file.write(padding.data(), padding.size());
}

void write_data(NewFile& file, Moments& moments, const SplitSurface& surface,
                const GltfMaterials& materials, std::span<const double> times) {
  for (const SplitSurface::Patch& patch : surface.patches) write(file, patch.corners);
  write(file, moments.first());
  write(file, moments.first_normals());
  write(file, surface.coordinates);
  for (const SurfaceLook::Layer& layer : surface.layers) write(file, layer.values);
  for (std::size_t k = 0; k < moments.targets(); ++k) {
    const Moments::Change change = moments.target(k);
    write(file, change.places);
    write(file, change.normals);
  }
  if (moments.targets() > 0) {
    write(file, moments.times(times));
    write(file, moments.weights());
  }
  for (const std::string& image : materials.images) write_image(file, image);
}

std::string chunk(std::size_t size, const char* kind) {
  return little_endian(static_cast<std::uint32_t>(size)) + std::string(kind, 4);
}

}  // namespace

void write_moving_surface(const std::filesystem::path& path,
                          const std::vector<std::array<int, 3>>& faces,
                          const std::filesystem::path& cache, std::span<const double> times,
                          const SurfaceLook& look, const Vec3& origin) {
  SplitSurface surface = split_surface(faces, CachedPoints(cache).points(), look);
  const GltfMaterials materials = materials_of(surface, look);
  Moments moments(cache, surface);
  Contents contents;
  std::string json = json_text(describe(moments, surface, materials, times, origin, contents));
  json.resize((json.size() + 3) / 4 * 4, ' ');
  const std::size_t size = 12 + 8 + json.size() + 8 + contents.bytes();
  const std::string head = "glTF" + little_endian(2) +
                           little_endian(static_cast<std::uint32_t>(size)) +
                           chunk(json.size(), "JSON") + json + chunk(contents.bytes(), "BIN\0");
  NewFile file(path);
  file.write(head.data(), head.size());
  write_data(file, moments, surface, materials, times);
  file.finish();
}

}  // namespace sinew
