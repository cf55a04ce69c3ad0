// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
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
inline constexpr std::array kKinds = {Kind::rate, Kind::attitude, Kind::position, Kind::slam};
const char* to_string(Kind kind);
std::optional<Kind> kind_named(std::string_view name);
std::string full_name(Kind kind, const std::string& method);

enum class Frame { imu, lidar, body, centre };
const char* to_string(Frame frame);

struct Estimate {
  Status status;                         ///< error of the whole run, or `ok`
  Frame frame = Frame::imu;              ///< frame of `attitudes` and `poses`
  std::vector<AngularRateState> rates;   ///< kind slam: rates used for deskewing
  std::vector<AttitudeState> attitudes;  ///< for kind attitude
  std::vector<PoseState> poses;          ///< kinds position and slam, IMU times
  /// Contact mode at each pose, or an empty vector if the method does not estimate contact modes. The contact mode
  /// `air` means no contact, or contact with unknown motion (a bump).
  std::vector<sim::ContactLabel> contacts;
  /// True for poses in a slip event with uncertain displacement, or an empty vector if the method does not estimate
  /// slip.
  std::vector<bool> uncertain;
  /// Position of the sphere's centre relative to the centre of mass, in body axes [m].
  Eigen::Vector3d centre_B_m = Eigen::Vector3d::Zero();
  std::vector<LidarInertialOdometry::SweepReport> sweeps;  ///< for kind slam, one per sweep
  std::vector<std::int64_t> sweep_end_ns;                  ///< parallel to `sweeps`
  std::vector<MapPoint> map;                               ///< for kind slam
  SensorHealth faults;                                     ///< suspected faults of sensors and estimate
  /// Part of the covariance of each of `rates` that is due to health findings; empty without a health finding.
  std::vector<Eigen::Matrix3d> suspect_rad2_s2;
  std::map<std::string, double> health;      ///< named counters: "rejected_samples", "sweeps_rejected"
  std::map<std::string, double> parameters;  ///< parameters that the user set by name
  std::string transcript;                    ///< output of an external program; not scored
};

/// Only methods with `needs_truth` receive the true state and the readings before clipping.
struct OracleInput {
  const sim::Truth* truth = nullptr;
  /// A slam method calls this function after each lidar sweep, with the numbers of processed and of all sweeps.
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
  std::string doc = {};                             ///< description, in one sentence
  bool ours = false;                                ///< developed in this project
  std::string source = {};                          ///< paper, or "ours"
  std::vector<const SettingsTable*> settings = {};  ///< settings that define `parameters`
  std::span<const sim::Parameter> parameters = {};
  std::size_t parameters_first = 0;  ///< common ones come first in `parameters`
  bool needs_truth = false;
  std::vector<std::string> robots = {};  ///< "rig", "sphere"; empty: all
  std::string why_not(const Subject& subject) const;
  bool applies_to(const Subject& subject) const { return why_not(subject).empty(); }
  /// true: the method is the reference method of its kind, without treatment of saturation or slip.
  bool baseline = false;
  /// true: the method can start from a saved calibration of the rig (lever arm, biases, inertia ratios), and saves its
  /// new calibration.
  bool calibrates_rig = false;
  std::string version = {};  ///< for external methods
};

std::string full_name(const MethodInfo& info);

/// Equal inputs must give bit-identical results.
using RunMethod = std::function<Estimate(const sim::Sensors&, const sim::Values& parameters, const OracleInput&)>;

struct Method {
  MethodInfo info;
  RunMethod run;
};

using MethodPointer = std::shared_ptr<const Method>;

std::span<const Method> methods();

/// The name may be that of several methods ("saave"), one method ("rate/oracle"), or an external method (NAME.yaml).
std::vector<MethodPointer> find_methods(const std::string& name);

std::vector<MethodPointer> find_methods(std::span<const std::string> names);

MethodPointer unowned(const Method& method);

}  // namespace tumble::scenarios
