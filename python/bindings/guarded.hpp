// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nanobind/nanobind.h>

#include <mutex>
#include <optional>
#include <utility>

#include "tumble/common/types.hpp"

namespace tumble::python {

namespace nb = nanobind;

/// LastTimes contains the latest times that an estimator received, in nanoseconds. A Status stores times as doubles,
/// which round nanoseconds since 1970.
struct LastTimes {
  std::optional<TimeNs> sample_ns, sweep_end_ns;
};

/// Guarded lets several Python threads call one estimator. Each call waits for the previous call and releases the
/// interpreter's lock. A copy of Guarded copies the estimator.
template <class T>
class Guarded {
 public:
  explicit Guarded(T inside) : inside_(std::move(inside)) {}
  Guarded(const Guarded& other) : Guarded(other.copied()) {}
  Guarded& operator=(const Guarded&) = delete;
  ~Guarded() = default;

  /// Calls `work(estimator)` without the interpreter's lock, so other Python threads run. `work` must not use Python
  /// objects.
  template <class Work>
  auto run(Work&& work) {
    const nb::gil_scoped_release released;
    const std::lock_guard lock(busy_);
    return work(inside_);
  }

  /// Calls `work(estimator, last_times)`; `work` also updates the times.
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

/// Binds copy.copy and copy.deepcopy to the same function, because an estimator owns all its state.
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
