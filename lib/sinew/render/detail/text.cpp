// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/render/detail/text.h>

#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkStdString.h>
#include <vtkTextProperty.h>
#include <vtkTextRenderer.h>
#include <sstream>

namespace sinew {
namespace {

constexpr int dots_per_inch = 72;  // makes a point of the font a pixel

vtkNew<vtkTextProperty> property(const TextStyle& style) {
  vtkNew<vtkTextProperty> look;
  look->SetFontFamilyToArial();
  look->SetFontSize(style.size);
  look->SetColor(style.color[0] / 255.0, style.color[1] / 255.0, style.color[2] / 255.0);
  return look;
}

void blend(std::uint8_t* pixel, const std::uint8_t* over) {
  const int opacity = over[3];
  for (int c = 0; c < 3; ++c)
    pixel[c] =
        static_cast<std::uint8_t>((opacity * over[c] + (255 - opacity) * pixel[c] + 127) / 255);
}

/// `x` is the left end, `baseline` that of the letters.
void write_line(Image& image, const std::string& line, int x, int baseline,
                const TextStyle& style) {
  vtkNew<vtkImageData> letters;
  int size[2] = {0, 0}, box[4] = {0, 0, 0, 0};
  vtkNew<vtkTextProperty> look = property(style);
  vtkTextRenderer& writer = *vtkTextRenderer::GetInstance();
  if (!writer.GetBoundingBox(look.Get(), vtkStdString(line), box, dots_per_inch) ||
      !writer.RenderString(look.Get(), vtkStdString(line), letters.Get(), size, dots_per_inch))
    return;
  const int width = box[1] - box[0] + 1, height = box[3] - box[2] + 1;
  if (style.align == Align::center) x -= width / 2;
  if (style.align == Align::right) x -= width;
  for (int row = 0; row < height; ++row)
    for (int column = 0; column < width; ++column) {
      const int to_x = x + column, to_y = baseline - box[2] - row;
      if (to_x < 0 || to_y < 0 || to_x >= image.width || to_y >= image.height) continue;
      blend(image.at(to_x, to_y),
            static_cast<std::uint8_t*>(letters->GetScalarPointer(column, row, 0)));
    }
}

}  // namespace

void write_text(Image& image, const std::string& text, int x, int y, const TextStyle& style) {
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line); y += line_height(style))
    write_line(image, line, x, y + style.size, style);
}

}  // namespace sinew
