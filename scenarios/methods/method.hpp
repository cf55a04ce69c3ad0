// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "scenarios/methods/doubts.hpp"
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
/// Returns "rate/tumble".
std::string full_name(Kind kind, const std::string& method);

/// Frame of an estimate's poses: the primary IMU, the lidar, the body, or the sphere's centre.
enum class Frame { imu, lidar, body, centre };
const char* to_string(Frame frame);

/// Result of a method. Each kind fills its own members and leaves the others empty.
struct Estimate {
  Status status;                         ///< error of the whole run, or `ok`
  Frame frame = Frame::imu;              ///< frame of `attitudes` and `poses`
  std::vector<RateState> rates;          ///< kind rate, and the rates used by a slam method for deskewing
  std::vector<AttitudeState> attitudes;  ///< kind attitude
  std::vector<PoseState> poses;          ///< kinds position and slam, at IMU times
  /// Estimated contact mode at each pose, parallel to `poses`; empty if not estimated. `air`: no contact, or a contact
  /// with unknown motion (a bump).
  std::vector<sim::ContactLabel> contacts;
  /// True for poses in an event whose displacement is uncertain, parallel to `contacts`; empty if not estimated.
  std::vector<bool> uncertain;
  /// Estimated position of the sphere's centre relative to the centre of mass, body axes [m].
  Eigen::Vector3d centre_B_m = Eigen::Vector3d::Zero();
  std::vector<LidarInertialOdometry::SweepReport> sweeps;  ///< kind slam, one per sweep
  std::vector<std::int64_t> sweep_end_ns;                  ///< parallel to `sweeps`
  std::vector<MapPoint> map;                               ///< kind slam
  std::vector<Doubt> doubts;                               ///< failed health checks (add_doubt)
  /// Covariance added to each of `rates` by failed health checks; empty if none (imu_check.hpp).
  std::vector<Eigen::Matrix3d> doubted_rad2_s2;
  std::map<std::string, double> health;      ///< named counters: "rejected_samples", "sweeps_rejected"
  std::map<std::string, double> parameters;  ///< parameters that the user set by name
  std::string transcript;                    ///< output of an external program; not scored
};

/// Extra input of an oracle: unclipped readings and true state. The harness builds it from the truth, only for methods
/// that declare `needs_truth`.
struct OracleInput {
  const sim::Truth* truth = nullptr;
};

class SettingsTable;

/// Input that is available to run a method on.
struct Subject {
  std::string robot;  ///< "" if unknown
  bool has_lidar = true;
};

/// Description of a method. The pair of `kind` and `name` is unique.
struct MethodInfo {
  std::string name;
  Kind kind = Kind::rate;
  std::string doc;                             ///< one sentence
  bool ours = false;                           ///< developed in this project
  std::string source;                          ///< paper; "ours" for methods of this project
  std::vector<const SettingsTable*> settings;  ///< settings of its stages, with distinct names; they define
                                               ///< `parameters`
  std::span<const sim::Parameter> parameters;
  std::size_t parameters_first = 0;  ///< number of leading parameters that users set most often
  bool needs_truth = false;
  std::vector<std::string> robots;  ///< "rig", "sphere"; empty: all
  /// Returns why the method does not apply ("needs a lidar, and there is none"); empty if it does. Slam methods need a
  /// lidar.
  std::string why_not(const Subject& subject) const;
  bool applies_to(const Subject& subject) const { return why_not(subject).empty(); }
  /// Reference without a treatment of the problem; other methods of its kind are compared with it in pairs. For rates:
  /// the clipped gyro; for slam: the chain with the clipped gyro. A kind may have none.
  bool baseline = false;
  /// Can start from a saved calibration of the device, and saves what it calibrates (rate_tumble.hpp).
  bool learns_rig = false;
  std::string version;  ///< version of a method that is not part of this build
};

std::string full_name(const MethodInfo& info);

/// Runs a method on a recording. Deterministic: the same input gives the same bits.
using RunMethod = std::function<Estimate(const sim::Sensors&, const sim::Values& parameters, const OracleInput&)>;

struct Method {
  MethodInfo info;
  RunMethod run;
};

/// Points to a method of this build (static), or to a shared method from a file.
using MethodPointer = std::shared_ptr<const Method>;

/// Returns all methods of this build, sorted by kind, then in order of registration.
std::span<const Method> methods();

/// Returns every method called `name` ("saave"), the method of one kind ("rate/oracle"), or the method described by a
/// file NAME.yaml (external_method.hpp). Throws BadInput for an unknown name (suggests the nearest) and for an external
/// method with the name of a built-in one.
std::vector<MethodPointer> find_methods(const std::string& name);

/// Returns the methods of a list, each once. Also throws BadInput for two methods with the same kind and name.
std::vector<MethodPointer> find_methods(std::span<const std::string> names);

/// Returns a non-owning pointer to a method of this build.
MethodPointer unowned(const Method& method);

}  // namespace tumble::scenarios
