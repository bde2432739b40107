// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/io/gltf/detail/accessors.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

namespace sinew {
namespace {

/// Reads a number from unaligned bytes.
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

/// Replaces elements by the sparse ones.
void put_sparse(const CheckedGltf& gltf, const GltfAccessor& accessor, double* values) {
  const GltfSparse& sparse = *accessor.sparse;
  const int parts = components_of(accessor.type);
  const GltfElements places(gltf, sparse.index_view, sparse.index_offset, sparse.index_number);
  const GltfElements given(gltf, sparse.value_view, sparse.value_offset, accessor.number, parts);
  for (std::int64_t i = 0; i < sparse.count; ++i)
    given.put(i, accessor.normalized, values + places.index(i) * parts);
}

}  // namespace

GltfElements::GltfElements(const CheckedGltf& gltf, int view_index, std::int64_t offset,
                           GltfNumber number, int parts)
    : number_(number), parts_(parts) {
  const GltfView& view = gltf.document.views[static_cast<std::size_t>(view_index)];
  first_ = gltf.bytes.data() + view.offset + offset;
  step_ = view.stride > 0 ? view.stride : std::int64_t{parts} * size_of(number);
}

GltfElements::GltfElements(const CheckedGltf& gltf, const GltfAccessor& accessor)
    : GltfElements(gltf, accessor.view, accessor.offset, accessor.number,
                   components_of(accessor.type)) {}

std::int64_t GltfElements::index(std::int64_t i) const {
  return static_cast<std::int64_t>(number_at(first_ + i * step_, number_, false));
}

void GltfElements::put(std::int64_t i, bool normalized, double* to) const {
  const char* from = first_ + i * step_;
  for (int k = 0; k < parts_; ++k)
    to[k] = number_at(from + std::ptrdiff_t{k} * size_of(number_), number_, normalized);
}

std::vector<double> gltf_numbers(const CheckedGltf& gltf, int index) {
  const GltfAccessor& accessor = gltf.document.accessors[static_cast<std::size_t>(index)];
  const int parts = components_of(accessor.type);
  std::vector<double> numbers(static_cast<std::size_t>(accessor.count * parts));
  if (accessor.view >= 0) {  // else they are zero
    const GltfElements elements(gltf, accessor);
    for (std::int64_t i = 0; i < accessor.count; ++i)
      elements.put(i, accessor.normalized, numbers.data() + i * parts);
  }
  if (accessor.sparse) put_sparse(gltf, accessor, numbers.data());
  return numbers;
}

std::vector<double> gltf_values(const CheckedGltf& gltf, int index, const std::string& user) {
  std::vector<double> values = gltf_numbers(gltf, index);
  if (!std::all_of(values.begin(), values.end(), [](double x) { return std::isfinite(x); }))
    throw damaged_gltf(user + " hold a number that is not finite");
  return values;
}

}  // namespace sinew
