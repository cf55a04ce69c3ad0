// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nanobind/nanobind.h>

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "guarded.hpp"
#include "saving.hpp"
#include "trouble.hpp"
#include "tumble/common/imu.hpp"
#include "tumble/odometry/saved_streams.hpp"

namespace tumble::python {

namespace nb = nanobind;

/// Running holds a filter of the library and its State in one Python object.
template <class Filter, class State = typename Filter::State>
struct Running {
  Filter filter;
  State state;
};

/// Streaming holds a stream and its State. The State is on the heap, because the state of a sphere stream needs half a
/// megabyte.
template <SavedStream Stream>
struct Streaming {
  using Params = typename Stream::Params;
  using State = typename Stream::State;

  Params params;
  Stream filter;
  std::unique_ptr<State> state = std::make_unique<State>();

  explicit Streaming(const Params& given) : params(given), filter(given) {
    if constexpr (requires { filter.start(); }) *state = filter.start();
  }
  Streaming(const Streaming& other)
      : params(other.params), filter(other.filter), state(std::make_unique<State>(*other.state)) {}
  Streaming(Streaming&&) noexcept = default;
  Streaming& operator=(const Streaming&) = delete;
  ~Streaming() = default;

  std::vector<std::byte> save() const { return save_state<Stream>(params, *state); }
  Status load(std::span<const std::byte> bytes) { return load_state<Stream>(bytes, params, *state); }
};

/// Constructs a stream, including its parameters, from saved bytes.
template <class Stream>
Streaming<Stream> restored(std::span<const std::byte> bytes) {
  typename Stream::Params params;
  require(saved_params<Stream>(bytes, params));
  Streaming<Stream> out(params);
  require(out.load(bytes));
  return out;
}

/// Binds copying, save(), load() and pickling of a stream.
template <class Stream, class Class>
void bind_keeping(Class& bound) {
  bind_copy<Guarded<Streaming<Stream>>>(bound);
  bind_saving<Streaming<Stream>>(bound, &restored<Stream>);
}

/// Adds samples to an estimator until it rejects one. The raised TumbleError then contains the index of the rejected
/// sample and the results of the earlier samples. `step(estimator, sample, out)` returns a Status.
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
