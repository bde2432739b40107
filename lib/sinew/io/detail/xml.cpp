// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/io/detail/xml.h>

#include <expat.h>

#include <algorithm>
#include <exception>
#include <iterator>
#include <memory>
#include <new>
#include <type_traits>
#include <utility>

#include <sinew/core/error.h>

namespace sinew {
namespace {

constexpr std::size_t few_elements = 200'000;  // number allowed at any size
constexpr std::size_t bytes_per_element = 32;  // in the mean beyond; rows of a PVD have eighty
constexpr std::size_t longest_path = 1000;     // characters; bounds the depth, too
constexpr std::size_t longest_tag = 1 << 20;   // bytes

Error no_xml(const std::string& what) { return bad_input(what, "write the file again"); }

/// Length of the tag at the beginning of `xml`, including its '>'; those in quotes are skipped.
std::size_t length_of_tag(std::string_view xml) {
  constexpr std::string_view comment = "<!--", comment_end = "-->";
  if (xml.starts_with(comment)) {
    const auto end = xml.find(comment_end, comment.size());
    return end == xml.npos ? xml.size() : end + comment_end.size();
  }
  if (xml.starts_with("<!")) throw no_xml("it declares types or entities of its own");
  char quote = 0;
  for (std::size_t at = 0; at < std::min(xml.size(), longest_tag); ++at) {
    const char c = xml[at];
    if (quote != 0)
      quote = c == quote ? '\0' : quote;
    else if (c == '"' || c == '\'')
      quote = c;
    else if (c == '>')
      return at + 1;
  }
  return xml.size();
}

class Elements {
 public:
  Elements(std::string_view xml, std::string_view last)
      : left_(xml), last_(last), max_elements_(few_elements + xml.size() / bytes_per_element) {
    if (!parser_) throw std::bad_alloc();
    XML_SetUserData(parser_.get(), this);
    XML_SetElementHandler(parser_.get(), &Elements::begun, &Elements::ended);
  }

  std::vector<XmlElement> read() {
    while (!left_.empty() && !at_last_) read_tag();
    if (!at_last_) parse({}, true);
    return std::move(elements_);
  }

 private:
  using Parser = std::unique_ptr<std::remove_pointer_t<XML_Parser>, decltype(&XML_ParserFree)>;

  /// Passes expat whole tags, each with the text before it unless that is an element's own.
  void read_tag() {
    std::size_t tag = std::min(left_.find('<'), left_.size());
    if (open_) {
      elements_.back().text = left_.substr(0, tag);
      left_.remove_prefix(tag);
      tag = 0;
    }
    open_ = false;
    const std::size_t end = tag + length_of_tag(left_.substr(tag));
    parse(left_.substr(0, end), false);
    left_.remove_prefix(end);
    if (at_last_) elements_.back().text = left_;
  }

  void parse(std::string_view part, bool final) {
    if (part.size() > longest_tag) throw no_xml("its tags are too long");
    const auto status =
        XML_Parse(parser_.get(), part.data(), static_cast<int>(part.size()), final ? 1 : 0);
    if (thrown_) std::rethrow_exception(thrown_);
    if (status != XML_STATUS_OK)
      throw no_xml(std::string("it is not XML (") +
                   XML_ErrorString(XML_GetErrorCode(parser_.get())) + ')');
  }

  void begin(const char* name, const char** attributes) {
    if (elements_.size() == max_elements_)
      throw bad_input(
          "it has more than " + std::to_string(max_elements_) + " elements, few bytes each",
          "use a file of fewer");
    if (!path_.empty()) path_ += '/';
    path_ += name;
    if (path_.size() > longest_path) throw no_xml("its elements are too deep");
    elements_.push_back({path_, {}, {}});
    for (; *attributes; attributes += 2)
      elements_.back().attributes.emplace(attributes[0], attributes[1]);
    open_ = true;
    at_last_ = path_ == last_;
  }

  /// Exceptions must not pass through expat, which is C.
  static void begun(void* self, const char* name, const char** attributes) {
    auto& elements = *static_cast<Elements*>(self);
    try {
      elements.begin(name, attributes);
    } catch (...) {
      elements.thrown_ = std::current_exception();
      XML_StopParser(elements.parser_.get(), XML_FALSE);
    }
  }

  static void ended(void* self, const char*) {
    auto& elements = *static_cast<Elements*>(self);
    const auto parent = elements.path_.rfind('/');
    elements.path_.resize(parent == std::string::npos ? 0 : parent);
    elements.open_ = elements.at_last_ = false;
  }

  Parser parser_{XML_ParserCreate("UTF-8"), &XML_ParserFree};
  std::string_view left_, last_;
  std::size_t max_elements_;
  std::string path_;
  std::vector<XmlElement> elements_;
  bool open_ = false;     ///< the last tag read begins the last element read
  bool at_last_ = false;  ///< whether that element is the one to stop at
  std::exception_ptr thrown_;
};

}  // namespace

std::string_view XmlElement::attribute(std::string_view name) const {
  const auto found = attributes.find(name);
  return found == attributes.end() ? std::string_view() : found->second;
}

std::vector<XmlElement> xml_elements(std::string_view xml, std::string_view last) {
  return Elements(xml, last).read();
}

std::string xml_attribute(std::string_view name, std::string_view value) {
  static constexpr std::pair<char, std::string_view> replaced[] = {
      {'&', "&amp;"},  {'<', "&lt;"},  {'>', "&gt;"},  {'"', "&quot;"},
      {'\n', "&#10;"}, {'\t', "&#9;"}, {'\r', "&#13;"}};
  std::string text = ' ' + std::string(name) + "=\"";
  for (const char c : value) {
    const auto* found = std::find_if(std::begin(replaced), std::end(replaced),
                                     [&](const auto& entry) { return entry.first == c; });
    if (found == std::end(replaced))
      text += c;
    else
      text += found->second;
  }
  return text += '"';
}

}  // namespace sinew
