// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <stdexcept>
#include <string>

namespace tumble::scenarios {

/// Wrong use or bad input: an unknown name, a file that is not there or truncated, a value out of bounds. The message
/// is one line that says what, where and which bound. The program ends with status 2.
class BadInput : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Throws BadInput where an array, `place.field`, is not as long as those beside it.
inline void require_length(const std::string& place, const char* field, std::size_t found, std::size_t expected) {
  if (found == expected) return;
  throw BadInput(place + "." + field + " has " + std::to_string(found) + " entries, must have " +
                 std::to_string(expected));
}

}  // namespace tumble::scenarios
