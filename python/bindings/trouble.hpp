// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nanobind/nanobind.h>

#include <cstddef>
#include <optional>
#include <span>
#include <string>

#include "tumble/common/status.hpp"
#include "tumble/common/types.hpp"

/// trouble.hpp converts errors of the library to tumble.TumbleError, with error code, field, value and bound.
namespace tumble::python {

namespace nb = nanobind;

/// Raises TumbleError with the message "FIELD is VALUE; it must be BOUND". `error_code` is the name of an ErrorCode, or
/// `type`, `shape` or `unknown` for a wrong argument. `bound` is a number or a text.
[[noreturn]] void raise_input(const char* error_code, const std::string& field, nb::handle value, nb::handle bound);

/// ExactTimes contains the exact value and bound of a time, if known. A Status stores doubles, which cannot represent
/// nanoseconds since 1970.
struct ExactTimes {
  std::optional<TimeNs> value, bound;
};

/// Raises TumbleError with the message of `status`; returns if the status is ok. `index` is the index of the rejected
/// sample in its array. `so_far` contains the results of the earlier samples. Times in the error are integers: the
/// exact times in `times`, or the rounded times of the status.
void require(const Status& status, std::optional<std::size_t> index = std::nullopt, nb::object so_far = nb::none(),
             const ExactTimes& times = {});

/// Returns whether an odometry class can process the next sample although it rejected this sample: the class bridges a
/// gap.
inline bool may_continue(const Status& status) {
  return status.ok() || status.error_code == ErrorCode::gap;
}

/// Raises TumbleError for a recording that the library rejected as a whole. The error contains the index of the
/// rejected sample.
void require(const Status& status, std::span<const ImuSample> samples);

/// Registers the translation of InvalidParams, which constructors throw, to TumbleError.
void translate_invalid_params();

}  // namespace tumble::python
