// SPDX-License-Identifier: BSD-3-Clause
#include "tools/tumble/given_estimate.hpp"

#include <fmt/format.h>

#include <vector>

#include "scenarios/errors.hpp"
#include "scenarios/estimates/estimate_clock.hpp"
#include "scenarios/estimates/estimate_file.hpp"
#include "scenarios/recordings/recording_file.hpp"
#include "tools/tumble/arguments.hpp"

namespace tumble::tools {

scenarios::Frame frame_of(const std::string& name, bool has_imu) {
  using scenarios::Frame;
  if (name.empty()) return has_imu ? Frame::imu : Frame::body;
  std::vector<std::string> known;
  for (const Frame frame : {Frame::imu, Frame::lidar, Frame::body, Frame::centre}) {
    if (name == to_string(frame)) return frame;
    known.emplace_back(to_string(frame));
  }
  require_known("frame", name, known);
  return Frame::imu;
}

namespace {

void require_own(const std::filesystem::path& estimate, const std::filesystem::path& recording,
                 const sim::Sensors& sensors) {
  const std::string made_from = scenarios::estimated_sensors(estimate);
  const std::string own = scenarios::digest(sensors, nullptr);
  if (made_from.empty() || made_from == own) return;
  throw scenarios::BadInput(
      fmt::format("{0}: this estimate belongs to another recording. The estimate was made from sensor data with digest "
                  "{1}, but {2} has sensor data with digest {3}. Give the recording of the estimate. For an estimate "
                  "from an export of {2}, score only the poses: tumble score --kind slam {0}/trajectory.tum {2}",
                  estimate.string(), made_from, recording.string(), own));
}

scenarios::StampSpan span_of(const sim::Sensors& sensors, const sim::Truth* truth) {
  if (truth == nullptr) return scenarios::span_of(sensors);
  return {0, truth->period_ns * (static_cast<std::int64_t>(truth->q_WB.size()) - 1)};
}

}  // namespace

scenarios::Estimate read_given(const GivenEstimate& given, const sim::Sensors& sensors, const sim::Truth* truth,
                               scenarios::Kind& kind, std::string& method) {
  require_own(given.path, given.recording, sensors);
  scenarios::Estimate estimate = scenarios::read_estimate(given.path, kind, method, given.tum_frame);
  scenarios::move_to_clock(scenarios::read_info(given.recording).origin_ns, span_of(sensors, truth), estimate);
  return estimate;
}

}  // namespace tumble::tools
