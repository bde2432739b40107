// SPDX-License-Identifier: GPL-3.0-or-later
// The module sinew._sinew; sinew/__init__.py adds what is easier in Python.
#include <array>
#include <string>
#include <string_view>
#include <utility>

#include "arrays.h"
#include "without_gil.h"

namespace {

namespace py = pybind11;

/// A message in which options of the commands are arguments of Python.
std::string for_python(std::string message) {
  static constexpr std::array<std::pair<std::string_view, std::string_view>, 3> words{
      {{" --resume", " resume=True"}, {" --force", " force=True"}, {" with -o", ""}}};
  for (const auto& [option, argument] : words)
    for (auto at = message.find(option); at != std::string::npos; at = message.find(option, at))
      message.replace(at, option.size(), argument);
  return message;
}

/// Errors of the library become sinew.Error, with the exit code that the commands end with.
void bind_errors(py::module_& module) {
  static py::exception<sinew::Error> error(module, "Error");
  error.attr("exit_code") = static_cast<int>(sinew::Exit::bad_input);
  // NOLINTNEXTLINE(performance-unnecessary-value-param): the type that pybind11 calls
  py::register_exception_translator([](std::exception_ptr thrown) {
    try {
      if (thrown) std::rethrow_exception(thrown);
    } catch (const sinew::Error& caught) {
      py::object value = py::reinterpret_borrow<py::object>(error)(for_python(caught.what()));
      value.attr("exit_code") = static_cast<int>(caught.exit());
      PyErr_SetObject(error.ptr(), value.ptr());
    }
  });
}

/// Refuses objects of pybind11's base class, which end the interpreter: pickle's protocols 0 and 1
/// make one of whatever they are given.
void refuse_bases() {
  auto* base = reinterpret_cast<PyTypeObject*>(py::detail::get_internals().instance_base);
  static const newfunc make = base->tp_new;
  base->tp_new = [](PyTypeObject* type, PyObject* words, PyObject* named) -> PyObject* {
    if (py::detail::all_type_info(type).empty()) {
      PyErr_SetString(
          PyExc_TypeError,
          "cannot pickle or copy this object; keep the arrays or the scene it was made of");
      return nullptr;
    }
    return make(type, words, named);
  };
}

}  // namespace

PYBIND11_MODULE(_sinew, module) {
  module.doc() = "Elastic bodies bent by a skeleton.";
  module.attr("__version__") = sinew::version();
  bind_errors(module);
  refuse_bases();
  py::module_::import("atexit").attr("register")(
      py::cpp_function(&sinew::python::WithoutGil::let_all_end));
  sinew::python::bind_meshes(module);
  sinew::python::bind_datasets(module);
  sinew::python::bind_deformation(module);
  sinew::python::bind_scenes(module);
  sinew::python::bind_inspection(module);
  sinew::python::bind_simulation(module);
  sinew::python::bind_runs(module);
}
