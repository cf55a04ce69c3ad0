// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <limits>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "scenarios/errors.hpp"
#include "scenarios/methods/method.hpp"

namespace tumble::scenarios {

/// An external program gave no answer: it crashed, could not be started, timed out, or the machine lacked memory or
/// disk space. Contains the program's output so far.
class NoAnswer : public std::runtime_error {
 public:
  enum class Why { crashed, out_of_time, machine };
  NoAnswer(Why why, const std::string& what, std::string transcript = "")
      : std::runtime_error(what), why_(why), transcript_(std::move(transcript)) {}
  Why why() const { return why_; }
  const std::string& transcript() const { return transcript_; }

 private:
  Why why_;
  std::string transcript_;
};

/// The answer of an external program is invalid. Contains the program's output.
class RefusedAnswer : public BadInput {
 public:
  RefusedAnswer(const std::string& what, std::string transcript) : BadInput(what), transcript_(std::move(transcript)) {}
  const std::string& transcript() const { return transcript_; }

 private:
  std::string transcript_;
};

/// Returns the method described by NAME.yaml or NAME.py (EXTERNAL.md). For a command: writes the sensors to a separate
/// folder in the requested formats, runs the command in its own process with its limits, and reads the result. For a
/// Python function: exchanges the same data through shared memory. The program never receives the truth.
///
/// The time limit is that of the description, at most `time_limit_s`. Throws BadInput if the description is invalid or
/// its version command fails. Running the method throws NoAnswer, or RefusedAnswer if the result is invalid.
Method external_method(const std::filesystem::path& file,
                       double time_limit_s = std::numeric_limits<double>::infinity());

/// Returns true if `name` is a file that describes a method: NAME.yaml, NAME.py.
bool is_method_file(const std::string& name);

/// Calls find_methods (method.hpp) for a list; external methods get at most `time_limit_s`.
std::vector<MethodPointer> find_methods_within(std::span<const std::string> names, double time_limit_s);

}  // namespace tumble::scenarios
