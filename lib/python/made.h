// SPDX-License-Identifier: GPL-3.0-or-later
// Objects that Python has really made. Those made by __new__ alone get memory from pybind11 that
// nobody has filled.
//
//     template <>
//     class pybind11::detail::type_caster<Thing> : public pybind11::detail::made_caster<Thing> {};
#pragma once

#include <pybind11/pybind11.h>

#include <sinew/core/deformation.h>
#include <sinew/sinew.h>

namespace pybind11::detail {

/// Takes no other: the caller gets a TypeError.
template <class Thing>
class made_caster : public type_caster_base<Thing> {
 public:
  bool load(handle given, bool convert) {
    return is_made(given) && type_caster_base<Thing>::load(given, convert);
  }

 private:
  static bool is_made(handle given) {
    if (!isinstance<Thing>(given)) return true;  // refused as any other type is
    auto* object = reinterpret_cast<instance*>(given.ptr());
    return object->get_value_and_holder(get_type_info(typeid(Thing))).holder_constructed();
  }
};

template <>
class type_caster<sinew::Settings> : public made_caster<sinew::Settings> {};
template <>
class type_caster<sinew::SharedPolygons> : public made_caster<sinew::SharedPolygons> {};
template <>
class type_caster<sinew::Surface> : public made_caster<sinew::Surface> {};
template <>
class type_caster<sinew::Dataset> : public made_caster<sinew::Dataset> {};
template <>
class type_caster<sinew::RestShape> : public made_caster<sinew::RestShape> {};
template <>
class type_caster<sinew::RunFiles> : public made_caster<sinew::RunFiles> {};
template <>
class type_caster<sinew::FrameState> : public made_caster<sinew::FrameState> {};

}  // namespace pybind11::detail
