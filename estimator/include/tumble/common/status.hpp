// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>

namespace tumble {

enum class ErrorCode : std::uint8_t {
  none,
  empty,              ///< a required input is missing
  non_finite,         ///< NaN or infinity
  time_order,         ///< a time stamp is not later than the previous time stamp
  gap,                ///< a time stamp is too long after the previous time stamp
  out_of_range,       ///< a value is outside its stated bounds
  insufficient_data,  ///< fewer samples, points or matches than the computation needs
  degenerate,         ///< the data do not determine the result in every direction
  diverged,           ///< an iteration left its trust region
};

const char* to_string(ErrorCode error_code);

/// Functions of the library return input errors as Status and print nothing; only constructors throw exceptions.
struct Status {
  ErrorCode error_code = ErrorCode::none;
  const char* field = "";  ///< name of the input field (static string)
  double value = 0.0;      ///< value of the input field, in the field's unit
  double bound = 0.0;      ///< violated limit, in the field's unit

  bool ok() const { return error_code == ErrorCode::none; }
  /// Returns for example "time_order: time_ns is 5; the bound is 7", or "ok".
  std::string message() const;
};

/// Constructors throw InvalidParams if a parameter is out of its documented bounds.
class InvalidParams : public std::invalid_argument {
 public:
  InvalidParams(const std::string& field, double value, const std::string& bound);
};

/// Throws InvalidParams if `value` is NaN or outside of [low, high].
void require_in_interval(const char* field, double value, double low, double high);

}  // namespace tumble
