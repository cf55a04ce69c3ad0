// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/odometry/saved_streams.hpp"

#include <memory>
#include <utility>

#include "../angular_velocity/rate_stream_members.hpp"
#include "../attitude/regime_stream_members.hpp"
#include "../rolling/rolling_members.hpp"
#include "saved_state.hpp"

namespace tumble {

namespace {

using odometry::SavedKind;

template <class Stream>
constexpr SavedKind kKind = SavedKind::rate_stream;
template <>
constexpr SavedKind kKind<RegimeStream> = SavedKind::regime_stream;
template <>
constexpr SavedKind kKind<HandHeldStream> = SavedKind::carried_stream;
template <>
constexpr SavedKind kKind<HandHeldPipeline> = SavedKind::carried_live;
template <>
constexpr SavedKind kKind<RollingFilter> = SavedKind::rolling_filter;
template <>
constexpr SavedKind kKind<RollingSmoother> = SavedKind::rolling_smoother;

/// Creates on the heap the state of a stream before its first sample. Some states are too large for the stack.
template <class Stream>
std::unique_ptr<typename Stream::State> make_state(const Stream& stream) {
  using State = typename Stream::State;
  if constexpr (requires { stream.start(); }) return std::make_unique<State>(stream.start());
  return std::make_unique<State>();
}

/// Creates valid parameters of a stream; parameters without a default get arbitrary values.
template <class Stream>
typename Stream::Params valid_params() {
  typename Stream::Params out;
  if constexpr (requires { out.model.nominal; }) out.model.nominal = {};
  if constexpr (requires { out.rate.model.nominal; }) out.rate.model.nominal = {};
  if constexpr (requires { out.radius_m; }) out.radius_m = 1.0;
  if constexpr (requires { out.filter.radius_m; }) out.filter.radius_m = 1.0;
  return out;
}

}  // namespace

template <SavedStream Stream>
std::vector<std::byte> save_state(const typename Stream::Params& params, const typename Stream::State& state) {
  return odometry::save(kKind<Stream>, state, params);
}

template <SavedStream Stream>
Status load_state(std::span<const std::byte> bytes, const typename Stream::Params& params,
                  typename Stream::State& state) {
  const Stream stream(params);
  const auto fresh = make_state(stream);
  if (Status status = odometry::load(kKind<Stream>, bytes, params, *fresh); !status.ok()) return status;
  if (Status status = stream.check_state(*fresh); !status.ok()) return status;
  state = std::move(*fresh);
  return {};
}

template <SavedStream Stream>
Status saved_params(std::span<const std::byte> bytes, typename Stream::Params& params) {
  typename Stream::Params read = valid_params<Stream>();
  const auto any = make_state(Stream(read));
  const Status status = odometry::load_params(kKind<Stream>, bytes, std::as_const(*any), read);
  if (status.ok()) params = read;
  return status;
}

#define TUMBLE_SAVED_STREAM(Stream)                                                                      \
  template std::vector<std::byte> save_state<Stream>(const Stream::Params&, const Stream::State&);       \
  template Status load_state<Stream>(std::span<const std::byte>, const Stream::Params&, Stream::State&); \
  template Status saved_params<Stream>(std::span<const std::byte>, Stream::Params&);
TUMBLE_SAVED_STREAM(RateStream)
TUMBLE_SAVED_STREAM(RegimeStream)
TUMBLE_SAVED_STREAM(HandHeldStream)
TUMBLE_SAVED_STREAM(HandHeldPipeline)
TUMBLE_SAVED_STREAM(RollingFilter)
TUMBLE_SAVED_STREAM(RollingSmoother)
#undef TUMBLE_SAVED_STREAM

}  // namespace tumble
