// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <concepts>
#include <cstddef>
#include <span>
#include <vector>

#include "tumble/angular_velocity/rate_stream.hpp"
#include "tumble/attitude/detail/hand_held_pipeline.hpp"
#include "tumble/attitude/hand_held_stream.hpp"
#include "tumble/attitude/regime_stream.hpp"
#include "tumble/common/status.hpp"
#include "tumble/rolling/rolling_filter.hpp"
#include "tumble/rolling/rolling_smoother.hpp"

/// SavedStream is satisfied by the estimators whose state can be saved and loaded, for example to resume after a
/// reboot. TumblingOdometry and RollingOdometry have separate functions save() and load().
namespace tumble {

template <class Stream>
concept SavedStream = std::same_as<Stream, RateStream> || std::same_as<Stream, RegimeStream> ||
    std::same_as<Stream, HandHeldStream> || std::same_as<Stream, HandHeldPipeline> ||
    std::same_as<Stream, RollingFilter> || std::same_as<Stream, RollingSmoother>;

/// Serialises the state and the parameters of an estimator, with a checksum. The saved bytes are equal on every
/// machine. An estimator with equal parameters that loads the bytes continues with bit-identical results.
template <SavedStream Stream>
std::vector<std::byte> save_state(const typename Stream::Params& params, const typename Stream::State& state);

/// Replaces `state` with the state that save_state() wrote. On error, `state` is unchanged, and the returned status
/// names the field, the stored value and the bound. The error `too_few` means that the bytes are truncated. The errors
/// `non_finite`, `time_order`, `gap` and `out_of_range` mean that the stored state is invalid. If the stored parameters
/// differ from `params`, the status contains the first different parameter with the stored and the expected value. The
/// function also rejects damaged bytes, and bytes of another estimator or library version.
///
/// Throws InvalidParams if `params` contains a value out of bounds.
template <SavedStream Stream>
Status load_state(std::span<const std::byte> bytes, const typename Stream::Params& params,
                  typename Stream::State& state);

/// Reads the parameters that a saved state contains. On error, `params` is unchanged.
template <SavedStream Stream>
Status saved_params(std::span<const std::byte> bytes, typename Stream::Params& params);

}  // namespace tumble
