// SPDX-License-Identifier: BSD-3-Clause
#include "tools/tumble/recording_info.hpp"

#include <fmt/format.h>

#include <string>

#include "scenarios/draw/scenario.hpp"
#include "scenarios/errors.hpp"
#include "tools/tumble/session.hpp"

namespace tumble::tools {

namespace {

constexpr double kRest_m_s = 0.05, kRest_rad_s = 0.25;

}  // namespace

scenarios::RecordingInfo recording_versions() {
  scenarios::RecordingInfo info;
  info.tumble_version = program_version();
  info.engine_version = TUMBLE_ENGINE_VERSION;
  return info;
}

scenarios::RecordingInfo recording_info(const sim::ResolvedSituation& situation, const std::string& digest) {
  scenarios::RecordingInfo info = recording_versions();
  info.scenario = situation->scenario;
  info.seed = situation->seed;
  info.situation_yaml = scenarios::to_yaml(situation);
  info.digest = digest;
  info.has_truth = true;
  return info;
}

std::string end_in_motion(const sim::Truth& truth) {
  if (truth.v_WB_m_s.empty()) return "";
  const double speed_m_s = truth.v_WB_m_s.back().norm(), rate_rad_s = truth.w_WB_B_rad_s.back().norm();
  if (speed_m_s <= kRest_m_s && rate_rad_s <= kRest_rad_s) return "";
  const double duration_s =
      1e-9 * static_cast<double>(truth.period_ns) * static_cast<double>(truth.v_WB_m_s.size() - 1);
  return fmt::format(
      "the robot still moves at the end of the recording, with {:.1f} m/s and {:.1f} rad/s after {:g} s; increase "
      "duration_s to record until the robot is at rest",
      speed_m_s, rate_rad_s, duration_s);
}

sim::BuiltSituation built_from(const scenarios::RecordingInfo& info, const std::string& place,
                               const scenarios::DataRoot& data) {
  sim::Situation situation = scenarios::situation_from_yaml(info.situation_yaml, place);
  const sim::Situation bare;
  situation.sensors.clear();
  situation.duration_s = bare.duration_s;
  situation.motion = {std::string(sim::motion_types().front().name), {}};
  try {
    return {sim::resolve(situation), data.models()};
  } catch (const sim::InvalidSituation& error) {
    throw scenarios::BadInput(place + ": " + error.what());
  }
}

}  // namespace tumble::tools
