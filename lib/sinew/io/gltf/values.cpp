// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/io/gltf/values.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include <sinew/io/gltf/checks.h>

namespace sinew {
namespace {

/// As in the file, little-endian machines only; the bytes may stand anywhere.
template <class Number>
double number_at(const char* from, bool normalized) {
  Number number;
  std::memcpy(&number, from, sizeof number);
  const double value = number;
  if (!std::numeric_limits<Number>::is_integer || !normalized) return value;
  return std::max(value / std::numeric_limits<Number>::max(), -1.0);
}

double number_at(const char* from, GltfNumber number, bool normalized) {
  switch (number) {
    case GltfNumber::int8:
      return number_at<std::int8_t>(from, normalized);
    case GltfNumber::uint8:
      return number_at<std::uint8_t>(from, normalized);
    case GltfNumber::int16:
      return number_at<std::int16_t>(from, normalized);
    case GltfNumber::uint16:
      return number_at<std::uint16_t>(from, normalized);
    case GltfNumber::uint32:
      return number_at<std::uint32_t>(from, normalized);
    case GltfNumber::float32:
      return number_at<float>(from, normalized);
  }
  return 0;
}

/// Elements in a view, from `offset` on (bytes).
struct Elements {
  const char* first;
  std::int64_t step;  // bytes

  Elements(const GuardedGltf& gltf, int view_index, std::int64_t offset, std::int64_t size) {
    const GltfView& view = gltf.document.views[static_cast<std::size_t>(view_index)];
    first = gltf.bytes.data() + view.offset + offset;
    step = view.stride > 0 ? view.stride : size;
  }
  const char* operator[](std::int64_t i) const { return first + i * step; }
};

void put_element(const char* from, const GltfAccessor& accessor, double* to) {
  const int parts = components_of(accessor.type);
  for (int k = 0; k < parts; ++k)
    to[k] = number_at(from + k * size_of(accessor.number), accessor.number, accessor.normalized);
}

/// Over the others.
void put_sparse(const GuardedGltf& gltf, const GltfAccessor& accessor, double* values) {
  const GltfSparse& sparse = *accessor.sparse;
  const int parts = components_of(accessor.type);
  const Elements places(gltf, sparse.index_view, sparse.index_offset, size_of(sparse.index_number));
  const Elements given(gltf, sparse.value_view, sparse.value_offset,
                       std::int64_t{parts} * size_of(accessor.number));
  for (std::int64_t i = 0; i < sparse.count; ++i) {
    const auto place = static_cast<std::int64_t>(number_at(places[i], sparse.index_number, false));
    put_element(given[i], accessor, values + place * parts);
  }
}

}  // namespace

std::vector<double> gltf_values(const GuardedGltf& gltf, int index, const std::string& user) {
  const GltfAccessor& accessor = gltf.document.accessors[static_cast<std::size_t>(index)];
  const int parts = components_of(accessor.type);
  std::vector<double> values(static_cast<std::size_t>(accessor.count * parts));
  const Elements elements(gltf, accessor.view, accessor.offset,
                          std::int64_t{parts} * size_of(accessor.number));
  for (std::int64_t i = 0; i < accessor.count; ++i)
    put_element(elements[i], accessor, values.data() + i * parts);
  if (accessor.sparse) put_sparse(gltf, accessor, values.data());
  if (!std::all_of(values.begin(), values.end(), [](double x) { return std::isfinite(x); }))
    throw damaged_gltf(user + " hold a number that is not finite");
  return values;
}

}  // namespace sinew
