// SPDX-License-Identifier: GPL-3.0-or-later
// The writers of the table of formats, and rows of text made by all threads.
//
//     write_rows(file, cloud.positions.size(), [&](std::string& text, std::size_t i) {
//       put_row(text, ' ', i, cloud.positions[i].x());
//     });
#pragma once

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include <sinew/core/parallel.h>
#include <sinew/io/particle_formats/formats.h>

namespace sinew {

// Each adds one frame at the end of the file.
void add_lammps_data(NewFile& file, const ParticleCloud& cloud);
void add_lammps_dump(NewFile& file, const ParticleCloud& cloud);
void add_xyz(NewFile& file, const ParticleCloud& cloud);
void add_csv(NewFile& file, const ParticleCloud& cloud);
void add_yade(NewFile& file, const ParticleCloud& cloud);
void add_peridigm(NewFile& file, const ParticleCloud& cloud);
void add_bgeo(NewFile& file, const ParticleCloud& cloud);
void add_gltf_points(NewFile& file, const ParticleCloud& cloud);

/// Beside a mesh NAME.txt of several regions, the nodes of each: NAME_block_1.txt and so on.
void write_node_sets(const std::filesystem::path& mesh, const ParticleCloud& cloud);

inline void put_value(std::string& text, std::string_view word) { text += word; }
inline void put_value(std::string& text, char letter) { text += letter; }

/// The shortest text that reads back as the same number.
template <class Number>
void put_value(std::string& text, Number value) requires std::is_arithmetic_v<Number> {
  char digits[32];
  text.append(digits, std::to_chars(digits, digits + sizeof digits, value).ptr);
}

/// CalculiX reads the first 20 letters of a number.
inline std::string short_number(double value) {
  char digits[32];
  const auto end =
      std::to_chars(digits, digits + sizeof digits, value, std::chars_format::scientific, 11).ptr;
  return {digits, end};
}

/// A coordinate (m). Far from the origin all of its digits are needed, and fit.
inline std::string short_place(double value) {
  constexpr double far = 1e3;
  std::string digits;
  if (std::abs(value) >= far) put_value(digits, value);
  return digits.empty() || digits.size() > 20 ? short_number(value) : digits;
}

inline void put_value(std::string& text, const Vec3& v) {
  put_value(text, v.x()), text += ' ', put_value(text, v.y()), text += ' ', put_value(text, v.z());
}

/// Values with `separator` between them, without an end of line.
template <class First, class... Rest>
void put_words(std::string& text, [[maybe_unused]] char separator, const First& first,
               const Rest&... rest) {
  put_value(text, first);
  ((text += separator, put_value(text, rest)), ...);
}

template <class... Values>
void put_row(std::string& text, char separator, const Values&... values) {
  put_words(text, separator, values...);
  text += '\n';
}

/// Calls put(bytes, row) for every row, from many threads, and writes what it appends to `bytes`,
/// in the order of rows. Throws not written.
template <class Put>
void write_rows(NewFile& file, std::size_t rows, const Put& put) {
  constexpr std::size_t piece = 4096, at_a_time = 64 * piece;
  std::vector<std::string> pieces(at_a_time / piece);
  for (std::size_t begin = 0; begin < rows; begin += at_a_time) {
    const std::size_t count = std::min(at_a_time, rows - begin);
    parallel_for(count, piece, [&](std::size_t from, std::size_t to) {
      std::string& bytes = pieces[from / piece];
      bytes.clear();
      for (std::size_t row = from; row < to; ++row) put(bytes, begin + row);
    });
    for (std::size_t k = 0; k * piece < count; ++k) file.write(pieces[k].data(), pieces[k].size());
  }
}

inline void write_text(NewFile& file, const std::string& text) {
  file.write(text.data(), text.size());
}

}  // namespace sinew
