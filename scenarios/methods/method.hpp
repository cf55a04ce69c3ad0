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
/// "rate/tumble".
std::string full_name(Kind kind, const std::string& method);

/// Frame that an estimate's poses belong to: the primary IMU, the lidar, the body, or the sphere's centre.
enum class Frame { imu, lidar, body, centre };
const char* to_string(Frame frame);

/// What a method returns. A kind fills what it is about and leaves the rest empty.
struct Estimate {
  Status status;                         ///< trouble of the run as a whole; `ok` when it went through
  Frame frame = Frame::imu;              ///< of `attitudes` and `poses`
  std::vector<RateState> rates;          ///< kind rate (and what a slam method deskewed with)
  std::vector<AttitudeState> attitudes;  ///< kind attitude
  std::vector<PoseState> poses;          ///< kinds position and slam, at IMU times
  /// What the method says of the contact at each pose, parallel to `poses`; empty when it says nothing. `air`: no
  /// contact, or one whose motion it does not know (a bump).
  std::vector<sim::ContactLabel> contacts;
  /// Whether each pose lies in an event whose way the method calls uncertain, parallel to `contacts`; empty when it
  /// does not say.
  std::vector<bool> uncertain;
  /// The sphere's centre from the centre of mass, in body axes [m], by what a position method has learnt of it.
  Eigen::Vector3d centre_B_m = Eigen::Vector3d::Zero();
  std::vector<LidarInertialOdometry::SweepReport> sweeps;  ///< kind slam, one per sweep
  std::vector<std::int64_t> sweep_end_ns;                  ///< parallel to `sweeps`
  std::vector<MapPoint> map;                               ///< kind slam
  std::vector<Doubt> doubts;                               ///< what it says against itself (add_doubt)
  /// What a doubt has added to the covariance of each of `rates`; empty: nothing (imu_check.hpp).
  std::vector<Eigen::Matrix3d> doubted_rad2_s2;
  std::map<std::string, double> health;      ///< named counters: "rejected_samples", "sweeps_rejected"
  std::map<std::string, double> parameters;  ///< those of the method that somebody gave by name
  std::string transcript;                    ///< what somebody else's program said; of no score
};

/// What an oracle is given beyond the sensors: the unclipped readings and the true state. Built from the truth by the
/// harness, for methods that declare `needs_truth` alone.
struct OracleInput {
  const sim::Truth* truth = nullptr;
};

class SettingsTable;

/// What there is to run a method on.
struct Subject {
  std::string robot;  ///< "" when unknown
  bool has_lidar = true;
};

/// A method under test, self-describing. `kind` and `name` together are unique.
struct MethodInfo {
  std::string name;
  Kind kind = Kind::rate;
  std::string doc;                             ///< one sentence: what it is
  bool ours = false;                           ///< made here, for this project
  std::string source;                          ///< paper; of one of ours "ours"
  std::vector<const SettingsTable*> settings;  ///< of its stages, whose names differ; what `parameters` are made of
  std::span<const sim::Parameter> parameters;
  std::size_t parameters_first = 0;  ///< so many of them, the first, are what a user sets before others
  bool needs_truth = false;
  std::vector<std::string> robots;  ///< "rig", "sphere"; empty: all
  /// Why it does not apply ("needs a lidar, and there is none"); empty where it does. Maps are made with a lidar alone.
  std::string why_not(const Subject& subject) const;
  bool applies_to(const Subject& subject) const { return why_not(subject).empty(); }
  /// Does nothing about the problem, so that the others of its kind are paired with it: of rates the clipped gyro as it
  /// is, of slam the chain on top of it. A kind may have none.
  bool baseline = false;
  /// Can begin from what an earlier run has learnt of the device, and tells what it has learnt (rate_tumble.hpp).
  bool learns_rig = false;
  std::string version;  ///< of a method that is not of this build: what tells it from another of its name
};

std::string full_name(const MethodInfo& info);

/// Runs a method over a recording. Pure: the same input gives the same bits.
using RunMethod = std::function<Estimate(const sim::Sensors&, const sim::Values& parameters, const OracleInput&)>;

struct Method {
  MethodInfo info;
  RunMethod run;
};

/// Of this build, for as long as the program runs, or of a file, shared.
using MethodPointer = std::shared_ptr<const Method>;

/// All methods of this build, sorted by kind, then in order of registration.
std::span<const Method> methods();

/// Every method called `name` ("saave"), or the one of a kind ("rate/oracle"), or the one that a file NAME.yaml
/// describes (external_method.hpp). Throws BadInput naming the nearest, and for a file's method that bears the name of
/// one of ours.
std::vector<MethodPointer> find_methods(const std::string& name);

/// The same for a list, each method once. Throws BadInput also for two methods of one kind and name.
std::vector<MethodPointer> find_methods(std::span<const std::string> names);

/// A method of this build, which nobody need own.
MethodPointer unowned(const Method& method);

}  // namespace tumble::scenarios
