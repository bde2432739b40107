// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/render/figure.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <sstream>
#include <string>

#include <sinew/core/error.h>
#include <sinew/core/file.h>
#include <sinew/core/text.h>
#include <sinew/render/detail/keys.h>

namespace sinew {

namespace {

struct Layout {
  TextStyle words;
  int margin = 0;
  int top = 0;             ///< top of the panels
  int wide = 0, high = 0;  ///< each panel
  int foot = 0;            ///< top of caption and color bar
};

Layout layout_of(const std::vector<Panel>& panels, const FigureOptions& options) {
  Layout layout;
  const int count = static_cast<int>(panels.size());
  layout.words.size = std::max(11, options.height / 32);
  layout.words.color = options.paper.ink;
  layout.margin = options.height / 30;
  const bool titled = std::any_of(panels.begin(), panels.end(),
                                  [](const Panel& panel) { return !panel.title.empty(); });
  layout.top = layout.margin + (titled ? line_height(layout.words) : 0);
  layout.foot = options.height - color_bar_height(layout.words) - layout.margin;
  layout.wide = (options.width - (count + 1) * layout.margin) / count;
  layout.high = layout.foot - layout.margin - layout.top;
  return layout;
}

}  // namespace

Image without_background(const Color& ink, const std::function<Canvas(const Paper&)>& draw) {
  const auto on = [&](const Color& background) { return draw({background, ink}).pixels(); };
  return cut_out(on({255, 255, 255}), on({0, 0, 0}));
}

void write_page(const std::function<Canvas(const Paper&)>& draw, const PageFiles& files,
                const std::string& path) {
  if (files.backdrop.transparent)
    return write_png(without_background(files.backdrop.paper.ink, draw), path);
  const Canvas page = draw(files.backdrop.paper);
  write_png(page.pixels(), path);
  if (files.print_width > 0)
    write_file(std::filesystem::path(path).replace_extension(".svg"), page.svg(files.print_width));
}

Canvas figure(const std::vector<Panel>& panels, const FigureOptions& options) {
  if (panels.empty()) throw bad_input("a figure needs panels", "give at least one");
  const Layout layout = layout_of(panels, options);
  Canvas page(options.width, options.height, options.paper.background);
  int x = layout.margin;
  for (const Panel& panel : panels) {
    const PictureOptions picture{panel.view, options.camera, layout.wide,  layout.high,
                                 4,          options.finish, options.paper};
    page.add(panel.painter->draw(*panel.snapshot, picture), x, layout.top);
    TextStyle title = layout.words;
    title.align = Align::center;
    page.write(panel.title, x + layout.wide / 2, layout.margin / 2, title);
    x += layout.wide + layout.margin;
  }
  if (options.axes)
    draw_tripod(page, options.camera.view, layout.margin, layout.top + layout.high,
                tripod_size(layout.wide, layout.high));
  page.write(panels.front().snapshot->caption, 2 * layout.margin, layout.foot, layout.words);
  if (std::none_of(panels.begin(), panels.end(),
                   [](const Panel& panel) { return shows_values(panel.view, *panel.snapshot); }))
    return page;
  const int bar = std::min(options.width / 3, 3 * options.height / 5);
  draw_color_bar(page, panels.front().painter->scale(), options.width - 2 * layout.margin - bar,
                 layout.foot, bar, layout.words);
  return page;
}

namespace {

struct Column {
  Box frame;  ///< frame as wide as its snapshots, as high as all of them
  int x = 0, width = 0;
};

/// Layout of the sheet, pixels.
struct SheetLayout {
  std::vector<Column> columns;
  std::vector<int> rows;  ///< top of the panels of each
  int width = 0, height = 0, margin = 0, row_height = 0, captions = 0, bar = 0;
  double scale = 0;  ///< pixels per meter
  TextStyle text;
  Color paper = palette::paper;

