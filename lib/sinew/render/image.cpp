// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/render/image.h>

#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPNGWriter.h>
#include <vtkUnsignedCharArray.h>
#include <algorithm>
#include <cmath>

#include <sinew/core/file.h>

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

void paste(Image& image, const Image& part, int x, int y) {
  const int left = std::max(0, -x), right = std::min(part.width, image.width - x);
  if (right <= left) return;
  for (int row = std::max(0, -y); row < std::min(part.height, image.height - y); ++row)
    std::copy_n(part.at(left, row), 3 * (right - left), image.at(x + left, y + row));
}

void fill(Image& image, int x, int y, int width, int height, const Color& color) {
  for (int row = std::max(0, y); row < std::min(y + height, image.height); ++row)
    for (int column = std::max(0, x); column < std::min(x + width, image.width); ++column)
      std::copy(color.begin(), color.end(), image.at(column, row));
}

namespace {

/// VTK counts rows from below.
void copy_flipped(const Image& image, vtkImageData& out) {
  out.SetDimensions(image.width, image.height, 1);
  out.AllocateScalars(VTK_UNSIGNED_CHAR, 3);
  for (int y = 0; y < image.height; ++y)
    std::copy_n(image.at(0, y), 3 * image.width,
                static_cast<std::uint8_t*>(out.GetScalarPointer(0, image.height - 1 - y, 0)));
}

}  // namespace

void write_png(const Image& image, const std::string& path) {
  vtkNew<vtkImageData> data;
  copy_flipped(image, *data);
  vtkNew<vtkPNGWriter> writer;  // to memory: VTK does not detect a full disk
  writer->SetInputData(data);
  writer->WriteToMemoryOn();
  writer->Write();
  const vtkUnsignedCharArray* bytes = writer->GetResult();
  NewFile file(path);
  file.write(
      const_cast<vtkUnsignedCharArray*>(bytes)->GetPointer(0),
      static_cast<std::size_t>(const_cast<vtkUnsignedCharArray*>(bytes)->GetNumberOfValues()));
  file.finish();
}

}  // namespace sinew
