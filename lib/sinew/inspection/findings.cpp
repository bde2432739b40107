// SPDX-License-Identifier: GPL-3.0-or-later
#include <sinew/inspection/findings.h>

#include <nlohmann/json.hpp>

#include <sinew/core/json.h>

namespace sinew {

using Json = nlohmann::ordered_json;

void Findings::keep(std::string key, const Json& value, std::string unit, ShownIn in) {
  all_.push_back({std::move(key), std::make_shared<const Json>(value), std::move(unit), in});
}

void Findings::add(std::string key, const Json& value, std::string unit) {
  keep(std::move(key), value, std::move(unit), ShownIn::both);
}

void Findings::add_line(std::string key, const Json& value, std::string unit) {
  keep(std::move(key), value, std::move(unit), ShownIn::lines);
}

void Findings::add_value(std::string key, const Json& value) {
  keep(std::move(key), value, "", ShownIn::object);
}

void Findings::add(const Findings& more) {
  all_.insert(all_.end(), more.all_.begin(), more.all_.end());
}

std::string Findings::json() const {
  Json object = Json::object();
  for (const Finding& one : all_)
    if (one.in != ShownIn::lines) object[one.key] = *one.value;
  return json_text(object);
}

}  // namespace sinew