  /// A smaller one for the foot.
  TextStyle small() const {
    TextStyle words = text;
    words.size = std::max(10, words.size * 4 / 5);
    return words;
  }
};

std::vector<Column> columns_of(const std::vector<SheetRow>& rows, const Mat3& view) {
  std::vector<Column> columns(rows.front().snapshots->size());
  Box all;
  for (const SheetRow& row : rows)
    for (std::size_t i = 0; i < columns.size(); ++i)
      columns[i].frame.extend(seen(view, (*row.snapshots)[i]));
  for (const Column& column : columns) all.extend(column.frame);
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

int lines_in(const std::string& text) {
  return text.empty() ? 0 : static_cast<int>(1 + std::count(text.begin(), text.end(), '\n'));
}

int caption_lines(const std::vector<Snapshot>& snapshots) {
  int most = 0;
  for (const Snapshot& snapshot : snapshots) most = std::max(most, lines_in(snapshot.caption));
  return most;
}

/// Largest scale at which the columns, with gaps between, fit into the width and the row height.
void lay_columns(SheetLayout& layout, const SheetOptions& options) {
  const int count = static_cast<int>(layout.columns.size()), gap = layout.margin;
  const double space = options.width - (count + 1) * gap;
  const double high = layout.columns.front().frame.sizes().y();
  const double scale = std::min(space / summed_width(layout.columns), options.row_height / high);
  layout.scale = scale;
  layout.row_height = std::max(16, static_cast<int>(std::lround(scale * high)));
  layout.width = gap;
  for (Column& column : layout.columns) {
    column.x = layout.width;
    column.width = std::max(16, static_cast<int>(std::lround(scale * column.frame.sizes().x())));
    layout.width += column.width + gap;
  }
}

bool show_values(const std::vector<SheetRow>& rows) {
  return std::any_of(rows.begin(), rows.end(), [](const SheetRow& row) {
    return shows_values(row.view, row.snapshots->front());
  });
}

/// Moves the columns apart until the title has room, and with `keys` what is below them.
void widen(SheetLayout& layout, const SheetOptions& options, bool keys) {
  constexpr double letter = 0.52;  // mean width, over the size
  std::size_t longest = keys ? 80 : 0;
  std::istringstream title(options.title);
  for (std::string line; std::getline(title, line);) longest = std::max(longest, line.size());
  const double room = letter * layout.text.size * static_cast<double>(longest);
  const int least = std::min(options.width, 2 * layout.margin + static_cast<int>(room));
  const int missing = least - layout.width;
  if (missing <= 0) return;
  const int gaps = static_cast<int>(layout.columns.size()) + 1;
  for (int k = 0; k < gaps - 1; ++k)
    layout.columns[static_cast<std::size_t>(k)].x += missing * (k + 1) / gaps;
  layout.width = least;
}

SheetLayout layout_of(const std::vector<SheetRow>& rows, const SheetOptions& options) {
  SheetLayout layout;
  layout.columns = columns_of(rows, options.view);
  layout.margin = std::max(12, options.width / 32);
  layout.text.size = std::max(11, options.width / 64);
  layout.text.color = options.paper.ink;
  layout.paper = options.paper.background;
  lay_columns(layout, options);
  widen(layout, options, options.rulers && options.axes && show_values(rows));
  int y = 0;
  if (!options.title.empty())
    y = layout.margin / 2 + lines_in(options.title) * line_height(layout.text);
  for (const SheetRow& row : rows) {
    y += layout.margin + (row.title.empty() ? 0 : line_height(layout.text));
    layout.rows.push_back(y);
    y += layout.row_height;
  }
  layout.captions = y + layout.margin / 2;
  layout.bar = layout.captions + caption_lines(*rows.front().snapshots) * line_height(layout.text) +
               layout.margin / 2;
  const bool has_foot = options.axes || options.rulers || show_values(rows);
  layout.height = layout.bar + (has_foot ? color_bar_height(layout.text) + layout.margin / 2 : 0);
  return layout;
}

void draw_row(Canvas& sheet, const SheetRow& row, int y, const SheetLayout& layout,
              const SheetOptions& options) {
  sheet.write(row.title, layout.margin, y - line_height(layout.text), layout.text);
  for (std::size_t i = 0; i < layout.columns.size(); ++i) {
    const Column& column = layout.columns[i];
    const PictureOptions panel{row.view,
                               {options.view, column.frame},
                               column.width,
                               layout.row_height,
                               1,
                               options.finish,
                               options.paper};
    sheet.add(row.painter->draw((*row.snapshots)[i], panel), column.x, y);
  }
}

void write_captions(Canvas& sheet, const std::vector<Snapshot>& snapshots,
                    const SheetLayout& layout) {
  TextStyle words = layout.text;
  words.align = Align::center;
  for (std::size_t i = 0; i < snapshots.size(); ++i)
    sheet.write(snapshots[i].caption, layout.columns[i].x + layout.columns[i].width / 2,
                layout.captions, words);
}

/// The longest of 1, 2 and 5 times a power of ten, m, that is no longer than `most`.
double round_length(double most) {
  const double power = std::pow(10, std::floor(std::log10(most)));
  for (const double times : {5.0, 2.0})
    if (times * power <= most) return times * power;
  return power;
}

std::string length_text(double meters) {
  if (meters < 1e-3) return three_digits(1e6 * meters) + " µm";
  if (meters < 0.01) return three_digits(1e3 * meters) + " mm";
  if (meters < 1) return three_digits(1e2 * meters) + " cm";
  return three_digits(meters) + " m";
}

/// A bar of a round length at the foot's left, to the scale of the panels.
void draw_scale_bar(Canvas& sheet, const SheetLayout& layout, int x, const Color& ink) {
  const double length = round_length(0.16 * layout.width / layout.scale);
  const int pixels = static_cast<int>(std::lround(length * layout.scale));
  const int thick = std::max(2, layout.text.size / 8), y = layout.bar + line_height(layout.small());
  sheet.fill(x, y, pixels, thick, ink);
  for (const int end : {x, x + pixels - thick})
    sheet.fill(end, y - 2 * thick, thick, 5 * thick, ink);
  TextStyle words = layout.small();
  words.align = Align::center;
  sheet.write(length_text(length), x + pixels / 2, y + 4 * thick, words);
}

bool has_bones(const std::vector<SheetRow>& rows) {
  return std::any_of(rows.begin(), rows.end(), [](const SheetRow& row) {
    return !row.snapshots->front().bones.empty() && shows_axes(row.view);
  });
}

/// What a color stands for.
struct KeyEntry {
  Color color;
  std::string words;
};

/// The entries below each other, from the foot's right end; returns the left end.
int draw_key(Canvas& sheet, const SheetLayout& layout, int right, int columns,
             const std::vector<KeyEntry>& entries) {
  const TextStyle words = layout.small();
  const int line = line_height(words), side = std::max(4, words.size / 2);
  const int x = right - columns * words.size;
  int y = layout.bar;
  for (const KeyEntry& entry : entries) {
    sheet.fill(x, y + line / 2 - side / 2, side, side, entry.color);
    sheet.write(entry.words, x + 2 * side, y, words);
    y += line;
  }
  return x;
}

/// The bones' axes, and forces of supports and loads, as far as the rows show them.
void draw_keys(Canvas& sheet, const std::vector<SheetRow>& rows, const SheetLayout& layout,
               double strongest_force) {
  int right = layout.width - layout.margin / 2;
  if (has_bones(rows))
    right = draw_key(sheet, layout, right, 9,
                     {{palette::axes[0], "along the bone"},
                      {palette::axes[1], "its side y"},
                      {palette::axes[2], "its side z"}});
  std::vector<KeyEntry> forces;
  bool loads = false, supports = false;
  for (const Snapshot& snapshot : *rows.front().snapshots)
    for (const SnapshotForce& force : snapshot.forces) (force.is_load ? loads : supports) = true;
  if (supports) forces.push_back({palette::held, "force of a support"});
  if (loads) forces.push_back({palette::loaded, "load"});
  if (forces.empty()) return;
  forces.push_back({layout.paper, "longest: " + three_digits(strongest_force) + " N"});
  draw_key(sheet, layout, right, 12, forces);
}

void draw_foot(Canvas& sheet, const std::vector<SheetRow>& rows, const SheetLayout& layout,
               const SheetOptions& options) {
  const int corner = options.axes ? (layout.height - layout.bar) : 0;
  if (options.axes)
    draw_tripod(sheet, options.view, layout.margin / 2, layout.height, corner * 10 / 28);
  if (options.rulers) draw_scale_bar(sheet, layout, layout.margin / 2 + corner, options.paper.ink);
  if (options.rulers) draw_keys(sheet, rows, layout, options.strongest_force);
  if (!show_values(rows)) return;
  const int bar = layout.width / 3;
  draw_color_bar(sheet, rows.front().painter->scale(), (layout.width - bar) / 2, layout.bar, bar,
                 layout.small());
}

void check(const std::vector<SheetRow>& rows) {
  if (rows.empty() || rows.front().snapshots->empty())
    throw bad_input("a contact sheet needs snapshots", "give at least one");
  for (const SheetRow& row : rows)
    if (row.snapshots->size() != rows.front().snapshots->size())
      throw bad_input("rows of a contact sheet differ in length", "give the same moments to each");
}

}  // namespace

Canvas contact_sheet(const std::vector<SheetRow>& rows, const SheetOptions& options) {
  check(rows);
  const SheetLayout layout = layout_of(rows, options);
  Canvas sheet(layout.width, layout.height, options.paper.background);
  for (std::size_t i = 0; i < rows.size(); ++i)
    draw_row(sheet, rows[i], layout.rows[i], layout, options);
  write_captions(sheet, *rows.front().snapshots, layout);
  sheet.write(options.title, layout.margin, layout.margin / 2, layout.text);
  draw_foot(sheet, rows, layout, options);
  return sheet;
}

std::vector<SheetRow> surface_above_particles(Painter& painter,
                                              const std::vector<Snapshot>& snapshots) {
  return {{&painter, &snapshots, View::surface, ""}, {&painter, &snapshots, View::particles, ""}};
}

}  // namespace sinew
