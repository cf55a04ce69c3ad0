// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <concepts>
#include <cstddef>
#include <span>
#include <vector>

#include "tumble/angular_velocity/rate_stream.hpp"
#include "tumble/attitude/carried_stream.hpp"
#include "tumble/attitude/detail/carried_live.hpp"
#include "tumble/attitude/regime_stream.hpp"
#include "tumble/common/status.hpp"
#include "tumble/rolling/rolling_filter.hpp"
#include "tumble/rolling/rolling_smoother.hpp"

/// Serialisation of stream states, for example to resume after a reboot. TumblingOdometry and RollingOdometry have
/// their own save() and load().
namespace tumble {

template <class Stream>
concept SavedStream =
    std::same_as<Stream, RateStream> || std::same_as<Stream, RegimeStream> || std::same_as<Stream, CarriedStream> ||
    std::same_as<Stream, CarriedLive> || std::same_as<Stream, RollingFilter> || std::same_as<Stream, RollingSmoother>;

/// Serialises a state and the parameters of its stream, with a checksum. The bytes are equal on every machine. A stream
/// with equal parameters that loads the bytes continues with bit-identical results.
template <SavedStream Stream>
std::vector<std::byte> save_state(const typename Stream::Params& params, const typename Stream::State& state);

/// Replaces `state` by the state that save_state() wrote. On error `state` is unchanged. Errors name the field, the
/// stored value and the bound:
/// - `too_few`: truncated bytes.
/// - `non_finite`, `time_order`, `gap`, `out_of_range`: the stored state is invalid.
/// - The first parameter that differs: the stored value and the value of `stream`.
/// - Bytes of another stream or library version, and damaged bytes, are rejected.
///
/// Throws InvalidParams as the stream's constructor does.
template <SavedStream Stream>
Status load_state(std::span<const std::byte> bytes, const typename Stream::Params& params,
                  typename Stream::State& state);

/// Reads the parameters stored in a saved state. On error `params` is unchanged.
template <SavedStream Stream>
Status saved_params(std::span<const std::byte> bytes, typename Stream::Params& params);

}  // namespace tumble
