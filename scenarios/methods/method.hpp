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
  std::vector<RateState> rates;          ///< kind rate, and the rates used by a slam method for deskewing
  std::vector<AttitudeState> attitudes;  ///< kind attitude
  std::vector<PoseState> poses;          ///< kinds position and slam, at IMU times
  /// The estimated contact mode at each pose is parallel to `poses`; empty if not estimated. The contact mode `air`
  /// means that there is no contact, or a contact with unknown motion (a bump).
  std::vector<sim::ContactLabel> contacts;
  /// An element of `uncertain` is true if the pose is in a slip event with uncertain displacement; empty if not
  /// estimated.
  std::vector<bool> uncertain;
  /// The vector `centre_B_m` is the estimated position of the sphere's centre relative to the centre of mass, in body
  /// axes [m].
  Eigen::Vector3d centre_B_m = Eigen::Vector3d::Zero();
  std::vector<LidarInertialOdometry::SweepReport> sweeps;  ///< kind slam, one per sweep
  std::vector<std::int64_t> sweep_end_ns;                  ///< parallel to `sweeps`
  std::vector<MapPoint> map;                               ///< kind slam
  SensorHealth faults;  ///< suspected faults of the sensors and of the estimate (add_finding)
  /// For each of `rates`, `suspect_rad2_s2` contains the covariance that failed health checks added; empty if no check
  /// failed (imu_check.hpp).
  std::vector<Eigen::Matrix3d> suspect_rad2_s2;
  std::map<std::string, double> health;      ///< named counters: "rejected_samples", "sweeps_rejected"
  std::map<std::string, double> parameters;  ///< parameters that the user set by name
  std::string transcript;                    ///< output of an external program; not scored
};

/// OracleInput is the additional input of a method that may use the truth: unclipped readings and the true state. The
/// program creates an OracleInput only for methods that declare `needs_truth`.
struct OracleInput {
  const sim::Truth* truth = nullptr;
  /// A slam method of the rig calls on_sweep after each lidar sweep, with the number of processed sweeps and of all
  /// sweeps, to display progress. If a method processes the recording several times, the number starts again at 1 in
  /// each pass. The function on_sweep may be empty.
  std::function<void(std::size_t done, std::size_t all)> on_sweep = {};
};

class SettingsTable;

/// Subject contains the properties of a recording that determine which methods can run on the recording.
struct Subject {
  std::string robot;  ///< "" if unknown
  bool has_lidar = true;
};

/// MethodInfo is the description of a method. No two methods have the same `kind` and `name`.
struct MethodInfo {
  std::string name;
  Kind kind = Kind::rate;
  std::string doc;                             ///< one sentence
  bool ours = false;                           ///< developed in this project
  std::string source;                          ///< paper; "ours" for methods of this project
  std::vector<const SettingsTable*> settings;  ///< settings of its stages; they define `parameters`
  std::span<const sim::Parameter> parameters;
  std::size_t parameters_first = 0;  ///< number of leading parameters that users set most often
  bool needs_truth = false;
  std::vector<std::string> robots;  ///< "rig", "sphere"; empty: all
  /// Returns why the method cannot run on the recording, for example because the recording lacks a lidar; empty if the
  /// method can run. All slam methods need a lidar.
  std::string why_not(const Subject& subject) const;
  bool applies_to(const Subject& subject) const { return why_not(subject).empty(); }
  /// The flag `baseline` is true for the baseline of a kind: the method without treatment of saturation or slip.
  /// Reports compare each other method of the same kind with the baseline, run by run. The baseline of rate methods is
  /// the clipped gyro; the baseline of slam methods is the mapping chain with the clipped gyro. A kind of method may
  /// have no baseline.
  bool baseline = false;
  /// The flag `calibrates_rig` is true if the method can start from a saved calibration of the rig and saves its new
  /// calibration (rate_tumble.hpp).
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

/// MethodPointer points to a static method of this build, or to a shared method that was read from a file.
using MethodPointer = std::shared_ptr<const Method>;

/// Returns all methods of this build, sorted by kind. Methods of one kind are in order of registration.
std::span<const Method> methods();

/// Finds methods by name: all methods called `name` ("saave"), the method of one kind ("rate/oracle"), or an external
/// method in a file NAME.yaml. Throws BadInput for an unknown name; the message suggests the nearest name. Throws
/// BadInput for an external method with the name of a built-in method.
std::vector<MethodPointer> find_methods(const std::string& name);

/// Finds the methods in a list of names, and returns each method once. Throws BadInput if two methods in the list have
/// the same kind and name.
std::vector<MethodPointer> find_methods(std::span<const std::string> names);

/// Returns a non-owning pointer to a method of this build.
MethodPointer unowned(const Method& method);

}  // namespace tumble::scenarios
