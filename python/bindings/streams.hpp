// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nanobind/nanobind.h>

#include <cstddef>
#include <utility>
#include <vector>

#include "guarded.hpp"
#include "trouble.hpp"
#include "tumble/common/imu.hpp"

namespace tumble::python {

namespace nb = nanobind;

/// A filter of the library with its State, as one object of Python.
template <class Filter, class State = typename Filter::State>
struct Running {
  Filter filter;
  State state;
};

/// Gives samples to an estimator one after the other, up to the first that it refuses, which is TumbleError with the
/// sample's index and what came out before. `step(estimator, sample, out)` returns a Status.
template <class Out, class Estimator, class Step>
Out feed(Guarded<Estimator>& to, const std::vector<ImuSample>& samples, Step step) {
  Out out;
  Status status;
  std::size_t k = 0;
  to.run([&](Estimator& estimator) {
    for (; k < samples.size(); ++k) {
      status = step(estimator, samples[k], out);
      if (!status.ok()) break;
    }
  });
  if (!status.ok()) require(status, k, nb::cast(std::move(out)));
  return out;
}

/// Of every method that takes samples.
inline constexpr const char* kSamples =
    "time_ns: an int, or (N,) int64, the end of each sample's window; gyro: (3,) or (N, 3), rad/s; accel: specific "
    "force,\n(3,) or (N, 3), m/s^2, +9.8 up at rest; clip_flags: bits gyro x y z, accel x y z of what the device says "
    "clipped.";

}  // namespace tumble::python
