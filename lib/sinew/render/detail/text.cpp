// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/render/detail/text.h>

#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkStdString.h>
#include <vtkTextProperty.h>
#include <vtkTextRenderer.h>
#include <algorithm>
#include <sstream>
#include <utility>
#include <vector>

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

int text_width(const std::string& text, const TextStyle& style) {
  vtkNew<vtkTextProperty> look = property(style);
  std::istringstream lines(text);
  int widest = 0;
  for (std::string line; std::getline(lines, line);) {
    int box[4] = {0, 0, 0, 0};
    if (vtkTextRenderer::GetInstance()->GetBoundingBox(look.Get(), vtkStdString(line), box,
                                                       dots_per_inch))
      widest = std::max(widest, box[1] - box[0] + 1);
  }
  return widest;
}

namespace {

/// Parts of a line, each with the space or the comma and space that end it.
std::vector<std::string> parts_of(const std::string& line, const std::string& end) {
  std::vector<std::string> parts;
  for (std::size_t at = 0; at < line.size();) {
    const std::size_t found = line.find(end, at);
    const std::size_t next = found == std::string::npos ? line.size() : found + end.size();
    parts.push_back(line.substr(at, next - at));
    at = next;
  }
  return parts;
}

std::string trimmed(std::string line) {
  line.erase(line.find_last_not_of(' ') + 1);
  line.erase(0, line.find_first_not_of(' '));
  return line;
}

/// Appends the parts of a line to `lines`, as many as fit on each; parts that are too wide by
/// words.
void fill_lines(std::vector<std::string>& lines, const std::string& line, const std::string& end,
                int width, const TextStyle& style) {
  std::string filled;
  const auto flush = [&] {
    if (!filled.empty()) lines.push_back(trimmed(std::exchange(filled, "")));
  };
  for (const std::string& part : parts_of(line, end)) {
    if (text_width(trimmed(filled + part), style) > width) flush();
    if (end != " " && text_width(trimmed(part), style) > width)
      fill_lines(lines, part, " ", width, style);
    else
      filled += part;
  }
  flush();
}

}  // namespace

std::string wrapped(const std::string& text, int width, const TextStyle& style) {
  std::istringstream given(text);
  std::vector<std::string> lines;
  for (std::string line; std::getline(given, line);) {
    if (text_width(line, style) <= width)
      lines.push_back(line);
    else
      fill_lines(lines, line, ", ", width, style);
  }
  std::string all;
  for (const std::string& line : lines) all += (all.empty() ? "" : "\n") + line;
  return all;
}

void write_text(Image& image, const std::string& text, int x, int y, const TextStyle& style) {
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line); y += line_height(style))
    write_line(image, line, x, y + style.size, style);
}

}  // namespace sinew
