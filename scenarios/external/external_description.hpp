// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "scenarios/estimates/method.hpp"

namespace tumble::scenarios {

/// Limit of the wall time of an external method whose description states no limit; a description in Python cannot state
/// a time limit.
inline constexpr double kExternalTimeLimit_s = 600.0;

/// An external method is a command (NAME.yaml) or a Python function (NAME.py).
struct ExternalDescription {
  enum class Output { rates, tum, estimate };

  std::filesystem::path file;
  std::string name, doc, source;
  Kind kind = Kind::rate;
  Frame frame = Frame::imu;  ///< frame of the poses in a TUM file
  std::vector<std::string> robots;
  std::vector<std::string> command;
  std::filesystem::path python;
  std::string function;
  std::vector<std::string> interpreter;  ///< empty: the user's Python
  std::vector<std::string> version;      ///< command that prints the program's version; may be empty
  std::map<std::string, std::string> environment;
  Output output = Output::tum;
  double time_limit_s = kExternalTimeLimit_s;
  double memory_limit_mib = 8192.0;
  std::string digest;  ///< of the description and named files
};

std::vector<std::string> external_placeholders();

std::vector<std::string> placeholders_in(const std::string& word);

std::string filled(const std::string& word, const std::map<std::string, std::string>& values);

ExternalDescription read_external(const std::filesystem::path& file);

}  // namespace tumble::scenarios
