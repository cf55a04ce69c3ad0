// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "scenarios/methods/findings.hpp"
#include "sim/parameters.hpp"
#include "sim/recording.hpp"
#include "tumble/angular_velocity/rate_state.hpp"
#include "tumble/common/pose.hpp"
#include "tumble/common/status.hpp"
#include "tumble/mapping/lidar.hpp"
#include "tumble/mapping/lidar_inertial_odometry.hpp"

namespace tumble::scenarios {

enum class Kind { rate, attitude, position, slam };
const char* to_string(Kind kind);
std::string full_name(Kind kind, const std::string& method);

enum class Frame { imu, lidar, body, centre };
const char* to_string(Frame frame);

/// Each kind of method fills in the members for its kind; the other members remain empty.
struct Estimate {
  Status status;                         ///< error of the whole run, or `ok`
  Frame frame = Frame::imu;              ///< frame of `attitudes` and `poses`
  std::vector<RateState> rates;          ///< for kind rate; for kind slam, the rates used for deskewing
  std::vector<AttitudeState> attitudes;  ///< for kind attitude
  std::vector<PoseState> poses;          ///< for kinds position and slam, at IMU times
  /// Contact mode at each pose; empty if not estimated. The mode `air` means no contact, or contact with unknown motion
  /// (a bump).
  std::vector<sim::ContactLabel> contacts;
  /// True at each pose in a slip event with uncertain displacement; empty if not estimated.
  std::vector<bool> uncertain;
  /// Estimated position of the sphere's centre relative to the centre of mass, in body axes [m].
  Eigen::Vector3d centre_B_m = Eigen::Vector3d::Zero();
  std::vector<LidarInertialOdometry::SweepReport> sweeps;  ///< for kind slam, one per sweep
  std::vector<std::int64_t> sweep_end_ns;                  ///< parallel to `sweeps`
  std::vector<MapPoint> map;                               ///< for kind slam
  SensorHealth faults;  ///< suspected faults of the sensors and of the estimate (add_finding)
  /// Failed health checks added this covariance to each of `rates`; empty if no check failed (imu_check.hpp).
  std::vector<Eigen::Matrix3d> suspect_rad2_s2;
  std::map<std::string, double> health;      ///< named counters: "rejected_samples", "sweeps_rejected"
  std::map<std::string, double> parameters;  ///< parameters that the user set by name
  std::string transcript;                    ///< output of an external program; not scored
};

/// Only methods with `needs_truth` receive true state and readings before clipping.
struct OracleInput {
  const sim::Truth* truth = nullptr;
  /// A slam method of the rig calls this function after each lidar sweep, with the numbers of processed and of all
  /// sweeps. In each further pass over the recording, the count starts again at 1.
  std::function<void(std::size_t done, std::size_t all)> on_sweep = {};
};

class SettingsTable;

struct Subject {
  std::string robot;  ///< empty if unknown
  bool has_lidar = true;
};

struct MethodInfo {
  std::string name;
  Kind kind = Kind::rate;
  std::string doc;                             ///< description, in one sentence
  bool ours = false;                           ///< developed in this project
  std::string source;                          ///< paper; "ours" for methods of this project
  std::vector<const SettingsTable*> settings;  ///< settings of the method's stages, which define `parameters`
  std::span<const sim::Parameter> parameters;
  std::size_t parameters_first = 0;  ///< number of frequently used parameters, which come first in `parameters`
  bool needs_truth = false;
  std::vector<std::string> robots;  ///< "rig", "sphere"; empty: all
  std::string why_not(const Subject& subject) const;
  bool applies_to(const Subject& subject) const { return why_not(subject).empty(); }
  /// true: the method is the baseline of its kind, without treatment of saturation or slip. Reports compare every other
  /// method of the kind with the baseline, run by run.
  bool baseline = false;
  /// true: the method can start from a saved calibration of the rig, and saves its new calibration (rate_tumble.hpp).
  bool calibrates_rig = false;
  std::string version;  ///< version of a method that is not part of this build
};

std::string full_name(const MethodInfo& info);

/// Each method is deterministic: equal inputs give bit-identical results.
using RunMethod = std::function<Estimate(const sim::Sensors&, const sim::Values& parameters, const OracleInput&)>;

struct Method {
  MethodInfo info;
  RunMethod run;
};

using MethodPointer = std::shared_ptr<const Method>;

std::span<const Method> methods();

/// The name may match all methods called `name` ("saave"), one method ("rate/oracle"), or an external method
/// (NAME.yaml). Throws BadInput for an unknown name, and for an external method with the name of a built-in method.
std::vector<MethodPointer> find_methods(const std::string& name);

/// Each method is returned once. Throws BadInput if two different methods have equal kind and name.
std::vector<MethodPointer> find_methods(std::span<const std::string> names);

MethodPointer unowned(const Method& method);

}  // namespace tumble::scenarios
