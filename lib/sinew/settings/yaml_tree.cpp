// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/settings/yaml_tree.h>

#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/mark.h>
#include <yaml-cpp/parser.h>
#include <algorithm>
#include <map>
#include <sstream>
#include <unordered_map>
#include <utility>

#include <sinew/core/text.h>
#include <sinew/settings/text_file.h>

namespace sinew {
namespace {

/// A copy of a long text counts as several.
std::size_t node_count(const YamlNode& node) {
  std::size_t count = 1 + node.text.size() / sizeof(YamlNode);
  for (const YamlNode& item : node.items) count += node_count(item);
  return count;
}

/// Builds the tree from the parser's events.
class Builder : public YAML::EventHandler {
 public:
  Builder(std::string_view text, const std::string& file)
      : text_(text),
        file_(std::make_shared<const std::string>(file)),
        max_nodes_(max_nodes(text.size())) {}

  YamlNode root;
  Place last_quote;  ///< place of the last scalar that was not a plain word

  void OnDocumentStart(const YAML::Mark& mark) override {
    if (std::exchange(begun_, true))
      throw bad_input(at(mark), "a second document begins here",
                      "keep one scene per file, and check the indentation");
  }
  void OnDocumentEnd() override {}

  void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    YamlNode node;
    node.place = at(mark);
    add(std::move(node), anchor);
  }

  void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                const std::string& text) override {
    refuse_tag(mark, tag);
    YamlNode node;
    node.kind = YamlNode::Kind::scalar;
    node.place = at(mark);
    node.text = text;
    node.quoted = tag == "!";
    if (node.quoted) last_quote = node.place;
    add(std::move(node), anchor);
  }

  void OnAlias(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    const auto found = anchored_.find(anchor);
    if (found == anchored_.end())
      throw bad_input(at(mark), "an alias inside its own value", "write the value out");
    count_nodes(node_count(found->second), at(mark));
    attach(found->second);
  }

  void OnSequenceStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                       YAML::EmitterStyle::value) override {
    open(YamlNode::Kind::list, mark, tag, anchor);
  }
  void OnSequenceEnd() override { close(); }

  void OnMapStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                  YAML::EmitterStyle::value) override {
    open(YamlNode::Kind::map, mark, tag, anchor);
  }
  void OnMapEnd() override { close(); }

 private:
  struct Open {
    YamlNode node;
    YAML::anchor_t anchor;
    std::unordered_map<std::string, int> lines;  ///< lines of the keys so far
  };

  YamlPlace at(const YAML::Mark& mark) { return {file_, mark.line + 1, column_of(mark)}; }

  /// Counts characters, as editors do; the parser counts bytes. Marks ascend within a line, nearly.
  int column_of(const YAML::Mark& mark) {
    const auto end = std::min<std::size_t>(static_cast<std::size_t>(mark.pos), text_.size());
    if (mark.line != line_ || counted_ > end) {
      line_ = mark.line;
      counted_ = end - std::min<std::size_t>(end, static_cast<std::size_t>(mark.column));
      letters_ = 0;
    }
    for (; counted_ < end; ++counted_)
      letters_ += (static_cast<unsigned char>(text_[counted_]) & 0xC0) != 0x80;
    return letters_ + 1;
  }

  void refuse_tag(const YAML::Mark& mark, const std::string& tag) {
    if (!tag.empty() && tag != "?" && tag != "!")
      throw bad_input(at(mark), "the tag " + shown(tag), "remove it: scenes have no tags");
  }

  void count_nodes(std::size_t more, const YamlPlace& place) {
    count_ += more;
    if (count_ > max_nodes_)
      throw bad_input(place, "more than " + std::to_string(max_nodes_) + " values in one scene",
                      "shorten it");
  }

  void open(YamlNode::Kind kind, const YAML::Mark& mark, const std::string& tag,
            YAML::anchor_t anchor) {
    refuse_tag(mark, tag);
    if (open_.size() == deepest_node)
      throw bad_input(at(mark), "lists and mappings nested more than 32 deep",
                      "check brackets and indentation");
    YamlNode node;
    node.kind = kind;
    node.place = at(mark);
    open_.push_back({std::move(node), anchor, {}});
  }

  void close() {
    Open done = std::move(open_.back());
    open_.pop_back();
    done.node.items.shrink_to_fit(), done.node.keys.shrink_to_fit();
    add(std::move(done.node), done.anchor);
  }

  /// A complete value in the text itself, not an alias.
  void add(YamlNode node, YAML::anchor_t anchor) {
    count_nodes(1, node.place);
    if (anchor != 0) anchored_[anchor] = node;
    attach(std::move(node));
  }

  void attach(YamlNode node) {
    if (open_.empty()) {
      root = std::move(node);
    } else if (Open& parent = open_.back(); parent.node.kind == YamlNode::Kind::map &&
                                            parent.node.keys.size() == parent.node.items.size()) {
      add_key(parent, node);
    } else {
      if (parent.node.kind == YamlNode::Kind::map && node.kind == YamlNode::Kind::empty)
        node.place =
            parent.node.keys.back().place;  // the parser reports the place of the next token
      if (parent.node.kind == YamlNode::Kind::list && node.kind == YamlNode::Kind::empty)
        node.place = parent.node.items.empty() ? parent.node.place : parent.node.items.back().place;
      parent.node.items.push_back(std::move(node));
    }
  }

  void add_key(Open& parent, const YamlNode& key) {
    if (key.kind != YamlNode::Kind::scalar)
      throw bad_input(key.place, "a key that is no word", "write 'key: value'");
    const auto [first, is_new] = parent.lines.emplace(key.text, key.place.line);
    if (!is_new)
      throw bad_input(
          key.place, "the key " + shown(key.text) + " is given twice",
          "remove one of them (the first is on line " + std::to_string(first->second) + ")");
    parent.node.keys.push_back({key.text, key.place});
  }

  std::string_view text_;
  int line_ = -1, letters_ = 0;  ///< letters before counted_ in this line
  std::size_t counted_ = 0;
  std::shared_ptr<const std::string> file_;
  std::size_t max_nodes_;
  bool begun_ = false;
  std::size_t count_ = 0;
  std::vector<Open> open_;
  std::map<YAML::anchor_t, YamlNode> anchored_;  ///< complete values with an anchor
};

