// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nanobind/nanobind.h>

#include <cstddef>
#include <optional>
#include <span>
#include <string>

#include "tumble/common/imu.hpp"
#include "tumble/common/status.hpp"
#include "tumble/common/time.hpp"

/// How trouble of the library reaches Python: as tumble.TumbleError with trouble, field, value and bound.
namespace tumble::python {

namespace nb = nanobind;

/// Raises TumbleError with the message "FIELD is VALUE, must be BOUND". `trouble`: the name of a Trouble, or `type`,
/// `shape`, `unknown` of an argument. `bound`: a number or a text.
[[noreturn]] void raise_input(const char* trouble, const std::string& field, nb::handle value, nb::handle bound);

/// What a Status has as doubles, which have lost the nanoseconds of stamps since 1970; where it is known.
struct ExactTimes {
  std::optional<TimeNs> value, bound;
};

/// Raises TumbleError with a status' own message, unless it is ok. `index`: of the sample in an array; those before it
/// were taken in. `so_far`: what came out of these. Times are whole numbers: `times`, or what the status has of them.
void require(const Status& status, std::optional<std::size_t> index = std::nullopt, nb::object so_far = nb::none(),
             const ExactTimes& times = {});

/// The same of a whole recording, which is refused with all its samples: looks for the one that the status means.
void require(const Status& status, std::span<const ImuSample> samples);

/// What health() of an estimator gives: nothing where all can be believed, else a TumbleError that is not raised.
nb::object health_of(const Status& status);
inline constexpr const char* kHealth =
    "Whether it can be believed just now: None, or what speaks against a sensor or the place on the map, as a\n"
    "TumbleError that is not raised (field, value, bound; str() says it). The estimator goes on either way.";

/// From here on InvalidParams, which constructors throw, is a TumbleError too.
void translate_invalid_params();

}  // namespace tumble::python
