// SPDX-License-Identifier: GPL-3.0-or-later
// LAMMPS's headers. Those of 2022 need a function of fmt that newer versions of it lack; those of
// 2025 bring a copy of fmt of their own, whose functions are in LAMMPS's library. Error texts go to
// LAMMPS as std::string.
#pragma once

#if __has_include(<lammps/fmt/format.h>)
#undef FMT_HEADER_ONLY
#include <lammps/fmt/format.h>
#else
#include <fmt/format.h>
#if FMT_VERSION >= 90000
namespace fmt {
template <class Text, class... Values>
auto make_args_checked(const Text&, const std::remove_reference_t<Values>&... values) {
  return fmt::make_format_args(values...);
}
}  // namespace fmt
#endif
#endif

#include <lammps/atom.h>
#include <lammps/comm.h>
#include <lammps/error.h>
#include <lammps/fix.h>
#include <lammps/force.h>
#include <lammps/input.h>
#include <lammps/lammps.h>
#include <lammps/library.h>
#include <lammps/memory.h>
#include <lammps/modify.h>
#include <lammps/neigh_list.h>
#include <lammps/neighbor.h>
#include <lammps/pair.h>
#include <lammps/timer.h>
