// SPDX-License-Identifier: GPL-3.0-or-later
#include <cstring>

#include <sinew/io/gltf/checks.h>

namespace sinew {
namespace {

/// That `count` elements of `size` bytes from `offset` on lie in the view.
void check_extent(const GltfDocument& document, const std::string& user, int view_index,
                  std::int64_t offset, std::int64_t count, std::int64_t size) {
  check_index(view_index, document.views, user, "bufferView");
  const GltfView& view = document.views[static_cast<std::size_t>(view_index)];
  const std::int64_t step = view.stride > 0 ? view.stride : size;
  if (step < size)
    throw damaged_gltf(user + " has elements of " + std::to_string(size) + " bytes every " +
                       std::to_string(step));
  const std::int64_t end = offset + (count - 1) * step + size;  // below 2^31 + 2^31 252 + 64
  if (end > view.size)
    throw damaged_gltf(user + " ends at byte " + std::to_string(end) + " of a bufferView of " +
                       std::to_string(view.size));
}

/// Bytes.
std::int64_t element_size(const GltfAccessor& accessor) {
  return std::int64_t{size_of(accessor.number)} * components_of(accessor.type);
}

void check_accessor(const GltfDocument& document, std::size_t index) {
  const GltfAccessor& accessor = document.accessors[index];
  const std::string user = nth("accessors", index);
  const std::int64_t size = element_size(accessor);
  if (accessor.view >= 0)
    check_extent(document, user, accessor.view, accessor.offset, accessor.count, size);
  if (!accessor.sparse) return;
  const GltfSparse& sparse = *accessor.sparse;
  if (sparse.count > accessor.count || !counts(sparse.index_number))
    throw damaged_gltf(user + ".sparse does not fit it");
  check_extent(document, user + ".sparse.indices", sparse.index_view, sparse.index_offset,
               sparse.count, size_of(sparse.index_number));
  check_extent(document, user + ".sparse.values", sparse.value_view, sparse.value_offset,
               sparse.count, size);
}

std::int64_t number_at(const char* from, GltfNumber number) {
  std::uint32_t value = 0;  // as in the file, little-endian machines only
  std::memcpy(&value, from, static_cast<std::size_t>(size_of(number)));
  return value;
}

void check_sparse(const GuardedGltf& gltf, std::size_t index) {
  const GltfAccessor& accessor = gltf.document.accessors[index];
  const GltfSparse& sparse = *accessor.sparse;
  const GltfView& view = gltf.document.views[static_cast<std::size_t>(sparse.index_view)];
  const std::int64_t step = view.stride > 0 ? view.stride : size_of(sparse.index_number);
  const char* first = gltf.bytes.data() + view.offset + sparse.index_offset;
  for (std::int64_t i = 0; i < sparse.count; ++i)
    if (const auto at = number_at(first + i * step, sparse.index_number); at >= accessor.count)
      throw damaged_gltf(nth("accessors", index) + ".sparse names element " + std::to_string(at) +
                         " of " + std::to_string(accessor.count));
}

}  // namespace

void join_gltf_buffers(GltfDocument& document) {
  std::vector<std::int64_t> starts = {0};
  for (const GltfBuffer& buffer : document.buffers) starts.push_back(starts.back() + buffer.size);
  for (std::size_t i = 0; i < document.views.size(); ++i) {
    GltfView& view = document.views[i];
    check_index(view.buffer, document.buffers, nth("bufferViews", i), "buffer");
    const auto buffer = static_cast<std::size_t>(view.buffer);
    if (view.offset + view.size > document.buffers[buffer].size)
      throw damaged_gltf(nth("bufferViews", i) + " ends at byte " +
                         std::to_string(view.offset + view.size) + " of a buffer of " +
                         std::to_string(document.buffers[buffer].size));
    view.offset += starts[buffer];
    view.buffer = 0;
  }
  document.buffers.clear();
}

void check_gltf_accessors(const GltfDocument& document) {
  for (std::size_t i = 0; i < document.accessors.size(); ++i) check_accessor(document, i);
}

void check_gltf_sparse(const GuardedGltf& gltf) {
  for (std::size_t i = 0; i < gltf.document.accessors.size(); ++i)
    if (gltf.document.accessors[i].sparse) check_sparse(gltf, i);
}

}  // namespace sinew
