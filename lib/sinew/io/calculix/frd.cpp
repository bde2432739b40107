// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/io/calculix/frd.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>

#include <sinew/core/error.h>
#include <sinew/core/file.h>
#include <sinew/core/text.h>
#include <sinew/core/vector.h>

namespace sinew {
namespace {

constexpr std::uint64_t largest_result = std::uint64_t{8} << 30;
constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
// Columns of a record.
constexpr std::size_t key_width = 3, number_width = 10;

/// Bytes that results may take beside those of the text.
constexpr std::size_t spare_bytes = std::size_t{100} << 20;

/// The lines of the text, with their number.
class FrdLines {
 public:
  FrdLines(std::string_view text, std::string file)
      : rest_(text), bytes_(text.size()), file_(std::move(file)) {}

  std::size_t bytes() const { return bytes_; }  ///< size of the text

  std::optional<std::string_view> next() {
    if (rest_.empty()) return std::nullopt;
    const std::size_t end = std::min(rest_.find('\n'), rest_.size());
    std::string_view line = rest_.substr(0, end);
    rest_.remove_prefix(std::min(end + 1, rest_.size()));
    if (line.ends_with('\r')) line.remove_suffix(1);
    ++number_;
    return line;
  }

  [[noreturn]] void refuse(const std::string& what,
                           const std::string& cure = "run ccx to its end") const {
    throw bad_input(Place{file_, number_}, what, cure);
  }

 private:
  std::string_view rest_;
  std::size_t bytes_;
  std::string file_;
  int number_ = 0;
};

std::string_view stripped(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(' ');
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(' ') - begin + 1);
}

std::string_view columns_of(std::string_view line, std::size_t from, std::size_t width) {
  return from < line.size() ? stripped(line.substr(from, width)) : std::string_view{};
}

template <class Number>
Number parsed_as(std::string_view text, const FrdLines& lines) {
  Number value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size())
    lines.refuse(shown(text) + " is no number");
  return value;
}

/// The values of a record, one after the other. They are printed with six digits in at least twelve
/// columns: exponents of three digits make them longer, and no space need lie between two.
class FrdValues {
 public:
  FrdValues(std::string_view line, std::size_t from, const FrdLines& lines)
      : rest_(line.substr(std::min(from, line.size()))), lines_(lines) {}

  double next() {
    rest_.remove_prefix(std::min(rest_.find_first_not_of(' '), rest_.size()));
    const std::size_t size = size_of_first();
    const std::string_view text = rest_.substr(0, size);
    rest_.remove_prefix(size);
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    const bool tiny = error == std::errc::result_out_of_range && text.find('-', 1) != text.npos;
    if (end != text.data() + text.size() || (error != std::errc() && !tiny))
      lines_.refuse(shown(text) + " is no number");
    if (!is_computable(value)) lines_.refuse(shown(text) + " is too large or not finite");
    return tiny ? 0 : value;
  }

  /// Refuses what follows unless it is values, too.
  void end() {
    while (!stripped(rest_).empty()) next();
  }

 private:
  /// Up to a space or the sign of the next value; of the digits before a point, the last one is the
  /// next value's.
  std::size_t size_of_first() const {
    const std::size_t exponent = rest_.find_first_of("Ee ");
    if (exponent >= rest_.size() || rest_[exponent] == ' ') return std::min(exponent, rest_.size());
    const std::size_t digits = std::min(exponent + 2, rest_.size());
    const std::size_t end = std::min(rest_.find_first_not_of("0123456789", digits), rest_.size());
    return end < rest_.size() && rest_[end] == '.' && end > digits ? end - 1 : end;
  }

  std::string_view rest_;
  const FrdLines& lines_;
};

bool is_key(std::string_view line, std::string_view key) { return line.starts_with(key); }

class FrdReader {
 public:
  FrdReader(std::string_view text, const std::string& file) : lines_(text, file) {}

  FrdResult read() {
    while (const auto line = lines_.next()) {
      if (is_key(*line, "    2C"))
        read_nodes(*line);
      else if (is_key(*line, "    3C"))
        read_elements(*line);
      else if (is_key(*line, "  100CL"))
        read_result(*line);
      else if (is_key(*line, " 9999"))
        break;
    }
    if (result_.mesh.elements.empty()) lines_.refuse("holds no elements");
    std::erase_if(result_.steps, [](const FrdStep& step) { return step.displacement.empty(); });
    if (result_.steps.empty())
      lines_.refuse("holds no displacements", "ask ccx for U by *NODE FILE");
    check_known();
    return std::move(result_);
  }

 private:
  /// The line of a block that goes on; nothing at its end.
  std::optional<std::string_view> block_line() {
    const auto line = lines_.next();
    if (!line) lines_.refuse("ends within a block");
    if (is_key(*line, " -3")) return std::nullopt;
    return line;
  }

  void check_format(std::string_view head) {
    if (stripped(head).back() != '1')
      lines_.refuse("is not ASCII in the long format",
                    "let ccx write *NODE FILE and *EL FILE, not *NODE OUTPUT and *ELEMENT OUTPUT");
  }

  void read_nodes(std::string_view head) {
    check_format(head);
    if (!result_.steps.empty()) lines_.refuse("nodes come after results");
    while (const auto line = block_line()) {
      if (!is_key(*line, " -1")) lines_.refuse("is no line of a node");
      const int number = parsed_as<int>(columns_of(*line, key_width, number_width), lines_);
      if (!place_.try_emplace(number, static_cast<std::uint32_t>(result_.mesh.nodes.size())).second)
        lines_.refuse("node " + std::to_string(number) + " is there twice");
      result_.mesh.nodes.push_back(vector_in(*line));
    }
  }

