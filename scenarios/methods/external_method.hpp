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

/// NoAnswer is the exception if an external program gave no result. Possible reasons are a crash, a failed start, a
/// time-out, or a lack of memory or disk space. The message of NoAnswer contains the program's output so far.
class NoAnswer : public std::runtime_error {
 public:
  enum class Why { crashed, timed_out, machine };
  NoAnswer(Why why, const std::string& what, std::string transcript = "")
      : std::runtime_error(what), why_(why), transcript_(std::move(transcript)) {}
  Why why() const { return why_; }
  const std::string& transcript() const { return transcript_; }

 private:
  Why why_;
  std::string transcript_;
};

/// RefusedAnswer is the exception if the result of an external program is invalid. The message of RefusedAnswer
/// contains the program's output.
class RefusedAnswer : public BadInput {
 public:
  RefusedAnswer(const std::string& what, std::string transcript) : BadInput(what), transcript_(std::move(transcript)) {}
  const std::string& transcript() const { return transcript_; }

 private:
  std::string transcript_;
};

/// Creates the method that a file NAME.yaml or NAME.py describes (EXTERNAL.md). A command receives the sensor data in a
/// separate folder in the requested formats. The command runs in a separate process with limits of time and memory, and
/// writes its result to a file. A Python function exchanges the sensor data and the result through shared memory. The
/// external program of a method never receives the true motion.
///
/// The time limit is the limit in the description, but at most `time_limit_s`. Throws BadInput if the description is
/// invalid or if the version command fails. Running the method throws NoAnswer if there is no result, and RefusedAnswer
/// if the result is invalid.
Method external_method(const std::filesystem::path& file,
                       double time_limit_s = std::numeric_limits<double>::infinity());

/// Returns whether `name` has the form NAME.yaml or NAME.py, which describes an external method.
bool is_method_file(const std::string& name);

/// Finds the methods in a list of names, like find_methods (method.hpp). The time limit of external methods is at most
/// `time_limit_s`.
std::vector<MethodPointer> find_methods_within(std::span<const std::string> names, double time_limit_s);

}  // namespace tumble::scenarios
