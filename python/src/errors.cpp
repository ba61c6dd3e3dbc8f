// SPDX-License-Identifier: MIT
// The library's exceptions as those of orbitutte/errors.py; std::bad_alloc becomes MemoryError by pybind11
// itself.
#include <cstring>

#include "bindings.h"
#include "orbitutte/types.h"

namespace orbitutte::python {
namespace {

// A message may hold bytes of a path that are not UTF-8.
void raise(const char* type, const std::exception& error) {
  const char* const what = error.what();
  const auto text = py::reinterpret_steal<py::object>(
      PyUnicode_DecodeUTF8(what, static_cast<Py_ssize_t>(std::strlen(what)), "replace"));
  PyErr_SetObject(py::module_::import("orbitutte.errors").attr(type).ptr(), text.ptr());
}

void translate(std::exception_ptr pointer) {
  try {
    if (pointer) std::rethrow_exception(pointer);
  } catch (const MeshError& error) {
    raise("MeshError", error);
  } catch (const FileError& error) {
    raise("FileError", error);
  } catch (const ArgumentError& error) {
    raise("ArgumentError", error);
  } catch (const Cancelled& error) {
    raise("Cancelled", error);
  } catch (const Error& error) {
    raise("Error", error);
  }
}

}  // namespace

void bind_errors(py::module_&) { py::register_exception_translator(translate); }

}  // namespace orbitutte::python
