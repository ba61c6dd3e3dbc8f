// SPDX-License-Identifier: MIT
// Long computations: progress for Python's listeners, signals, and seconds.
#pragma once

#include <chrono>
#include <exception>
#include <string>
#include <utility>

#include "bindings.h"
#include "orbitutte/embed_types.h"

namespace orbitutte::python {

using Clock = std::chrono::steady_clock;

inline double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// Tells Python about the progress if there is a listener, and always lets Python handle signals. If Python
/// raises something, the computation ends, and `rethrow` raises it again, so that no exception of Python's
/// passes through the library.
class ProgressHook {
 public:
  explicit ProgressHook(py::object listener) : listener_(std::move(listener)) {}

  /// Called without the GIL. False: stop.
  bool operator()(const Progress& progress) {
    constexpr double signal_seconds = 0.05;  // waiting for the GIL may take as long as an iteration
    if (listener_.is_none() && seconds_since(last_) < signal_seconds) return true;
    const py::gil_scoped_acquire acquire;
    last_ = Clock::now();
    try {
      if (PyErr_CheckSignals() != 0) throw py::error_already_set();
      return listener_.is_none() || tell(progress);
    } catch (...) {
      raised_ = std::current_exception();
      return false;
    }
  }

  /// Raises what Python raised, if it did. Called with the GIL.
  void rethrow() const {
    if (raised_) std::rethrow_exception(raised_);
  }

 private:
  // Only False stops. A function without `return` goes on, and so does any other answer that is not a bool.
  bool tell(const Progress& progress) const {
    const py::object answer =
        listener_(progress.stage, progress.iteration, progress.energy, progress.gradient_norm);
    return !is_bool(answer) || answer.cast<bool>();
  }

  // Python's or NumPy's.
  static bool is_bool(const py::object& value) {
    return PyBool_Check(value.ptr()) ||
           std::string(Py_TYPE(value.ptr())->tp_name).rfind("numpy.bool", 0) == 0;
  }

  py::object listener_;
  Clock::time_point last_ = Clock::now();
  std::exception_ptr raised_;
};

/// Runs compute(options) without the GIL, and tells the listener of its progress.
template <typename Compute>
auto with_listener(EmbedOptions options, py::object listener, const Compute& compute) {
  ProgressHook hook(std::move(listener));
  options.progress = [&](const Progress& progress) { return hook(progress); };
  try {
    const py::gil_scoped_release release;
    return compute(options);
  } catch (const Cancelled&) {
    hook.rethrow();
    throw;
  }
}

}  // namespace orbitutte::python
