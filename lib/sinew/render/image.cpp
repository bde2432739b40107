// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/render/image.h>

#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPNGWriter.h>
#include <vtkUnsignedCharArray.h>
#include <algorithm>
#include <array>
#include <cmath>

#include <sinew/core/error.h>
#include <sinew/core/file.h>
#include <sinew/core/parallel.h>

namespace sinew {

Image::Image(int columns, int rows, const Color& color)
    : width(columns), height(rows), rgb(3 * static_cast<std::size_t>(columns) * rows) {
  fill(*this, 0, 0, columns, rows, color);
}

Image halved(const Image& image) {
  Image half(image.width / 2, image.height / 2);
  for (int y = 0; y < half.height; ++y)
    for (int x = 0; x < half.width; ++x) {
      const std::uint8_t* above = image.at(2 * x, 2 * y);
      const std::uint8_t* below = image.at(2 * x, 2 * y + 1);
      for (int c = 0; c < 3; ++c)
        half.at(x, y)[c] =
            static_cast<std::uint8_t>((above[c] + above[c + 3] + below[c] + below[c + 3] + 2) / 4);
    }
  return half;
}

namespace {

/// Brightness of a row's pixels, 0 .. 255, by the weights of Rec. 601 in sixteenths; the row
/// continues beyond both ends.
using Brightness = std::vector<std::uint8_t>;

void brightness_of_row(const Image& image, int row, Brightness& values) {
  const std::uint8_t* pixel = image.at(0, std::clamp(row, 0, image.height - 1));
  for (int x = 0; x < image.width; ++x, pixel += 3)
    values[x + 1] = static_cast<std::uint8_t>((5 * pixel[0] + 9 * pixel[1] + 2 * pixel[2]) / 16);
  values.front() = values[1];
  values.back() = values[image.width];
}

/// The brightness of a row and of those beside it.
struct ThreeRows {
  explicit ThreeRows(const Image& image) : above(image.width + 2), here(above), below(above) {}
  Brightness above, here, below;
};

/// Difference between the brightest and the darkest of each pixel and its four neighbors.
void contrast_of_row(const ThreeRows& rows, int width, Brightness& contrast) {
  const std::uint8_t *above = rows.above.data(), *here = rows.here.data(),
                     *below = rows.below.data();
  for (int x = 0; x < width; ++x) {
    const std::uint8_t low =
        std::min(std::min(std::min(above[x + 1], below[x + 1]), std::min(here[x], here[x + 2])),
                 here[x + 1]);
    const std::uint8_t high =
        std::max(std::max(std::max(above[x + 1], below[x + 1]), std::max(here[x], here[x + 2])),
                 here[x + 1]);
    contrast[x] = static_cast<std::uint8_t>(high - low);
  }
}

/// Blends a pixel with its neighbors across the edge, by how much it sticks out of their mean.
void smooth_pixel(const Image& image, int x, int y, const std::array<int, 4>& around, int here,
                  std::uint8_t* out) {
  const auto& [up, down, left, right] = around;
  const bool horizontal = std::abs(up + down - 2 * here) >= std::abs(left + right - 2 * here);
  const bool first = horizontal ? std::abs(up - here) >= std::abs(down - here)
                                : std::abs(left - here) >= std::abs(right - here);
  const int step = first ? -1 : 1;
  const int other_x = std::clamp(x + (horizontal ? 0 : step), 0, image.width - 1);
  const int other_y = std::clamp(y + (horizontal ? step : 0), 0, image.height - 1);
  const int contrast =
      std::max({up, down, left, right, here}) - std::min({up, down, left, right, here});
  const float out_of_mean =
      std::abs(static_cast<float>(up + down + left + right) / 4 - static_cast<float>(here)) /
      static_cast<float>(contrast);
  const float weight = 0.5F * std::min(1.0F, 1.5F * out_of_mean);
  const std::uint8_t *own = image.at(x, y), *other = image.at(other_x, other_y);
  for (int c = 0; c < 3; ++c)
    out[c] = static_cast<std::uint8_t>((1 - weight) * own[c] + weight * other[c] + 0.5F);
}

}  // namespace

Image with_smooth_edges(const Image& image) {
  constexpr int min_contrast = 16;
  Image smooth = image;
  parallel_for(static_cast<std::size_t>(image.height), 16, [&](std::size_t begin, std::size_t end) {
    ThreeRows rows(image);
    Brightness contrast(image.width);
    brightness_of_row(image, static_cast<int>(begin) - 1, rows.here);
    brightness_of_row(image, static_cast<int>(begin), rows.below);
    for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y) {
      rows.above.swap(rows.here), rows.here.swap(rows.below);
      brightness_of_row(image, y + 1, rows.below);
      contrast_of_row(rows, image.width, contrast);
      const auto& [above, here, below] = rows;
      for (int x = 0; x < image.width; ++x)
        if (contrast[x] >= min_contrast)
          smooth_pixel(image, x, y, {above[x + 1], below[x + 1], here[x], here[x + 2]}, here[x + 1],
                       smooth.at(x, y));
    }
  });
  return smooth;
}

