// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "scenarios/methods/method.hpp"

namespace tumble::scenarios {

/// A method that is somebody else's command or function of Python, as a file NAME.yaml states it, or that function's
/// own file. Keys and placeholders: EXTERNAL.md.
struct ExternalDescription {
  enum class Output { rates, tum, estimate };

  std::filesystem::path file;
  std::string name, doc, source;
  Kind kind = Kind::rate;
  Frame frame = Frame::imu;  ///< of the poses in a TUM file
  std::vector<std::string> robots;
  std::vector<std::string> command;      ///< empty where it is a function of Python
  std::filesystem::path python;          ///< the file of that function
  std::string function;                  ///< its name
  std::vector<std::string> interpreter;  ///< that calls it; empty: the user's own Python
  std::vector<std::string> version;      ///< command that prints the program's version; may be empty
  std::map<std::string, std::string> environment;
  Output output = Output::tum;
  double time_limit_s = 600.0;
  double memory_limit_mib = 8192.0;
  std::string digest;  ///< of the file's text, and of the files beside it that a command names by {folder}
};

/// What a command may name in braces, and what then stands there: "recording", "csv", "output".
std::vector<std::string> external_placeholders();

/// The placeholders that a word of a command names, in order. Throws BadInput on an unknown one, nearest named.
std::vector<std::string> placeholders_in(const std::string& word);

/// The word with every placeholder replaced.
std::string filled(const std::string& word, const std::map<std::string, std::string>& values);

/// Of a NAME.yaml, or of a NAME.py that defines one function `rate`, `attitude`, `position` or `slam` and is a method
/// of its own name and that kind. Throws BadInput with file, line and reason: an unknown or missing key, an unknown
/// kind, frame or placeholder, a command that never names its output, a limit out of bounds, no such function or
/// several.
ExternalDescription read_external(const std::filesystem::path& file);

}  // namespace tumble::scenarios
