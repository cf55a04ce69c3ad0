// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <stdexcept>
#include <string>

namespace tumble::scenarios {

/// Wrong use or bad input: an unknown name, a missing or truncated file, a value out of bounds. The message is one line
/// with the fault, its location and the allowed range. The program exits with status 2.
class BadInput : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Throws BadInput if the array `place.field` differs in length from the arrays that belong to it.
inline void require_length(const std::string& place, const char* field, std::size_t found, std::size_t expected) {
  if (found == expected) return;
  throw BadInput(place + "." + field + " has " + std::to_string(found) + " entries, must have " +
                 std::to_string(expected));
}

}  // namespace tumble::scenarios
