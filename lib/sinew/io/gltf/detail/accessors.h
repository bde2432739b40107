// SPDX-License-Identifier: GPL-3.0-or-later
// The numbers in a glTF file's buffers. For little-endian machines only, like the files.
//
//     const std::vector<double> times = gltf_values(gltf, sampler.times, "its times");
#pragma once

#include <string>
#include <vector>

#include <sinew/io/gltf/checks.h>

namespace sinew {

/// Elements in a buffer view, contiguous or `stride` apart, read in place. Accessors and views must
/// have been checked.
class GltfElements {
 public:
  /// Reads from byte `offset` of the view, `parts` numbers each.
  GltfElements(const CheckedGltf& gltf, int view, std::int64_t offset, GltfNumber number,
               int parts = 1);
  /// Reads an accessor with data; sparse elements are ignored.
  GltfElements(const CheckedGltf& gltf, const GltfAccessor& accessor);

  std::int64_t index(std::int64_t i) const;  ///< element i, of one unsigned whole number

  /// Writes the numbers of element i; normalized integers as fractions, -1 or 0 to 1.
  void put(std::int64_t i, bool normalized, double* to) const;

 private:
  const char* first_;
  std::int64_t step_;  // bytes
  GltfNumber number_;
  int parts_;
};

/// All components of all elements, element by element, normalized and sparse ones resolved. The
/// accessor must have been checked and have data.
std::vector<double> gltf_numbers(const CheckedGltf& gltf, int accessor);

/// The same. Throws bad input (without the path) where a number is not finite: "USER hold a number
/// that is not finite".
std::vector<double> gltf_values(const CheckedGltf& gltf, int accessor, const std::string& user);

}  // namespace sinew
