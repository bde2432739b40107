// SPDX-License-Identifier: GPL-3.0-or-later
// A moving surface for animators: Wavefront OBJ at rest, and a point cache (PC2) of its motion,
// as imported by Blender (Mesh Cache), 3ds Max and Maya. Coordinates and units of the scene; the
// single precision of PC2 is that of places near the body where that is far from the origin.
//
//     PointCache cache("surface.pc2", surface.points.size());
//     cache.add(points);
//     cache.close();
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <vector>

#include <sinew/core/file.h>
#include <sinew/core/surface_look.h>
#include <sinew/core/triangles.h>

namespace sinew {

/// Points and faces in the order of `surface`, with what `look` says of the faces, if anything; the
/// paths of its libraries are relative to the file. Throws not written.
void write_obj(const std::filesystem::path& path, const Triangles& surface,
               const SurfaceLook& look = {});

/// PC2: "POINTCACHE2\0", int32 version 1, int32 points, float start, float rate, int32 samples,
/// then float32 x y z of every point of every sample; little endian. It grows sample by sample; its
/// count never exceeds the samples written. Its places are relative to an origin (m); where that is
/// not zero, FILE.origin.json beside it tells it: {"origin": [x, y, z], "unit": "m"}.
class PointCache {
 public:
  /// Continues after the first `kept` samples of an existing cache. Throws not written, and bad
  /// input when it holds fewer.
  PointCache(const std::filesystem::path& path, std::size_t points, std::size_t kept = 0,
             const Vec3& origin = Vec3::Zero());

  /// One sample; as many points each time. Throws not written.
  void add(const Points& points);
  void close();  ///< throws not written

 private:
  void count_samples();

  std::size_t points_, samples_;
  Vec3 origin_;
  GrowingFile file_;
};

/// Name of the file that tells the origin of a point cache.
std::filesystem::path origin_file(const std::filesystem::path& cache);

/// Reads a PC2 file sample by sample.
class CachedPoints {
 public:
  /// Throws bad input where it is not one, or incomplete.
  explicit CachedPoints(const std::filesystem::path& path);

  std::size_t points() const { return points_; }
  std::size_t samples() const { return samples_; }
  std::vector<float> sample(
      std::size_t index);  ///< x y z of each point as the file has them; throws bad input

 private:
  std::filesystem::path path_;
  std::ifstream file_;
  std::size_t points_ = 0, samples_ = 0;
};

}  // namespace sinew