  FrdValues values_in(std::string_view line) const {
    return {line, key_width + number_width, lines_};
  }

  Vec3 vector_in(std::string_view line) const {
    FrdValues values = values_in(line);
    Vec3 vector;
    for (double& part : vector) part = values.next();
    values.end();
    return vector;
  }

  std::uint32_t node(std::string_view text) const {
    const int number = parsed_as<int>(text, lines_);
    const auto found = place_.find(number);
    if (found == place_.end()) lines_.refuse("there is no node " + std::to_string(number));
    return found->second;
  }

  ElementKind kind_of(int type) const {
    constexpr int kinds[] = {1, 4, 3, 6};  // in the order of ElementKind
    const auto* const found = std::find(std::begin(kinds), std::end(kinds), type);
    if (found == std::end(kinds))
      lines_.refuse("elements of type " + std::to_string(type) + " are not read",
                    "give hexahedra of 8 or 20 nodes, or tetrahedra of 4 or 10");
    return static_cast<ElementKind>(found - std::begin(kinds));
  }

  void read_elements(std::string_view head) {
    check_format(head);
    while (const auto line = block_line()) {
      if (!is_key(*line, " -1")) lines_.refuse("is no line of an element");
      VolumeElement element;
      element.kind =
          kind_of(parsed_as<int>(columns_of(*line, key_width + number_width, 5), lines_));
      read_corners(element);
      result_.mesh.elements.push_back(element);
    }
  }

  void read_corners(VolumeElement& element) {
    const auto count = static_cast<std::size_t>(nodes_of(element.kind));
    std::vector<std::uint32_t> found;
    while (found.size() < count) {
      const auto line = block_line();
      if (!line || !is_key(*line, " -2")) lines_.refuse("an element lacks nodes");
      for (std::size_t k = 0; k < 10 && found.size() < count; ++k) {
        const auto text = columns_of(*line, key_width + k * number_width, number_width);
        if (text.empty()) break;
        found.push_back(node(text));
      }
    }
    // The upright edges come before those of the upper face.
    if (element.kind == ElementKind::hexahedron20)
      std::rotate(found.begin() + 12, found.begin() + 16, found.end());
    std::copy(found.begin(), found.end(), element.nodes.begin());
    std::sort(found.begin(), found.end());
    if (std::adjacent_find(found.begin(), found.end()) != found.end())
      lines_.refuse("an element has the same node twice",
                    "give a mesh without degenerate elements");
  }

  void read_result(std::string_view head) {
    check_format(head);
    const double time = FrdValues(head, 12, lines_).next();
    const auto name = lines_.next();
    if (!name || !is_key(*name, " -4")) lines_.refuse("a result lacks its name");
    const std::string_view kind = columns_of(*name, 5, 8);
    if (kind == "DISP")
      read_vectors(step_at(time).displacement);
    else if (kind == "FORC")
      read_vectors(step_at(time).force);
    else if (kind == "STRESS")
      read_stresses(step_at(time));
  }

  FrdStep& step_at(double time) {
    const auto found = std::find_if(result_.steps.begin(), result_.steps.end(),
                                    [&](const FrdStep& step) { return step.time == time; });
    if (found != result_.steps.end()) return *found;
    if (!result_.steps.empty() && result_.steps.back().time > time)
      lines_.refuse("time runs backward", "give the result of one job of ccx");
    return result_.steps.emplace_back(FrdStep{time, {}, {}, {}});
  }

  /// Calls take(node, line) for each line of the block's values.
  template <class Take>
  void read_values(const Take& take) {
    while (const auto line = block_line()) {
      if (is_key(*line, " -5")) continue;
      if (!is_key(*line, " -1")) lines_.refuse("is no line of a result");
      take(node(columns_of(*line, key_width, number_width)), *line);
    }
  }

  /// Results of few nodes each take more memory than their text.
  template <class Value>
  void make_room(std::vector<Value>& values, const Value& none) {
    taken_ += result_.mesh.nodes.size() * sizeof(Value);
    if (taken_ > 12 * lines_.bytes() + spare_bytes)
      lines_.refuse("holds many results of few nodes", "write the results of all nodes");
    values.assign(result_.mesh.nodes.size(), none);
  }

  void read_vectors(Points& values) {
    make_room(values, Vec3(Vec3::Constant(unknown)));
    read_values([&](std::uint32_t node, std::string_view line) { values[node] = vector_in(line); });
  }

  void read_stresses(FrdStep& step) {
    StressComponents none;
    none.fill(unknown);
    make_room(step.stress, none);
    read_values([&](std::uint32_t node, std::string_view line) {
      FrdValues values = values_in(line);
      for (double& part : step.stress[node]) part = values.next();
      values.end();
    });
  }

  /// Every node of an element has a place and a displacement.
  void check_known() const {
    for (const Vec3& node : result_.mesh.nodes)
      if (!node.allFinite()) lines_.refuse("a node has no place");
    for (const FrdStep& step : result_.steps)
      for (const VolumeElement& element : result_.mesh.elements)
        for (const std::uint32_t node : element.used())
          if (!step.displacement[node].allFinite())
            lines_.refuse("lacks displacements of some nodes at " + number_text(step.time) + " s");
  }

  FrdLines lines_;
  FrdResult result_;
  std::unordered_map<int, std::uint32_t> place_;  ///< place of nodes by their number
  std::size_t taken_ = 0;                         ///< bytes of results
};

}  // namespace

FrdResult read_frd(const std::filesystem::path& path) {
  const std::string text = read_file(path, largest_result);
  return FrdReader(text, path.string()).read();
}

}  // namespace sinew