void paste(Image& image, const Image& part, int x, int y) {
  const int left = std::max(0, -x), right = std::min(part.width, image.width - x);
  if (right <= left) return;
  for (int row = std::max(0, -y); row < std::min(part.height, image.height - y); ++row)
    std::copy_n(part.at(left, row), 3 * (right - left), image.at(x + left, y + row));
}

void fill(Image& image, int x, int y, int width, int height, const Color& color) {
  const int left = std::max(0, x), right = std::min(x + width, image.width);
  const int top = std::max(0, y), bottom = std::min(y + height, image.height);
  if (left >= right || top >= bottom) return;
  for (int column = left; column < right; ++column)
    std::copy(color.begin(), color.end(), image.at(column, top));
  for (int row = top + 1; row < bottom; ++row)
    std::copy_n(image.at(left, top), 3 * (right - left), image.at(left, row));
}

Image cut_out(const Image& on_white, const Image& on_black) {
  if (on_white.width != on_black.width || on_white.height != on_black.height)
    throw bad_input("images to be cut out differ in size", "draw both alike");
  Image image = on_black;
  image.alpha.resize(image.rgb.size() / 3);
  for (std::size_t i = 0; i < image.alpha.size(); ++i) {
    int difference = 0;
    for (std::size_t c = 3 * i; c < 3 * i + 3; ++c) difference += on_white.rgb[c] - on_black.rgb[c];
    const int alpha = std::clamp(255 - (difference + 1) / 3, 0, 255);
    image.alpha[i] = static_cast<std::uint8_t>(alpha);
    for (std::size_t c = 3 * i; alpha > 0 && c < 3 * i + 3; ++c)
      image.rgb[c] =
          static_cast<std::uint8_t>(std::min(255, (255 * on_black.rgb[c] + alpha / 2) / alpha));
  }
  return image;
}

namespace {

/// VTK counts rows from below.
void copy_flipped(const Image& image, vtkImageData& out) {
  out.SetDimensions(image.width, image.height, 1);
  const int parts = image.alpha.empty() ? 3 : 4;
  out.AllocateScalars(VTK_UNSIGNED_CHAR, parts);
  for (int y = 0; y < image.height; ++y) {
    auto* to = static_cast<std::uint8_t*>(out.GetScalarPointer(0, image.height - 1 - y, 0));
    for (int x = 0; x < image.width; ++x, to += parts) {
      std::copy_n(image.at(x, y), 3, to);
      if (parts == 4) to[3] = image.alpha[static_cast<std::size_t>(y) * image.width + x];
    }
  }
}

}  // namespace

std::string png_of(const Image& image) {
  vtkNew<vtkImageData> data;
  copy_flipped(image, *data);
  vtkNew<vtkPNGWriter> writer;  // to memory: VTK does not detect a full disk
  writer->SetInputData(data);
  writer->WriteToMemoryOn();
  writer->Write();
  vtkUnsignedCharArray* bytes = writer->GetResult();
  return {reinterpret_cast<const char*>(bytes->GetPointer(0)),
          static_cast<std::size_t>(bytes->GetNumberOfValues())};
}

void write_png(const Image& image, const std::string& path) {
  const std::string bytes = png_of(image);
  NewFile file(path);
  file.write(bytes.data(), bytes.size());
  file.finish();
}

}  // namespace sinew
