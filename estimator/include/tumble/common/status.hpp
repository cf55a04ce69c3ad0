// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>

#include "tumble/common/detail/compiled_alike.hpp"  // IWYU pragma: keep

namespace tumble {

/// What can go wrong with input that a caller must expect. `none` is success.
enum class Trouble : std::uint8_t {
  none,
  empty,         ///< nothing was given where something is needed
  non_finite,    ///< NaN or infinity
  time_order,    ///< a time stamp equal to or before its predecessor
  gap,           ///< a time stamp too far after its predecessor
  out_of_range,  ///< a value outside of its stated bound
  too_few,       ///< fewer samples, points or matches than the computation needs
  degenerate,    ///< the data do not determine the answer in every direction
  diverged,      ///< an iteration left its region of trust
};

/// Name of a trouble as it appears in tables and messages ("time_order").
const char* to_string(Trouble trouble);

/// Outcome of a step: which field was wrong, the value found and the bound that it broke.
/// Expected trouble is reported by value; nothing is printed and nothing is thrown after construction.
struct Status {
  Trouble trouble = Trouble::none;
  const char* field = "";  ///< static string: the input field concerned
  double value = 0.0;      ///< the value found, in the field's unit
  double bound = 0.0;      ///< the bound that it broke, same unit

  bool ok() const { return trouble == Trouble::none; }
  /// "time_order: time_ns is 5, bound 7"; "ok" on success.
  std::string message() const;
};

/// Thrown by constructors alone, when a parameter is outside of its documented bound.
class InvalidParams : public std::invalid_argument {
 public:
  InvalidParams(const std::string& field, double value, const std::string& bound);
};

/// Throws InvalidParams unless `low <= value <= high` (NaN throws too).
void require_within(const char* field, double value, double low, double high);

}  // namespace tumble
