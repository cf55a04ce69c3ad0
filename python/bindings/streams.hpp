// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nanobind/nanobind.h>

#include <cstddef>
#include <memory>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "guarded.hpp"
#include "trouble.hpp"
#include "tumble/common/types.hpp"

namespace tumble::python {

namespace nb = nanobind;

/// Running holds a filter of the library and its State in one Python object.
template <class Filter, class State = typename Filter::State>
struct Running {
  Filter filter;
  State state;
};

/// Streaming is a stream with its State. The State is on the heap, because that of a sphere has half a megabyte.
template <class Stream>
struct Streaming {
  using Params = typename Stream::Params;
  using State = typename Stream::State;

  Stream filter;
  std::unique_ptr<State> state = std::make_unique<State>();

  explicit Streaming(const Params& params) : filter(params) {
    if constexpr (requires { filter.start(); }) *state = filter.start();
  }
  Streaming(const Streaming& other) : filter(other.filter), state(std::make_unique<State>(*other.state)) {}
  Streaming(Streaming&&) noexcept = default;
  Streaming& operator=(const Streaming&) = delete;
  ~Streaming() = default;
};

/// Adds samples to an estimator up to the first rejected sample. The raised TumbleError then has the index of that
/// sample and the results before it. `step(estimator, sample, out)` returns a Status.
template <class Out, class Estimator, class Step>
Out feed(Guarded<Estimator>& to, const std::vector<ImuSample>& samples, Step step) {
  Out out;
  Status status;
  std::size_t k = 0;
  const std::optional<TimeNs> last_ns = to.run_timed([&](Estimator& estimator, LastTimes& last) {
    for (; k < samples.size(); ++k) {
      status = step(estimator, samples[k], out);
      if (!status.ok()) break;
      last.sample_ns = samples[k].time_ns;
    }
    return last.sample_ns;
  });
  if (!status.ok()) require(status, k, nb::cast(std::move(out)), {samples[k].time_ns, last_ns});
  return out;
}

/// Returns the exact value and bound of the time that made the estimator reject a sweep. The bound is the sweep's own
/// start or the end of the previous sweep.
inline ExactTimes exact_sweep(const Status& status, TimeNs start_ns, TimeNs end_ns, std::optional<TimeNs> before_ns) {
  if (std::string_view(status.field) == "end_ns") return {end_ns, start_ns};
  return {start_ns, before_ns};
}

/// kSamples documents the arguments of every method that accepts samples.
inline constexpr const char* kSamples =
    "time_ns: an int, or (N,) int64, the end of each sample's window; gyro: (3,) or (N, 3), rad/s; accel: specific "
    "force,\n(3,) or (N, 3), m/s^2, +9.8 up at rest; clip_flags: bits gyro x y z, accel x y z that the device reports "
    "as "
    "clipped.";

}  // namespace tumble::python
