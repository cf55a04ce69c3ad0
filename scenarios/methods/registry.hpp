// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <initializer_list>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "scenarios/methods/method.hpp"
#include "tumble/common/imu.hpp"

/// How a method enters the registry. Add one: write KIND_NAME.cpp that defines `Method KIND_NAME()`, declare it here,
/// name it once in registry.cpp, and the file in CMakeLists.txt.
namespace tumble::scenarios {

/// What a method computes; `parameters` is complete and within bounds, `oracle.truth` is set when the method needs it.
using RunCore = Estimate (*)(const sim::Sensors&, const sim::Values& parameters, const OracleInput& oracle);

/// Wraps `run` with what all methods have in common: `info.parameters` are those of its settings, they are resolved,
/// truth is demanded from callers of an oracle and withheld from everybody else. The result throws BadInput on an
/// unknown or out-of-bound parameter and on missing truth.
Method make_method(MethodInfo info, RunCore run);

Method rate_raw();
Method rate_interpolate();
Method rate_reject();
Method rate_constant_jerk();
Method rate_accelerometers();
Method rate_zero_velocity();
Method rate_magnetometer();
Method rate_saave();
Method rate_tumble();
Method rate_carried();
Method rate_oracle();
Method attitude_integrate();
Method attitude_madgwick();
Method attitude_complementary();
Method attitude_mahony();
Method attitude_eskf();
Method attitude_autogain();
Method attitude_vqf();
Method attitude_tumble();
Method attitude_tumble_lag();
Method attitude_tumble_batch();
Method attitude_oracle();
Method position_double_integration();
Method position_rolling();
Method position_observer();
Method position_autogain_fusion();
Method position_tumble();
Method position_tumble_lag();
Method position_tumble_live();
Method position_oracle();
Method position_oracle_contact();
Method slam_icp();
Method slam_icp_raw();
Method slam_tumble();
Method slam_tumble_gyro_only();
Method slam_oracle();
Method slam_poses_rolling();
Method slam_poses_autogain_fusion();
Method slam_poses_tumble();
Method slam_rolling_prior();

/// Rate stages, shared by the rate methods and the slam chains. One RateState per sample; `out` is empty on trouble.
Status raw_rates(const sim::Sensors& sensors, std::span<const ImuSample> samples, std::vector<RateState>& out);
Status unclipped_rates(const sim::Sensors& sensors, const sim::Truth& truth, std::vector<RateState>& out);

/// Counters of a rate estimate: samples by source.
void count_sources(std::span<const RateState> rates, std::map<std::string, double>& health);

/// A motion known from elsewhere, one velocity per sample of the IMU along it.
struct KnownMotion {
  struct Velocity {
    Eigen::Vector3d v_WI_I_m_s = Eigen::Vector3d::Zero();
    double sigma_m_s = 0.0;
  };
  std::vector<Velocity> velocities;
  double gravity_m_s2 = 0.0;      ///< what of gravity is in the samples, which were made along the motion
  double correction_max_m = 1.0;  ///< a registration that asks for more is a wrong one
  double correction_max_rad = 1.0;
};

/// What the lidar-inertial chain estimates beside the motion.
struct SlamChain {
  /// Mounting and clock of the lidar, and gravity. The recording is run through twice: what the first run learns of the
  /// calibration is the start of the second.
  bool calibration = false;
  const KnownMotion* along = nullptr;  ///< the samples were made along it
};

struct SlamStage;

/// The lidar-inertial chain behind every registration method: given rates, deskew, register, map. Of its parameters:
/// slam_settings.hpp. Returns whether the run knows where on its map it is.
bool run_slam_chain(const sim::Sensors& sensors, std::span<const ImuSample> samples, const SlamStage& stage,
                    const SlamChain& chain, Estimate& estimate);

}  // namespace tumble::scenarios
