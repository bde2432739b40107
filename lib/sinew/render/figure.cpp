// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/render/figure.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <string>

#include <sinew/core/error.h>
#include <sinew/core/file.h>
#include <sinew/core/text.h>
#include <sinew/render/detail/keys.h>
#include <sinew/render/detail/text.h>

namespace sinew {

namespace {

struct Layout {
  TextStyle words;
  int margin = 0;
  int top = 0;               ///< top of the panels
  int wide = 0, high = 0;    ///< each panel
  int foot = 0;              ///< top of the caption
  int bar = 0, bar_top = 0;  ///< width and top of the color bar; 0: none
  std::string caption;       ///< in lines
};

int lines_in(const std::string& text) {
  return text.empty() ? 0 : static_cast<int>(1 + std::count(text.begin(), text.end(), '\n'));
}

/// The foot: a caption beside a color bar, or above it where they have no room beside each other.
void lay_foot(Layout& layout, const std::vector<Panel>& panels, const FigureOptions& options) {
  const std::string& caption = panels.front().snapshot->caption;
  const ColorScale& scale = panels.front().painter->scale();
  const bool has_bar = std::any_of(panels.begin(), panels.end(), [](const Panel& panel) {
    return shows_values(panel.view, *panel.snapshot);
  });
  const int widest = options.width - 4 * layout.margin, below = color_bar_height(layout.words);
  const int wish = std::min(options.width / 3, 3 * options.height / 5);
  while (has_bar && color_bar_width(scale, layout.words) > widest && layout.words.size > 6)
    --layout.words.size;
  if (has_bar) layout.bar = std::min(widest, std::max(wish, color_bar_width(scale, layout.words)));
  const int room = options.width - 5 * layout.margin - layout.bar;
  layout.caption = wrapped(caption, std::max(room, 1), layout.words);
  const bool fits = room > options.width / 5 && text_width(layout.caption, layout.words) <= room &&
                    lines_in(layout.caption) * line_height(layout.words) <= below;
  if (!fits) layout.caption = wrapped(caption, widest, layout.words);
  const int lines = fits ? 0 : lines_in(layout.caption);
  layout.bar_top = options.height - below - layout.margin;
  layout.foot = layout.bar_top - lines * line_height(layout.words);
}

Layout layout_of(const std::vector<Panel>& panels, const FigureOptions& options) {
  Layout layout;
  const int count = static_cast<int>(panels.size());
  layout.words.size = std::max(11, options.height / 32);
  layout.words.color = options.paper.ink;
  layout.margin = options.height / 30;
  const bool titled = std::any_of(panels.begin(), panels.end(),
                                  [](const Panel& panel) { return !panel.title.empty(); });
  layout.top = layout.margin + (titled ? line_height(layout.words) : 0);
  lay_foot(layout, panels, options);
  layout.wide = (options.width - (count + 1) * layout.margin) / count;
  layout.high = std::max(16, layout.foot - layout.margin - layout.top);
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
  const ColorScale& scale = panels.front().painter->scale();
  page.write(layout.caption, 2 * layout.margin, layout.foot, layout.words);
  if (layout.bar > 0)
    draw_color_bar(page, scale, options.width - 2 * layout.margin - layout.bar, layout.bar_top,
                   layout.bar, layout.words);
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
  int width = 0, height = 0, margin = 0, row_height = 0, captions = 0;
  int bar = 0, keys = 0;  ///< tops of the color bar and of what is beside or below it
  double scale = 0;       ///< pixels per meter
  TextStyle text;

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

/// What a color stands for.
struct KeyEntry {
  Color color;
  std::string words;
};
using Key = std::vector<KeyEntry>;

bool has_bones(const std::vector<SheetRow>& rows) {
  return std::any_of(rows.begin(), rows.end(), [](const SheetRow& row) {
    return !row.snapshots->front().bones.empty() && shows_axes(row.view);
  });
}

/// Whether a row has dots on held particles.
bool shows_held(const SheetRow& row) {
  const std::vector<Mark>& marks = row.snapshots->front().marks;
  return shows_particles_or_skin(row.view) &&
         std::find(marks.begin(), marks.end(), Mark::held) != marks.end();
}

/// The bones' axes, and forces of supports and loads, as far as the rows show them.
std::vector<Key> keys_of(const std::vector<SheetRow>& rows, const SheetOptions& options) {
  std::vector<Key> keys;
  if (!options.rulers) return keys;
  bool loads = false, supports = false;
  for (const Snapshot& snapshot : *rows.front().snapshots)
    for (const SnapshotForce& force : snapshot.forces) (force.is_load ? loads : supports) = true;
  const auto ink = [&](const Color& color) { return readable_on(options.paper.background, color); };
  Key forces;
  if (std::any_of(rows.begin(), rows.end(), shows_held))
    forces.push_back({ink(palette::held), "held particle"});
  if (supports) forces.push_back({ink(palette::held), "force of a support"});
  if (loads) forces.push_back({ink(palette::loaded), "load"});
  if (supports || loads)
    forces.push_back(
        {options.paper.background, "longest: " + quantity_text(options.strongest_force, "N")});
  if (!forces.empty()) keys.push_back(forces);
  if (has_bones(rows))
    keys.push_back({{palette::axes[0], "along the bone"},
                    {palette::axes[1], "its side y"},
                    {palette::axes[2], "its side z"}});
  return keys;
}

int width_of(const Key& key, const TextStyle& words) {
  int widest = 0;
  for (const KeyEntry& entry : key) widest = std::max(widest, text_width(entry.words, words));
  return widest + 2 * words.size;
}

/// What stands below the captions, from left to right.
struct Foot {
  int tripod = 0, ruler = 0, bar = 0, keys = 0;  ///< widths, pixels
  int width(int margin) const {
    int parts = 0, sum = 0;
    for (const int part : {tripod, ruler, bar, keys}) parts += part > 0, sum += part;
    return sum + (parts + 1) * margin;
  }
};

Foot foot_of(const SheetLayout& layout, const std::vector<SheetRow>& rows,
             const SheetOptions& options) {
  const TextStyle words = layout.small();
  Foot foot;
  if (options.axes) foot.tripod = color_bar_height(layout.text);
  if (options.rulers) foot.ruler = std::max(layout.width / 6, 5 * words.size);
  if (show_values(rows))
    foot.bar = std::max(layout.width / 3, color_bar_width(rows.front().painter->scale(), words));
  for (const Key& key : keys_of(rows, options)) foot.keys += width_of(key, words) + words.size;
  return foot;
}

/// Moves the columns apart until the title and what is below them have room.
void widen(SheetLayout& layout, const std::vector<SheetRow>& rows, const SheetOptions& options) {
  const int foot = foot_of(layout, rows, options).width(layout.margin);
  const int title = text_width(options.title, layout.text) + 2 * layout.margin;
  const int least = std::min(options.width, std::max(title, foot));
  const int missing = least - layout.width;
  if (missing <= 0) return;
  const int gaps = static_cast<int>(layout.columns.size()) + 1;
  for (int k = 0; k < gaps - 1; ++k)
    layout.columns[static_cast<std::size_t>(k)].x += missing * (k + 1) / gaps;
  layout.width = least;
}

/// Captions that leave a letter's width between neighbors.
std::vector<std::string> captions_of(const std::vector<Snapshot>& snapshots,
                                     const SheetLayout& layout) {
  const std::vector<Column>& columns = layout.columns;
  std::vector<std::string> captions;
  for (std::size_t i = 0; i < snapshots.size(); ++i) {
    const auto middle = [&](std::size_t k) { return columns[k].x + columns[k].width / 2; };
    int room = 2 * std::min(middle(i), layout.width - middle(i));
    if (i > 0) room = std::min(room, middle(i) - middle(i - 1));
    if (i + 1 < columns.size()) room = std::min(room, middle(i + 1) - middle(i));
    captions.push_back(wrapped(snapshots[i].caption, room - layout.text.size, layout.text));
  }
  return captions;
}

SheetLayout layout_of(const std::vector<SheetRow>& rows, const SheetOptions& options) {
  SheetLayout layout;
  layout.columns = columns_of(rows, options.view);
  layout.margin = std::max(12, options.width / 32);
  layout.text.size = std::max(11, options.width / 64);
  layout.text.color = options.paper.ink;
  lay_columns(layout, options);
  widen(layout, rows, options);
  int y = 0;
  if (!options.title.empty())
    y = layout.margin / 2 + lines_in(options.title) * line_height(layout.text);
  for (const SheetRow& row : rows) {
    y += layout.margin + (row.title.empty() ? 0 : line_height(layout.text));
    layout.rows.push_back(y);
    y += layout.row_height;
  }
  layout.captions = y + layout.margin / 2;
  int lines = 0;
  for (const std::string& caption : captions_of(*rows.front().snapshots, layout))
    lines = std::max(lines, lines_in(caption));
  layout.bar = layout.captions + lines * line_height(layout.text) + layout.margin / 2;
  const bool has_foot = options.axes || options.rulers || show_values(rows);
  const int foot = has_foot ? color_bar_height(layout.text) + layout.margin / 2 : 0;
  layout.keys = layout.bar;
  if (foot_of(layout, rows, options).width(layout.margin) > layout.width) layout.keys += foot;
  layout.height = layout.keys + foot;
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
  const std::vector<std::string> captions = captions_of(snapshots, layout);
  for (std::size_t i = 0; i < snapshots.size(); ++i)
    sheet.write(captions[i], layout.columns[i].x + layout.columns[i].width / 2, layout.captions,
                words);
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
  const int thick = std::max(2, layout.text.size / 8),
            y = layout.keys + line_height(layout.small());
  sheet.fill(x, y, pixels, thick, ink);
  for (const int end : {x, x + pixels - thick})
    sheet.fill(end, y - 2 * thick, thick, 5 * thick, ink);
  TextStyle words = layout.small();
  words.align = Align::center;
  sheet.write(length_text(length), x + pixels / 2, y + 4 * thick, words);
}

/// The entries below each other.
void draw_key(Canvas& sheet, const SheetLayout& layout, int x, const Key& key) {
  const TextStyle words = layout.small();
  const int line = line_height(words), side = std::max(4, words.size / 2);
  int y = layout.keys;
  for (const KeyEntry& entry : key) {
    sheet.fill(x, y + line / 2 - side / 2, side, side, entry.color);
    sheet.write(entry.words, x + 2 * side, y, words);
    y += line;
  }
}

void draw_foot(Canvas& sheet, const std::vector<SheetRow>& rows, const SheetLayout& layout,
               const SheetOptions& options) {
  const TextStyle words = layout.small();
  const Foot foot = foot_of(layout, rows, options);
  if (options.axes)
    draw_tripod(sheet, options.view, layout.margin / 2, layout.height, foot.tripod * 10 / 28);
  const int left = layout.margin / 2 + foot.tripod;
  if (options.rulers) draw_scale_bar(sheet, layout, left, options.paper.ink);
  int right = layout.width - layout.margin / 2;
  for (const Key& key : keys_of(rows, options)) {
    right -= width_of(key, words);
    draw_key(sheet, layout, right, key);
    right -= words.size;
  }
  if (!show_values(rows)) return;
  const int bar = std::min(foot.bar, layout.width - layout.margin);
  int x = (layout.width - bar) / 2;
  if (layout.keys == layout.bar) {  // in the middle, if there is room for it
    const int first = left + foot.ruler + layout.margin / 2;
    x = std::clamp(x, first, std::max(first, right - layout.margin / 2 - bar));
  }
  draw_color_bar(sheet, rows.front().painter->scale(), x, layout.bar, bar, words);
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
