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

/// A method's program that gave no answer: it crashed or could not be started, ran out of time, or the machine had no
/// room for its run. With what it said until then.
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

/// An answer that is not what it should be, with what its program said.
class RefusedAnswer : public BadInput {
 public:
  RefusedAnswer(const std::string& what, std::string transcript) : BadInput(what), transcript_(std::move(transcript)) {}
  const std::string& transcript() const { return transcript_; }

 private:
  std::string transcript_;
};

/// The method that a file NAME.yaml or NAME.py describes (EXTERNAL.md). Of a command: sensors are written into a folder
/// of their own in the formats that it names, it runs with its limits in a process of its own, and what it leaves is
/// read back. Of a function of Python: the same through memory. It never sees the truth. Its limit of time is the
/// description's, at most `time_limit_s`. Throws BadInput when the description is wrong or its version command fails.
/// Running it throws NoAnswer, and RefusedAnswer when what it left is not what it should be.
Method external_method(const std::filesystem::path& file,
                       double time_limit_s = std::numeric_limits<double>::infinity());

/// Whether `name` is that of a file which describes a method: NAME.yaml, NAME.py.
bool is_method_file(const std::string& name);

/// find_methods (method.hpp) for a list, commands of somebody else's given at most `time_limit_s`.
std::vector<MethodPointer> find_methods_within(std::span<const std::string> names, double time_limit_s);

}  // namespace tumble::scenarios
