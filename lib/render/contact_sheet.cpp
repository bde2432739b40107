// SPDX-License-Identifier: GPL-3.0-or-later
#include "render/contact_sheet.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "render/text.h"

namespace sinew {
namespace {

struct Column {
  Box frame;  ///< as wide as its shot, as high as all of them
  int x = 0, width = 0;
};

/// Where everything lies on the sheet, pixels.
struct Layout {
  std::vector<Column> columns;
  int width = 0, height = 0, margin = 0, row_height = 0, captions = 0, bar = 0;
  TextStyle text;
};

std::vector<Column> columns_of(const std::vector<Shot>& shots, const Mat3& view) {
  std::vector<Column> columns;
  Box all;
  for (const Shot& shot : shots) {
    columns.push_back({seen(view, shot), 0, 0});
    all.extend(columns.back().frame);
  }
  for (Column& column : columns)
    for (int axis : {1, 2}) {
      column.frame.min()[axis] = all.min()[axis];
      column.frame.max()[axis] = all.max()[axis];
    }
  return columns;
}

double summed_width(const std::vector<Column>& columns) {
  double sum = 0;
  for (const Column& column : columns) sum += column.frame.sizes().x();
  return sum;
}

int caption_lines(const std::vector<Shot>& shots) {
  std::ptrdiff_t most = 0;
  for (const Shot& shot : shots)
    if (!shot.caption.empty())
      most = std::max(most, 1 + std::count(shot.caption.begin(), shot.caption.end(), '\n'));
  return static_cast<int>(most);
}

/// The largest scale at which the columns, with gaps between, fit into the width and the row
/// height.
Layout layout_of(const std::vector<Shot>& shots, const SheetOptions& options) {
  Layout layout;
  layout.columns = columns_of(shots, options.view);
  const int count = static_cast<int>(shots.size());
  const int gap = layout.margin = std::max(12, options.width / 32);
  const double space = options.width - (count + 1) * gap;
  const double high = layout.columns.front().frame.sizes().y();
  const double scale = std::min(space / summed_width(layout.columns), options.row_height / high);
  layout.text.size = std::max(11, options.width / 64);
  layout.row_height = std::max(16, static_cast<int>(std::lround(scale * high)));
  int x = gap;
  for (Column& column : layout.columns) {
    column.x = x;
    column.width = std::max(16, static_cast<int>(std::lround(scale * column.frame.sizes().x())));
    x += column.width + gap;
  }
  layout.width = x;
  layout.captions = 2 * layout.margin + 2 * layout.row_height + layout.margin / 2;
  layout.bar =
      layout.captions + caption_lines(shots) * line_height(layout.text) + layout.margin / 2;
  layout.height = layout.bar + colour_bar_height(layout.text) + layout.margin / 2;
  return layout;
}

void draw_panel(Painter& painter, Image& sheet, const Shot& shot, int x, int y,
                const PictureOptions& options) {
  paste(sheet, painter.draw(shot, options), x, y);
}

void draw_column(Painter& painter, Image& sheet, const Shot& shot, const Layout& layout,
                 const Column& column, const SheetOptions& options) {
  PictureOptions panel{
      View::surface, {options.view, column.frame}, column.width, layout.row_height, 1,
      options.finish};
  draw_panel(painter, sheet, shot, column.x, layout.margin, panel);
  panel.view = View::particles;
  draw_panel(painter, sheet, shot, column.x, 2 * layout.margin + layout.row_height, panel);
  TextStyle words = layout.text;
  words.align = Align::centre;
  write_text(sheet, shot.caption, column.x + column.width / 2, layout.captions, words);
}

}  // namespace

Image contact_sheet(Painter& painter, const std::vector<Shot>& shots, const SheetOptions& options) {
  if (shots.empty()) throw bad_input("a contact sheet needs shots", "give at least one");
  const Layout layout = layout_of(shots, options);
  Image sheet(layout.width, layout.height);
  for (std::size_t i = 0; i < shots.size(); ++i)
    draw_column(painter, sheet, shots[i], layout, layout.columns[i], options);
  TextStyle words = layout.text;
  words.size = std::max(10, words.size * 4 / 5);
  const int bar = layout.width / 3;
  draw_colour_bar(sheet, painter.scale(), (layout.width - bar) / 2, layout.bar, bar, words);
  return sheet;
}

Image movie_frame(Painter& painter, const Shot& shot, const FrameOptions& options) {
  TextStyle words;
  words.size = std::max(11, options.height / 32);
  const int margin = options.height / 30, foot = colour_bar_height(words) + margin;
  const int wide = (options.width - 3 * margin) / 2, high = options.height - foot - 2 * margin;
  Image frame(options.width, options.height);
  PictureOptions panel{View::surface, options.camera, wide, high, 4, options.finish};
  draw_panel(painter, frame, shot, margin, margin, panel);
  panel.view = View::particles;
  draw_panel(painter, frame, shot, 2 * margin + wide, margin, panel);
  const int below = options.height - foot;
  write_text(frame, shot.caption, 2 * margin, below, words);
  const int bar = wide * 3 / 5;
  draw_colour_bar(frame, painter.scale(), options.width - 2 * margin - bar, below, bar, words);
  return frame;
}

}  // namespace sinew
