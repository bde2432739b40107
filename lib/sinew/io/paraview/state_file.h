// SPDX-License-Identifier: GPL-3.0-or-later
// The text of a ParaView state: proxies with the properties that differ from ParaView's defaults.
//
//     StateFile state("5.10.0");
//     auto& reader = state.add("sources", "PVDReader", "sources", "particles");
//     reader.text("FileName", {path});
//     write_file("view.pvsm", state.text());
#pragma once

#include <deque>
#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace sinew {

/// One object of ParaView. Properties keep their order.
class StateProxy {
 public:
  StateProxy(int id, std::string_view group, std::string_view type);

  int id() const { return id_; }

  StateProxy& numbers(std::string_view property, const std::vector<double>& values);
  StateProxy& number(std::string_view property, double value) { return numbers(property, {value}); }
  StateProxy& text(std::string_view property, const std::vector<std::string>& values);
  /// Other objects by reference, inputs included.
  StateProxy& refer(std::string_view property, const std::vector<const StateProxy*>& others);
  /// An array by name, on points or on cells, as filters and representations take it.
  StateProxy& array(std::string_view property, bool cells, std::string_view name);
  /// Elements of its own, as a layout has.
  StateProxy& raw(std::string_view xml);

  std::string xml() const;

 private:
  void property(std::string_view name, std::size_t count, const std::string& elements);

  int id_;
  std::string head_, properties_, raw_;
};

/// How versions of ParaView write that cameras are linked: each warns of what another writes.
enum class CameraLinks { none, until_5_11, from_5_13 };

/// All objects, the collections in which ParaView looks for them by name, and links of cameras.
class StateFile {
 public:
  /// `version` of ParaView whose defaults hold for what is left out: newer ones translate.
  explicit StateFile(std::string_view version) : version_(version) {}

  /// An object of `group` and `type`, listed in `collection` as `name`; "" for none.
  StateProxy& add(std::string_view group, std::string_view type, std::string_view collection = {},
                  std::string_view name = {});
  /// The camera of each follows that of the other.
  void link_cameras(const StateProxy& one, const StateProxy& other, CameraLinks how);

  std::string text() const;

 private:
  struct Item {
    std::string collection, name;
    int id;
  };

  std::string version_;
  std::deque<StateProxy> proxies_;
  std::vector<Item> items_;
  std::string links_;
};

}  // namespace sinew
