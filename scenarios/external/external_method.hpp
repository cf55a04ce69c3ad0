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
#include "scenarios/estimates/method.hpp"
#include "scenarios/processes/command.hpp"
#include "sim/recording.hpp"

namespace tumble::scenarios {

/// NoAnswer means that an external program gave no result: it crashed, did not start, timed out, or lacked memory or
/// disk space.
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

/// RefusedAnswer means that the result of an external program is invalid.
class RefusedAnswer : public BadInput {
 public:
  RefusedAnswer(const std::string& what, std::string transcript) : BadInput(what), transcript_(std::move(transcript)) {}
  const std::string& transcript() const { return transcript_; }

 private:
  std::string transcript_;
};

/// An external command receives the sensor data in a temporary folder, and writes its result to a file (EXTERNAL.md).
/// An external command runs in a separate process with limits of time and memory. External programs never receive the
/// true motion.
///
/// The time limit of an external method is the limit in its description or `time_limit_s`, whichever is smaller.
Method external_method(const std::filesystem::path& file,
                       double time_limit_s = std::numeric_limits<double>::infinity());

std::string without_trailing_folder(std::string text, const std::filesystem::path& folder);

std::string with_output_tail(const std::string& what, const CommandEnd& end);

template <class Work>
auto without_folder(const std::filesystem::path& scratch, Work&& work) {
  try {
    return work();
  } catch (const NoAnswer& error) {
    throw NoAnswer(error.why(), without_trailing_folder(error.what(), scratch), error.transcript());
  } catch (const BadInput& error) {
    throw BadInput(without_trailing_folder(error.what(), scratch));
  }
}

void require_done(const CommandEnd& end);

/// The version command of an external method runs for at most 30 s.
std::string reported_version(Command command, const std::string& place);

/// Describes the sensors as JSON text, which contains gravity, the sphere's radius, and the properties of each IMU and
/// lidar. The properties of an IMU are sample rate, ranges, noise densities and mounting T_BI. The properties of a
/// lidar are sweep period and mounting T_BL. The mounting of a sensor is the calibrated pose (not the true pose), as
/// "translation_m" [x, y, z] and "quaternion_xyzw".
std::string sensors_text(const sim::Sensors& sensors);

}  // namespace tumble::scenarios