/// yaml-cpp keeps everything in brackets in memory before it reports anything.
void check_brackets(std::string_view text, const std::string& file) {
  const auto parts = std::count_if(text.begin(), text.end(),
                                   [](char c) { return c == '[' || c == '{' || c == ','; });
  const std::size_t max_parts = 2 * max_nodes(text.size());
  if (static_cast<std::size_t>(parts) > max_parts)
    throw bad_input({file}, "more than " + std::to_string(max_parts) + " brackets and commas",
                    "shorten the scene");
}

/// yaml-cpp lets quotes run to the end of the file; then they have no closing mark.
void check_closing_quote(std::string_view text, const Place& place) {
  std::size_t i = offset_of(text, place);
  while (i < text.size() && (text[i] == '&' || text[i] == '!'))  // an anchor precedes the value
    i = text.find_first_not_of(" \t\r\n", std::min(text.find_first_of(" \t\r\n", i), text.size()));
  if (i >= text.size() || (text[i] != '"' && text[i] != '\'')) return;  // a block of text
  const char quote = text[i];
  for (++i; i < text.size(); ++i) {
    const bool escaped = quote == '"' && text[i] == '\\';
    const bool doubled = text[i] == quote && quote == '\'' && text.substr(i + 1, 1) == "'";
    if (escaped || doubled)
      ++i;
    else if (text[i] == quote)
      return;
  }
  throw bad_input(place, "quotes that are never closed", "close them on the same line");
}

}  // namespace

const YamlNode* YamlNode::find(std::string_view key) const {
  for (std::size_t i = 0; i < keys.size(); ++i)
    if (keys[i].name == key) return &items[i];
  return nullptr;
}

YamlNode parse_yaml(std::string_view text, const std::string& file) {
  if (text.substr(0, 3) == "\xEF\xBB\xBF") text.remove_prefix(3);  // a byte order mark
  check_text(text, file);
  check_brackets(text, file);
  std::istringstream in{std::string(text)};
  Builder builder(text, file);
  try {
    YAML::Parser parser(in);
    while (parser.HandleNextDocument(builder)) continue;
  } catch (const YAML::Exception& error) {
    const bool known = !error.mark.is_null();
    throw bad_input({file, known ? error.mark.line + 1 : 0, known ? error.mark.column + 1 : 0},
                    "this is not YAML (" + error.msg + ")",
                    "check quotes, brackets, indentation and the space after each colon");
  }
  if (builder.last_quote.line > 0) check_closing_quote(text, builder.last_quote);
  return std::move(builder.root);
}

}  // namespace sinew
