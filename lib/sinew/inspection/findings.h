// SPDX-License-Identifier: GPL-3.0-or-later
// What inspecting a file or a scene finds: named values in order, for people and for scripts.
//
//     Findings findings;
//     findings.add("radius", 0.01, "m");
//     const std::string object = findings.json();
#pragma once

#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <vector>

namespace sinew {

/// Where a value is shown: a line may say in words what the object lists.
enum class ShownIn { both, lines, object };

struct Finding {
  std::string key;
  std::shared_ptr<const nlohmann::ordered_json> value;
  std::string unit;  ///< for lines only
  ShownIn in;
};

class Findings {
 public:
  /// A text, a number, a flag or a list.
  void add(std::string key, const nlohmann::ordered_json& value, std::string unit = "");
  /// For lines only, where a key may occur twice, and for the object only.
  void add_line(std::string key, const nlohmann::ordered_json& value, std::string unit = "");
  void add_value(std::string key, const nlohmann::ordered_json& value);
  void add(const Findings& more);

  std::span<const Finding> all() const { return all_; }
  /// One object; numbers that are not finite become null.
  std::string json() const;

 private:
  void keep(std::string key, const nlohmann::ordered_json& value, std::string unit, ShownIn in);

  std::vector<Finding> all_;
};

}  // namespace sinew
