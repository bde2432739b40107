// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/io/detail/encode.h>

#include <cmath>

#include <sinew/core/parallel.h>
#include <sinew/io/vtu.h>
#include "element_text.h"
#include "support/scratch.h"

namespace sinew::encode_test {

std::vector<double> waves(std::size_t count) {
  std::vector<double> values(count);
  for (std::size_t i = 0; i < count; ++i) values[i] = std::sin(1e-3 * static_cast<double>(i));
  return values;
}

Dataset particles_of(std::size_t count) {
  Dataset data;
  const auto values = waves(3 * count);
  for (std::size_t i = 0; i < count; ++i) data.points.push_back(Vec3(&values[3 * i]));
  data.connectivity = vertex_cells(count);
  data.point_columns = {column("id", vertex_cells(count)), column("velocity", data.points)};
  return data;
}

TEST(RangeOf, IsThatOfAScalarAndOfAVectorsMagnitude) {
  std::vector<double> values(30000, 1.0);
  values[11] = -2, values[29999] = 5, values[20000] = std::nan("");
  const ValueRange scalar = range_of(float64_array(values.data(), values.size()), 1);
  EXPECT_EQ(scalar.low, -2);
  EXPECT_EQ(scalar.high, 5);
  const ValueRange vector = range_of(float32_array(values.data(), values.size()), 3);
  EXPECT_NEAR(vector.low, std::sqrt(3.0), 1e-15);
  EXPECT_NEAR(vector.high, std::sqrt(27.0), 1e-15);
  const std::vector<std::int32_t> whole{-7, 3};
  EXPECT_EQ(range_of(int32_array(whole), 1).low, -7);
  EXPECT_GT(range_of(float64_array(nullptr, 0), 1).low, 0);
}

TEST(ElementText, HasTheSameBytesForEveryThreadCount) {
  const auto values = waves(700000);  // several pieces, the last one short
  for (const Encoding encoding : {Encoding::zlib, Encoding::lz4, Encoding::none}) {
    std::string first;
    for (const int threads : {1, 2, 3, 8})
      with_threads(threads, [&] {
        const auto text = element_text(float32_array(values.data(), values.size()), encoding);
        if (first.empty()) first = text;
        EXPECT_EQ(text, first) << threads;
      });
  }
}

using EncodedVtu = Scratch;

TEST_F(EncodedVtu, OfManyBlocksComesBackEqualWhereverTheLastOneEnds) {
  constexpr std::size_t ids_per_block = 8192;
  for (const Encoding encoding : {Encoding::zlib, Encoding::lz4, Encoding::raw, Encoding::none})
    for (const std::size_t count : {std::size_t{1}, ids_per_block - 1, ids_per_block,
                                    ids_per_block + 1, 40 * ids_per_block}) {
      const Dataset data = particles_of(count);
      write_vtu(folder / "f.vtu", data, {encoding, true, "particles", 0.01});
      const Dataset read = read_vtu(folder / "f.vtu");
      EXPECT_EQ(read.points, data.points) << count;
      EXPECT_EQ(read.connectivity, data.connectivity) << count;
      EXPECT_EQ(integers(read.point_columns, "id"), integers(data.point_columns, "id")) << count;
      EXPECT_EQ(vectors(read.point_columns, "velocity"), data.points) << count;
    }
}

TEST_F(EncodedVtu, NamesWithSignsOfXmlComeBack) {
  Dataset data = particles_of(3);
  data.point_columns = {column("<a & \"b\">", std::vector<double>{1, 2, 3})};
  write_vtu(folder / "f.vtu", data, {Encoding::zlib, true, "particles", 0.01});
  EXPECT_EQ(read_vtu(folder / "f.vtu").point_columns.front().name, "<a & \"b\">");
}

}  // namespace sinew::encode_test
