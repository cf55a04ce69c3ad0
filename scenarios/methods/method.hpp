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
/// Returns the kind and the name of a method, for example "rate/tumble".
std::string full_name(Kind kind, const std::string& method);

/// Frame of an estimate's poses: the primary IMU, the lidar, the body, or the sphere's centre.
enum class Frame { imu, lidar, body, centre };
const char* to_string(Frame frame);

/// Estimate is the result of a method. Each kind of method fills in the members for its kind and leaves the others
/// empty.
struct Estimate {
  Status status;                         ///< error of the whole run, or `ok`
  Frame frame = Frame::imu;              ///< frame of `attitudes` and `poses`
  std::vector<RateState> rates;          ///< kind rate, and the rates used by a slam method for deskewing
  std::vector<AttitudeState> attitudes;  ///< kind attitude
  std::vector<PoseState> poses;          ///< kinds position and slam, at IMU times
  /// Estimated contact mode at each pose, parallel to `poses`; empty if not estimated. `air` means that there is no
  /// contact, or a contact with unknown motion (a bump).
  std::vector<sim::ContactLabel> contacts;
  /// True for a pose in a slip event whose displacement is uncertain; parallel to `poses`, and empty if not estimated.
  std::vector<bool> uncertain;
  /// Estimated position of the sphere's centre relative to the centre of mass, in body axes [m].
  Eigen::Vector3d centre_B_m = Eigen::Vector3d::Zero();
  std::vector<LidarInertialOdometry::SweepReport> sweeps;  ///< kind slam, one per sweep
  std::vector<std::int64_t> sweep_end_ns;                  ///< parallel to `sweeps`
  std::vector<MapPoint> map;                               ///< kind slam
  SensorHealth faults;  ///< suspected faults of the sensors and of the estimate (add_finding)
  /// Covariance that failed health checks add to each of `rates`; empty if no check failed (imu_check.hpp).
  std::vector<Eigen::Matrix3d> suspect_rad2_s2;
  std::map<std::string, double> health;      ///< named counters: "rejected_samples", "sweeps_rejected"
  std::map<std::string, double> parameters;  ///< parameters that the user set by name
  std::string transcript;                    ///< output of an external program; not scored
};

/// OracleInput is the additional input of an oracle method: unclipped readings and the true state. The program creates
/// this input from the truth, and only for methods that declare `needs_truth`.
struct OracleInput {
  const sim::Truth* truth = nullptr;
  /// The slam methods of the rig call this function after each lidar sweep, with the number of processed sweeps and of
  /// all sweeps, for display. A method with several passes starts again at 1. The function may be empty.
  std::function<void(std::size_t done, std::size_t all)> on_sweep = {};
};

class SettingsTable;

/// Subject contains the properties of a recording that determine which methods can run on it.
struct Subject {
  std::string robot;  ///< "" if unknown
  bool has_lidar = true;
};

/// MethodInfo is the description of a method. The pair of `kind` and `name` is unique.
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
  /// Returns why the method cannot run on the recording, for example because the recording lacks a lidar; empty if it
  /// can run. All slam methods need a lidar.
  std::string why_not(const Subject& subject) const;
  bool applies_to(const Subject& subject) const { return why_not(subject).empty(); }
  /// Whether the method is the baseline of its kind, which does not treat saturation or slip. Reports compare all other
  /// methods of the kind with the baseline in pairs. The baseline of rate methods is the clipped gyro; the baseline of
  /// slam methods is the chain with the clipped gyro. A kind of method may have no baseline.
  bool baseline = false;
  /// True if the method can start from a saved calibration of the device and saves the calibration that it estimates
  /// (rate_tumble.hpp).
  bool calibrates_rig = false;
  std::string version;  ///< version of a method that is not part of this build
};

std::string full_name(const MethodInfo& info);

/// Runs a method on a recording. A method is deterministic: equal inputs give bit-identical results.
using RunMethod = std::function<Estimate(const sim::Sensors&, const sim::Values& parameters, const OracleInput&)>;

struct Method {
  MethodInfo info;
  RunMethod run;
};

/// MethodPointer points to a static method of this build, or to a shared method that was read from a file.
using MethodPointer = std::shared_ptr<const Method>;

/// Returns all methods of this build, sorted by kind. Methods of one kind are in order of registration.
std::span<const Method> methods();

/// Returns every method called `name` ("saave"), the method of one kind ("rate/oracle"), or the method described by a
/// file NAME.yaml (external_method.hpp). Throws BadInput for an unknown name; the message suggests the nearest name.
/// Throws BadInput also for an external method with the name of a built-in method.
std::vector<MethodPointer> find_methods(const std::string& name);

/// Returns the methods in a list of names, each method once. Throws BadInput also if two methods have equal kind and
/// name.
std::vector<MethodPointer> find_methods(std::span<const std::string> names);

/// Returns a non-owning pointer to a method of this build.
MethodPointer unowned(const Method& method);

}  // namespace tumble::scenarios
