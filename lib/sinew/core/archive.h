// SPDX-License-Identifier: GPL-3.0-or-later
// Values of any type as bytes, in this machine's byte order: for checkpoints, and for programs that
// work together in one run. A struct needs one function, for both directions:
// serialize(archive, value) calls archive for each of its members.
//
//     const std::string bytes = archived(setup);
//     const auto setup = unarchived<EngineSetup>(bytes);
#pragma once

#include <cstdint>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include <sinew/core/error.h>
#include <sinew/core/vector.h>

namespace sinew {

/// What is copied as it lies in memory.
template <class Value>
concept Plain = std::is_arithmetic_v<Value> || std::is_enum_v<Value> ||
    std::is_same_v<Value, Vec3> || std::is_same_v<Value, Mat3> || std::is_same_v<Value, Quat>;

/// Hands bytes to sink(const void*, std::size_t).
template <class Sink>
class ArchiveWriter {
 public:
  explicit ArchiveWriter(Sink sink) : sink_(std::move(sink)) {}

  template <class Value>
  void operator()(const Value& value) {
    if constexpr (Plain<Value>)
      sink_(&value, sizeof value);
    else if constexpr (requires { value.has_value(); })
      put_optional(value);
    else if constexpr (requires { value.size(), value.data(); })
      put_list(value);
    else
      serialize(*this, const_cast<Value&>(value));
  }
  /// A member whose name other archives write.
  template <class Value>
  void operator()(std::string_view, const Value& value) {
    (*this)(value);
  }

 private:
  template <class Value>
  void put_optional(const std::optional<Value>& value) {
    (*this)(value.has_value());
    if (value) (*this)(*value);
  }
  template <class List>
  void put_list(const List& list) {
    (*this)(std::uint64_t{list.size()});
    if constexpr (Plain<typename List::value_type>)
      sink_(list.data(), list.size() * sizeof *list.data());
    else
      for (const auto& one : list) (*this)(one);
  }

  Sink sink_;
};

class ArchiveReader {
 public:
  explicit ArchiveReader(std::string_view bytes, const char* cure = "start the run again")
      : bytes_(bytes), cure_(cure) {}

  template <class Value>
  void operator()(Value& value) {
    if constexpr (Plain<Value>)
      take(&value, sizeof value);
    else if constexpr (requires { value.has_value(); })
      get_optional(value);
    else if constexpr (requires { value.size(), value.data(); })
      get_list(value);
    else
      serialize(*this, value);
  }
  template <class Value>
  void operator()(std::string_view, Value& value) {
    (*this)(value);
  }
  bool done() const { return bytes_.empty(); }
  Error torn() const { return bad_input("it is truncated or damaged", cure_); }

 private:
  void take(void* to, std::size_t count) {
    if (count > bytes_.size()) throw torn();
    if (count > 0) std::memcpy(to, bytes_.data(), count);
    bytes_.remove_prefix(count);
  }
  template <class Value>
  void get_optional(std::optional<Value>& value) {
    bool there = false;
    (*this)(there);
    if (there) (*this)(value.emplace());
  }
  template <class List>
  void get_list(List& list) {
    std::uint64_t count = 0;
    (*this)(count);
    if (count > bytes_.size()) throw torn();  // no element is shorter than a byte
    list.clear();
    if constexpr (Plain<typename List::value_type>) {
      if (count > bytes_.size() / sizeof(typename List::value_type)) throw torn();
      list.resize(count);
      take(list.data(), count * sizeof(typename List::value_type));
    } else {
      for (std::uint64_t i = 0; i < count; ++i) (*this)(list.emplace_back());
    }
  }

  std::string_view bytes_;
  const char* cure_;
};

/// Makes it the alternative of that number.
template <std::size_t k = 0, class... Forms>
void choose(std::variant<Forms...>& value, std::size_t form) {
  if constexpr (k == sizeof...(Forms))
    throw bad_input("it is truncated or damaged", "start the run again");
  else if (k == form)
    value.template emplace<k>();
  else
    choose<k + 1>(value, form);
}

template <class Archive, class... Forms>
void serialize(Archive& archive, std::variant<Forms...>& value) {
  auto form = static_cast<std::uint8_t>(value.index());
  archive(form);
  if (form != value.index()) choose(value, form);
  std::visit([&](auto& one) { archive(one); }, value);
}

template <class Value>
std::string archived(const Value& value) {
  std::string bytes;
  ArchiveWriter writer([&bytes](const void* from, std::size_t count) {
    bytes.append(static_cast<const char*>(from), count);
  });
  writer(value);
  return bytes;
}

/// Throws bad input where the bytes are no such value.
template <class Value>
Value unarchived(std::string_view bytes) {
  ArchiveReader reader(bytes);
  Value value;
  reader(value);
  if (!reader.done()) throw bad_input("it is longer than it should be", "start the run again");
  return value;
}

}  // namespace sinew
