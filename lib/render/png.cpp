// SPDX-License-Identifier: GPL-3.0-or-later
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPNGWriter.h>
#include <vtkUnsignedCharArray.h>

#include <algorithm>

#include "core/file.h"
#include "render/image.h"

namespace sinew {
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
  vtkNew<vtkPNGWriter> writer;  // to memory: VTK does not notice a full disk
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
