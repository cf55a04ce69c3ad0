// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nanobind/nanobind.h>

#include <mutex>
#include <optional>
#include <utility>

#include "tumble/common/time.hpp"

namespace tumble::python {

namespace nb = nanobind;

/// Times that an estimator was given last, to the nanosecond: a Status has them as doubles.
struct LastTimes {
  std::optional<TimeNs> sample_ns, sweep_end_ns;
};

/// An estimator that several threads of Python may call: each call waits for the one before, without the interpreter's
/// lock. Copies are of the estimator.
template <class T>
class Guarded {
 public:
  explicit Guarded(T inside) : inside_(std::move(inside)) {}
  Guarded(const Guarded& other) : Guarded(other.copied()) {}
  Guarded& operator=(const Guarded&) = delete;
  ~Guarded() = default;

  /// Calls `work(estimator)` while other threads of Python go on; it must not touch any object of Python.
  template <class Work>
  auto run(Work&& work) {
    const nb::gil_scoped_release released;
    const std::lock_guard lock(busy_);
    return work(inside_);
  }

  /// The same with `work(estimator, last times)`, which keeps the times.
  template <class Work>
  auto run_timed(Work&& work) {
    const nb::gil_scoped_release released;
    const std::lock_guard lock(busy_);
    return work(inside_, last_);
  }

 private:
  explicit Guarded(std::pair<T, LastTimes> all) : inside_(std::move(all.first)), last_(all.second) {}

  std::pair<T, LastTimes> copied() const {
    const nb::gil_scoped_release released;
    const std::lock_guard lock(busy_);
    return {inside_, last_};
  }

  mutable std::mutex busy_;
  T inside_;
  LastTimes last_;
};

/// copy.copy and copy.deepcopy, which are the same: all state is the estimator's own.
template <class T, class Class>
void bind_copy(Class& bound) {
  bound
      .def(
          "__copy__", [](const T& self) { return T(self); }, "A copy goes on with the same bits.")
      .def(
          "__deepcopy__", [](const T& self, nb::handle) { return T(self); }, nb::arg("memo"));
}

}  // namespace tumble::python
