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

/// States of streams as bytes that somebody keeps, for a robot that reboots. The doors have save() and load() of their
/// own.
namespace tumble {

template <class Stream>
concept SavedStream =
    std::same_as<Stream, RateStream> || std::same_as<Stream, RegimeStream> || std::same_as<Stream, CarriedStream> ||
    std::same_as<Stream, CarriedLive> || std::same_as<Stream, RollingFilter> || std::same_as<Stream, RollingSmoother>;

/// A state and the parameters of the stream that it is of, as bytes that are the same on every machine, with a
/// checksum: a stream of the same parameters that loads them goes on with the same bits.
template <SavedStream Stream>
std::vector<std::byte> save_state(const typename Stream::Params& params, const typename Stream::State& state);

/// What save_state() was given, in place of what is in `state`. On trouble that is as it was: `too_few` (bytes that end
/// early), `non_finite`, `time_order`, `gap`, `out_of_range`, with the field, what the bytes say and the bound.
/// Parameters that are not those of the bytes are trouble too: the first that differs, the one saved and the one here.
/// Bytes of another stream or version of the library, or damaged ones, are refused. Throws InvalidParams as the
/// stream's constructor.
template <SavedStream Stream>
Status load_state(std::span<const std::byte> bytes, const typename Stream::Params& params,
                  typename Stream::State& state);

/// The parameters that such bytes are of, to make a stream of; on trouble `params` are as they were.
template <SavedStream Stream>
Status saved_params(std::span<const std::byte> bytes, typename Stream::Params& params);

}  // namespace tumble
