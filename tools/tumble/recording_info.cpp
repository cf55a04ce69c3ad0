// SPDX-License-Identifier: BSD-3-Clause
#include "tools/tumble/recording_info.hpp"

#include <string>

#include "scenarios/draw/scenario.hpp"
#include "scenarios/errors.hpp"
#include "tools/tumble/session.hpp"

namespace tumble::tools {

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

sim::BuiltSituation built_from(const scenarios::RecordingInfo& info, const std::string& place,
                               const scenarios::DataRoot& data) {
  sim::Situation situation = scenarios::situation_from_yaml(info.situation_yaml, place);
  // the world and the robot are all that is asked for: what this build does not know of the rest is no reason to refuse
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
