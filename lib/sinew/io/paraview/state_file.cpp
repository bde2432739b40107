// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/io/paraview/state_file.h>

#include <map>

#include <sinew/core/text.h>
#include <sinew/io/detail/xml.h>

namespace sinew {
namespace {

constexpr int first_id = 1000;  // ParaView renumbers what it loads
/// Where the process lives that holds an object: client, data server, render server.
constexpr int everywhere = 21;

std::string element(std::size_t index, std::string_view value) {
  return "        <Element" + xml_attribute("index", std::to_string(index)) +
         xml_attribute("value", value) + "/>\n";
}

}  // namespace

StateProxy::StateProxy(int id, std::string_view group, std::string_view type)
    : id_(id),
      head_(xml_attribute("group", group) + xml_attribute("type", type) +
            xml_attribute("id", std::to_string(id)) +
            xml_attribute("servers", std::to_string(everywhere))) {}

void StateProxy::property(std::string_view name, std::size_t count, const std::string& elements) {
  properties_ += "      <Property" + xml_attribute("name", name) +
                 xml_attribute("number_of_elements", std::to_string(count)) + ">\n" + elements +
                 "      </Property>\n";
}

StateProxy& StateProxy::numbers(std::string_view name, const std::vector<double>& values) {
  std::vector<std::string> words;
  words.reserve(values.size());
  for (const double value : values) words.push_back(number_text(value));
  return text(name, words);
}

StateProxy& StateProxy::text(std::string_view name, const std::vector<std::string>& values) {
  std::string elements;
  for (std::size_t k = 0; k < values.size(); ++k) elements += element(k, values[k]);
  property(name, values.size(), elements);
  return *this;
}

StateProxy& StateProxy::refer(std::string_view name, const std::vector<const StateProxy*>& others) {
  std::string elements;
  for (const StateProxy* other : others)
    elements += "        <Proxy" + xml_attribute("value", std::to_string(other->id())) +
                " output_port=\"0\"/>\n";
  property(name, others.size(), elements);
  return *this;
}

StateProxy& StateProxy::array(std::string_view name, bool cells, std::string_view array) {
  return text(name, {"0", "0", "0", cells ? "1" : "0", std::string(array)});
}

StateProxy& StateProxy::raw(std::string_view xml) {
  raw_ += xml;
  return *this;
}

std::string StateProxy::xml() const {
  return "    <Proxy" + head_ + ">\n" + properties_ + raw_ + "    </Proxy>\n";
}

StateProxy& StateFile::add(std::string_view group, std::string_view type,
                           std::string_view collection, std::string_view name) {
  const int id = first_id + static_cast<int>(proxies_.size());
  if (!collection.empty()) items_.push_back({std::string(collection), std::string(name), id});
  return proxies_.emplace_back(id, group, type);
}

void StateFile::link_cameras(const StateProxy& one, const StateProxy& other, CameraLinks how) {
  if (how == CameraLinks::none) return;
  links_ += "      <CameraLink name=\"cameras of both views\">\n";
  if (how == CameraLinks::from_5_13) links_ += "        <Properties exceptionBehavior=\"0\"/>\n";
  for (const auto& [from, to] : {std::pair{&one, &other}, std::pair{&other, &one}})
    for (const auto& [direction, view] : {std::pair{"input", from}, std::pair{"output", to}})
      links_ += "        <Proxy" + xml_attribute("direction", direction) +
                xml_attribute("id", std::to_string(view->id())) + "/>\n";
  links_ += "      </CameraLink>\n";
}

std::string StateFile::text() const {
  std::string out = "  <ServerManagerState" + xml_attribute("version", version_) + ">\n";
  for (const StateProxy& proxy : proxies_) out += proxy.xml();
  std::map<std::string, std::string> collections;
  for (const Item& item : items_)
    collections[item.collection] += "      <Item" + xml_attribute("id", std::to_string(item.id)) +
                                    xml_attribute("name", item.name) + "/>\n";
  for (const auto& [name, items] : collections)
    out += "    <ProxyCollection" + xml_attribute("name", name) + ">\n" + items +
           "    </ProxyCollection>\n";
  if (!links_.empty()) out += "    <Links>\n" + links_ + "    </Links>\n";
  return out + "  </ServerManagerState>\n";
}

}  // namespace sinew
