// SPDX-License-Identifier: BSD-3-Clause
#include "tools/tumble/learnt_file.hpp"

#include <fmt/format.h>

#include <utility>

#include "scenarios/errors.hpp"
#include "scenarios/methods/bridge.hpp"
#include "scenarios/methods/registry.hpp"
#include "scenarios/recordings/replace_file.hpp"
#include "scenarios/regular_file.hpp"

namespace tumble::tools {

LearntFile::LearntFile(std::filesystem::path path) : path_(std::move(path)) {
  if (path_.empty() || !std::filesystem::exists(path_)) return;
  scenarios::require_regular_file(path_);
  learning_.given = scenarios::read_rig_calibration(path_);
}

void LearntFile::require_place() const {
  if (!path_.empty()) const scenarios::OutputFile tried(path_);
}

std::string LearntFile::caution(const sim::Sensors& sensors) const {
  constexpr double kLeverArmOff_m = 0.1;  // above mounting errors
  if (!learning_.given || sensors.imus.empty()) return "";
  const Eigen::Vector3d stated = scenarios::bridge::lever_arm_I_m(sensors.imus.front());
  if (stated.isZero(0.0)) return "";  // the recording contains no lever arm
  const double off_m = (learning_.given->calibration.constants.lever_arm_m - stated).norm();
  if (off_m <= kLeverArmOff_m) return "";
  return fmt::format(
      "caution: the lever arm in {} differs by {:.2g} m from the lever arm of the recording, so the file may belong to "
      "another rig. Estimated rates beyond saturation depend on the lever arm",
      path_.string(), off_m);
}

std::string LearntFile::learning_methods() {
  std::string names;
  for (const scenarios::Method& method : scenarios::methods()) {
    if (method.info.calibrates_rig) names += (names.empty() ? "'" : ", '") + full_name(method.info) + "'";
  }
  return names;
}

scenarios::Method LearntFile::wrap(const scenarios::Method& method) {
  return path_.empty() || !method.info.calibrates_rig ? method : scenarios::calibrating_method(method, learning_);
}

void LearntFile::keep(const Session& session) const {
  if (path_.empty()) return;
  if (learning_.found() != nullptr) return scenarios::write_rig_calibration(path_, *learning_.found());
  session.note(fmt::format(
      "{}: the file {}, because the run produced no calibration of the rig. Possible reasons: the run failed, the "
      "file belongs to another rig, or the motion had little free flight and no gyro saturation",
      path_.string(), std::filesystem::exists(path_) ? "is unchanged" : "was not written"));
}

}  // namespace tumble::tools
