// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>

#include "tumble/common/detail/same_compiler_settings.hpp"  // IWYU pragma: keep

namespace tumble {

/// ErrorCode lists the kinds of input errors that a caller must expect. The value `none` means success.
enum class ErrorCode : std::uint8_t {
  none,
  empty,         ///< a required input is missing
  non_finite,    ///< NaN or infinity
  time_order,    ///< a time stamp equal to or before its predecessor
  gap,           ///< a time stamp too long after its predecessor
  out_of_range,  ///< a value out of its stated bounds
  too_few,       ///< fewer samples, points or matches than the computation needs
  degenerate,    ///< the data do not determine the result in every direction
  diverged,      ///< an iteration left its trust region
};

/// Returns the name of an error kind as used in tables and messages ("time_order").
const char* to_string(ErrorCode error_code);

/// Status is the result of a processing step: the invalid field, its value and the violated limit. The library reports
/// expected errors by a returned Status and prints nothing. Only constructors throw exceptions.
struct Status {
  ErrorCode error_code = ErrorCode::none;
  const char* field = "";  ///< static string: name of the input field
  double value = 0.0;      ///< value found, in the field's unit
  double bound = 0.0;      ///< violated limit, in the field's unit

  bool ok() const { return error_code == ErrorCode::none; }
  /// Returns a message such as "time_order: time_ns is 5; the bound is 7". Returns "ok" on success.
  std::string message() const;
};

/// InvalidParams is thrown by a constructor if a parameter is out of its documented bounds.
class InvalidParams : public std::invalid_argument {
 public:
  InvalidParams(const std::string& field, double value, const std::string& bound);
};

/// Throws InvalidParams unless `low <= value <= high`; NaN also throws.
void require_within(const char* field, double value, double low, double high);

}  // namespace tumble
