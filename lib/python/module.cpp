// SPDX-License-Identifier: GPL-3.0-or-later
// The module sinew._sinew; sinew/__init__.py adds what is easier in Python.
#include <sinew/core/parallel.h>

#include "arrays.h"
#include "given.h"
#include "without_gil.h"

namespace {

namespace py = pybind11;

/// Errors of the library become sinew.Error, in words of Python.
void bind_errors() {
  // NOLINTNEXTLINE(performance-unnecessary-value-param): the type that pybind11 calls
  py::register_exception_translator([](std::exception_ptr thrown) {
    try {
      if (thrown) std::rethrow_exception(thrown);
    } catch (const sinew::Error& caught) {
      const py::object error = py::module_::import("sinew._error")
                                   .attr("of_library")(sinew::python::text_of(caught.what()),
                                                       static_cast<int>(caught.exit()));
      PyErr_SetObject(py::type::handle_of(error).ptr(), error.ptr());
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
  module.doc() = "What the package sinew calls of the library.";
  module.attr("__version__") = sinew::version();
  bind_errors();
  refuse_bases();
  module.def("_with_threads", [](int threads, const py::object& job) {
    py::object result;
    sinew::with_threads(threads, [&] { result = job(); });
    return result;
  });
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
