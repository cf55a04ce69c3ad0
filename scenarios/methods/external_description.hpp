// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "scenarios/methods/method.hpp"

namespace tumble::scenarios {

/// A Python file always has this wall-time limit, because it has no description.
inline constexpr double kExternalTimeLimit_s = 600.0;

/// An external method is a command (NAME.yaml) or a Python function (NAME.py). EXTERNAL.md describes the keys and
/// placeholders.
struct ExternalDescription {
  enum class Output { rates, tum, estimate };

  std::filesystem::path file;
  std::string name, doc, source;
  Kind kind = Kind::rate;
  Frame frame = Frame::imu;  ///< frame of the poses in a TUM file
  std::vector<std::string> robots;
  std::vector<std::string> command;  ///< empty for a Python function
  std::filesystem::path python;
  std::string function;
  std::vector<std::string> interpreter;  ///< empty: the user's Python
  std::vector<std::string> version;      ///< command that prints the program's version; may be empty
  std::map<std::string, std::string> environment;
  Output output = Output::tum;
  double time_limit_s = kExternalTimeLimit_s;
  double memory_limit_mib = 8192.0;
  std::string digest;  ///< digest of this file and of the files that the command names with {folder}
};

/// Returns the names that a command may contain in braces: "recording", "csv", "output".
std::vector<std::string> external_placeholders();

std::vector<std::string> placeholders_in(const std::string& word);

std::string filled(const std::string& word, const std::map<std::string, std::string>& values);

/// Reads NAME.yaml, or a file NAME.py with exactly one function `rate`, `attitude`, `position` or `slam`, whose name is
/// the kind of the method. Throws BadInput with file, line and reason for an unknown or missing key, an unknown kind,
/// frame or placeholder, a command without the placeholder of its output, a limit out of range, or a Python file
/// without exactly one such function.
ExternalDescription read_external(const std::filesystem::path& file);

}  // namespace tumble::scenarios
