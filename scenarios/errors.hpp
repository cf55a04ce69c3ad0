// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <stdexcept>

namespace tumble::scenarios {

/// Wrong use or bad input: an unknown name, a file that is not there or truncated, a value out of bounds. The message
/// is one line that says what, where and which bound. The program ends with status 2.
class BadInput : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace tumble::scenarios
