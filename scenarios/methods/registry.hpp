// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <initializer_list>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "scenarios/methods/method.hpp"
#include "tumble/common/imu.hpp"
#include "tumble/mapping/detail/odometer_reading.hpp"

/// registry.hpp registers the methods. A new method needs a file KIND_NAME.cpp that defines `Method KIND_NAME()`, a
/// declaration in this file, a line in registry.cpp, and the file's name in CMakeLists.txt.
namespace tumble::scenarios {

/// Computes the estimate of a method. `parameters` is complete and within limits. `oracle.truth` is set if the method
/// needs the truth.
using RunCore = Estimate (*)(const sim::Sensors&, const sim::Values& parameters, const OracleInput& oracle);

/// Creates a method from `run`. The function collects `info.parameters` from the settings of the stages, resolves
/// parameter values, and passes the truth only to oracles. Running the method throws BadInput for an unknown parameter,
/// a value out of range, or a missing truth.
Method make_method(MethodInfo info, RunCore run);

Method rate_raw();
Method rate_interpolate();
Method rate_reject();
Method rate_constant_jerk();
Method rate_accelerometers();
Method rate_zero_velocity();
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
Method slam_oracle();
Method slam_poses_rolling();
Method slam_poses_autogain_fusion();
Method slam_poses_tumble();
Method slam_rolling_prior();

/// The rate methods and the slam chains share the following rate stages. Each rate stage returns one RateState per
/// sample. On error, `out` is empty.
Status raw_rates(const sim::Sensors& sensors, std::span<const ImuSample> samples, std::vector<RateState>& out);
Status unclipped_rates(const sim::Sensors& sensors, const sim::Truth& truth, std::vector<RateState>& out);

/// Counts the rates in `health` by their source, for example measured or estimated.
void count_sources(std::span<const RateState> rates, std::map<std::string, double>& health);

/// KnownMotion is the motion that an odometer measures in addition to the IMU.
struct KnownMotion {
  /// Returns the motion of the IMU between two times, or nothing unless the odometer covers both times.
  std::function<std::optional<OdometerReading>(TimeNs from_ns, TimeNs to_ns)> between;
  double correction_max_m = 1.0;  ///< registrations with a larger correction are rejected
  double correction_max_rad = 1.0;
};

/// SlamChain contains the options of the lidar-inertial chain.
struct SlamChain {
  /// If true, the chain estimates lidar mounting, lidar clock offset and gravity. With calibration, the chain processes
  /// the recording twice. The second pass over the recording starts from the calibration of the first pass.
  bool calibration = false;
  const KnownMotion* along = nullptr;  ///< odometer
  /// OracleInput::on_sweep
  std::function<void(std::size_t done, std::size_t all)> on_sweep = {};
};

struct SlamStage;

/// Runs the lidar-inertial chain of all registration methods: deskewing with the rates in the estimate, registration,
/// mapping. slam_settings.hpp describes the parameters. Returns whether the run ends with a known pose in its map.
bool run_slam_chain(const sim::Sensors& sensors, std::span<const ImuSample> samples, const SlamStage& stage,
                    const SlamChain& chain, Estimate& estimate);

}  // namespace tumble::scenarios
