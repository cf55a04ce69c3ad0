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
/// Returns the kind and the name of a method as one text, for example "rate/tumble".
std::string full_name(Kind kind, const std::string& method);

/// Frame is the frame of an estimate's poses: the primary IMU, the lidar, the body, or the sphere's centre.
enum class Frame { imu, lidar, body, centre };
const char* to_string(Frame frame);

/// Estimate is the result of a method. Each kind of method fills in the members for its kind; the other members remain
/// empty.
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
  /// Covariance that failed health checks added to each of `rates`; empty if no check failed (imu_check.hpp).
  std::vector<Eigen::Matrix3d> suspect_rad2_s2;
  std::map<std::string, double> health;      ///< named counters: "rejected_samples", "sweeps_rejected"
  std::map<std::string, double> parameters;  ///< parameters that the user set by name
  std::string transcript;                    ///< output of an external program; not scored
};

/// OracleInput is the additional input of a method that uses the truth: true state and readings before clipping. Only
/// methods with `needs_truth` receive it.
struct OracleInput {
  const sim::Truth* truth = nullptr;
  /// A slam method of the rig calls on_sweep after each lidar sweep, with the numbers of processed and of all sweeps,
  /// to display progress. In each further pass over the recording, the count starts again at 1. on_sweep may be empty.
  std::function<void(std::size_t done, std::size_t all)> on_sweep = {};
};

class SettingsTable;

/// Subject contains the properties of a recording that determine which methods can process it.
struct Subject {
  std::string robot;  ///< "" if unknown
  bool has_lidar = true;
};

/// MethodInfo describes a method. The pair of `kind` and `name` is unique.
struct MethodInfo {
  std::string name;
  Kind kind = Kind::rate;
  std::string doc;                             ///< description, in one sentence
  bool ours = false;                           ///< developed in this project
  std::string source;                          ///< paper; "ours" for methods of this project
  std::vector<const SettingsTable*> settings;  ///< settings of the stages of the method, which define `parameters`
  std::span<const sim::Parameter> parameters;
  std::size_t parameters_first = 0;  ///< number of frequently used parameters, which come first in `parameters`
  bool needs_truth = false;
  std::vector<std::string> robots;  ///< "rig", "sphere"; empty: all
  /// Returns why the method cannot process the recording, for example because a slam method needs a lidar; empty if it
  /// can.
  std::string why_not(const Subject& subject) const;
  bool applies_to(const Subject& subject) const { return why_not(subject).empty(); }
  /// true: the method is the baseline of its kind, without treatment of saturation or slip. Reports compare every other
  /// method of the kind with the baseline, run by run. The baseline of rate methods is the clipped gyro. The baseline
  /// of slam methods is the mapping chain with the clipped gyro. A kind may have no baseline.
  bool baseline = false;
  /// true: the method can start from a saved calibration of the rig, and saves its new calibration (rate_tumble.hpp).
  bool calibrates_rig = false;
  std::string version;  ///< version of a method that is not part of this build
};

std::string full_name(const MethodInfo& info);

/// RunMethod is the function that runs a method on a recording. Each method is deterministic: equal inputs give
/// bit-identical results.
using RunMethod = std::function<Estimate(const sim::Sensors&, const sim::Values& parameters, const OracleInput&)>;

struct Method {
  MethodInfo info;
  RunMethod run;
};

/// MethodPointer points to a static method of this build, or owns a method that was read from a file.
using MethodPointer = std::shared_ptr<const Method>;

/// Returns all methods of this build, sorted by kind. Methods of one kind are in order of registration.
std::span<const Method> methods();

/// Finds methods by name: all methods called `name` ("saave"), one method ("rate/oracle"), or an external method
/// (NAME.yaml). Throws BadInput for an unknown name (the message suggests the nearest name), and for an external method
/// with the name of a built-in method.
std::vector<MethodPointer> find_methods(const std::string& name);

/// Returns the methods in a list of names, each once. Throws BadInput if two different methods have equal kind and
/// name.
std::vector<MethodPointer> find_methods(std::span<const std::string> names);

/// Returns a non-owning pointer to a method of this build.
MethodPointer unowned(const Method& method);

}  // namespace tumble::scenarios
