// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <stdexcept>
#include <string>

namespace tumble::scenarios {

/// BadInput is the exception for wrong use or invalid input, for example an unknown name, a truncated file, or a value
/// outside its limits. The program `tumble` prints the message of a BadInput and exits with status 2.
class BadInput : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// WrongOption is the exception for an option whose value cannot apply to the recording, for example a topic that the
/// bag does not contain. A WrongOption requires a change of the command, so `tumble doctor` does not report a fault of
/// the recording.
class WrongOption : public BadInput {
 public:
  using BadInput::BadInput;
};

inline void require_length(const std::string& place, const char* field, std::size_t found, std::size_t expected) {
  if (found == expected) return;
  throw BadInput(place + "." + field + " has " + std::to_string(found) + " entries; it must have " +
                 std::to_string(expected));
}

}  // namespace tumble::scenarios
