// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nanobind/nanobind.h>

#include <mutex>
#include <optional>
#include <utility>

#include "tumble/common/time.hpp"

namespace tumble::python {

namespace nb = nanobind;

/// LastTimes contains the latest times that an estimator received, exact to the nanosecond. A Status stores times as
/// doubles, which are less exact.
struct LastTimes {
  std::optional<TimeNs> sample_ns, sweep_end_ns;
};

/// Guarded is an estimator that several Python threads may call. Each call of the estimator waits for the previous one
/// and releases the interpreter's lock. A copy of Guarded copies the estimator.
template <class T>
class Guarded {
 public:
  explicit Guarded(T inside) : inside_(std::move(inside)) {}
  Guarded(const Guarded& other) : Guarded(other.copied()) {}
  Guarded& operator=(const Guarded&) = delete;
  ~Guarded() = default;

  /// Calls `work(estimator)` while other Python threads run. `work` must not use any Python object.
  template <class Work>
  auto run(Work&& work) {
    const nb::gil_scoped_release released;
    const std::lock_guard lock(busy_);
    return work(inside_);
  }

  /// Calls `work(estimator, last times)`, which also updates the times.
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

/// Binds copy.copy and copy.deepcopy, which are equal because an estimator owns all its state.
template <class T, class Class>
void bind_copy(Class& bound) {
  bound
      .def(
          "__copy__", [](const T& self) { return T(self); },
          "Returns a copy. Copy and original return later results that are identical to the bit.")
      .def(
          "__deepcopy__", [](const T& self, nb::handle) { return T(self); }, nb::arg("memo"));
}

}  // namespace tumble::python
