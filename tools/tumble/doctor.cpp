// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "scenarios/diagnosis/diagnosis.hpp"
#include "scenarios/errors.hpp"
#include "tools/tumble/chosen_method.hpp"
#include "tools/tumble/odometry_options.hpp"
#include "tools/tumble/verbs.hpp"

namespace tumble::tools {

namespace {

using scenarios::RecordingFinding;

void append_findings(std::vector<RecordingFinding> more, std::vector<RecordingFinding>& out) {
  std::move(more.begin(), more.end(), std::back_inserter(out));
}

std::vector<RecordingFinding> findings_of_method(const Session& session, const scenarios::Method& method,
                                                 const sim::Sensors& sensors) {
  const scenarios::Estimate estimate = run_method(session, method, sensors);
  const std::string name = full_name(method.info);
  std::vector<RecordingFinding> out =
      scenarios::findings_in_estimate(estimate, name, sensors.lidars.front().sweep_start_ns.size());
  if (estimate.replaced_T_BL)
    out.push_back({name, "the stated pose or clock of the lidar contradicts the recording",
                   scenarios::lidar_pose_option(*estimate.replaced_T_BL) + " (estimated from the recording)"});
  return out;
}

bool any_fault(const std::vector<RecordingFinding>& findings) {
  return std::ranges::any_of(findings, &RecordingFinding::fault);
}

/// Rotations do not reveal that all axes of the accelerometer are inverted, so the method tests this hypothesis.
bool is_accel_inverted(const Session& session, const scenarios::Method& method, sim::Sensors sensors) {
  for (sim::ImuRecord& imu : sensors.imus) {
    for (Eigen::Vector3d& force_m_s2 : imu.accel_m_s2) force_m_s2 = -force_m_s2;
  }
  return !any_fault(findings_of_method(session, method, sensors));
}

/// @param out  Findings in the readings. The findings of the odometry are appended.
void append_findings_of_odometry(const Session& session, const OdometryOptions& options, OpenRecording& recording,
                                 std::vector<RecordingFinding>& out) {
  const sim::Sensors& sensors = recording.content.sensors;
  const OdometrySetup setup = set_up_odometry(session, options, recording);
  std::vector<RecordingFinding> consequences = findings_of_method(session, setup.method, sensors);
  if (!any_fault(out) && any_fault(consequences) && is_accel_inverted(session, setup.method, sensors))
    out.push_back({sensors.imus.front().name,
                   fmt::format("the accelerometer seems to be inverted: with the opposite sign of all its axes, the "
                               "faults that '{}' finds disappear",
                               full_name(setup.method.info)),
                   "invert the accelerometer in the IMU's driver; at rest, the axis that points up must read +9.8 "
                   "m/s^2"});
  if (any_fault(out)) {
    for (RecordingFinding& each : consequences)
      each.repair = "first repair the faults above, because they may cause this finding";
  }
  append_findings(std::move(consequences), out);
}

std::vector<RecordingFinding> findings_of(const Session& session, const OdometryOptions& options,
                                          OpenRecording& recording) {
  std::vector<RecordingFinding> out;
  for (const Repair& repair : recording.repairs)
    out.push_back(
        {recording.options.path.filename().string(), repair.cause, repair.option.name + " " + repair.option.value});
  append_findings(scenarios::findings_in_notes(recording.content.notes), out);
  for (RecordingFinding& each : out) {
    if (each.where.empty()) each.where = recording.options.path.filename().string();
  }
  const sim::Sensors& sensors = recording.content.sensors;
  append_findings(scenarios::findings_in_readings(sensors, recording.content.cloud_fields), out);
  for (const auto& [missing, name] : {std::pair{sensors.imus.empty(), "IMU"}, {sensors.lidars.empty(), "lidar"}}) {
    if (missing)
      out.push_back(
          {recording.options.path.filename().string(), fmt::format("the recording has no {}", name), "", false});
  }
  const bool rolls = sensors.robot == "sphere" || sensors.robot == "pendulum";
  if (sensors.imus.empty() || sensors.lidars.empty() || rolls) return out;
  append_findings_of_odometry(session, options, recording, out);
  return out;
}

int run_doctor(const Session& session, const OdometryOptions& options) {
  const ImportOptions& input = options.input;
  check_odometry_options(options);
  (void)format_of(input);
  (void)bag_reading(session, input);
  std::vector<RecordingFinding> findings;
  std::optional<OpenRecording> recording;
  try {
    recording = open_recording(session, input);
  } catch (const scenarios::WrongOption&) {
    throw;
  } catch (const scenarios::BadInput& error) {
    if (!std::filesystem::exists(input.path)) throw;
    findings.push_back({input.path.filename().string(), error.what(), scenarios::recommended_option(error.what())});
  }
  if (recording) findings = findings_of(session, options, *recording);
  Table table("", {"where", "finding"});
  table.wrap_last();
  nlohmann::json document = nlohmann::json::array();
  for (const RecordingFinding& each : findings) {
    table.add_row({each.where, (each.fault ? "" : "note: ") + each.evidence +
                                   (each.repair.empty() ? "" : ". Repair: " + each.repair)});
    document.push_back(
        {{"where", each.where}, {"evidence", each.evidence}, {"repair", each.repair}, {"fault", each.fault}});
  }
  if (!any_fault(findings)) table.add_row({input.path.filename().string(), "no fault found"});
  session.print({table}, {{"findings", document}});
  return any_fault(findings) ? kCheckFailed : kDone;
}

}  // namespace

Action declare_doctor(VerbOptions& verb, const Session& session) {
  auto options = std::make_shared<OdometryOptions>();
  declare_odometry_options(verb, *options);
  verb.footer(
      "Exit status: 0 no fault found, 1 at least one fault, 2 wrong use. Notes, for example on saturation, are not "
      "faults.");
  return [&session, options] { return run_doctor(session, *options); };
}

}  // namespace tumble::tools
