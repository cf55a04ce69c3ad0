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
#include "tumble/mapping/further_readings.hpp"

/// registry.hpp declares all methods of this build. A new method needs a file KIND_NAME.cpp that defines `Method
/// KIND_NAME()`, a declaration here, a line in registry.cpp, and a line in CMakeLists.txt.
namespace tumble::scenarios {

/// RunCore is the function that computes the estimate of a method. `parameters` contains every parameter, within its
/// limits. `oracle.truth` is set if the method needs the truth.
using RunCore = Estimate (*)(const sim::Sensors&, const sim::Values& parameters, const OracleInput& oracle);

/// Creates a method from its description and its function `run`. When the method runs, missing parameters get their
/// defaults. `run` receives the truth only if the method needs it. Running the method throws BadInput for an unknown
/// parameter, a value out of range, or a missing truth.
Method make_method(MethodInfo info, RunCore run);

Method rate_raw();
Method rate_interpolate();
Method rate_saave();
Method rate_tumble();
Method rate_oracle();
Method attitude_integrate();
Method attitude_madgwick();
Method attitude_complementary();
Method attitude_autogain();
Method attitude_vqf();
Method attitude_tumble();
Method attitude_tumble_lag();
Method attitude_tumble_batch();
Method position_rolling();
Method position_autogain_fusion();
Method position_tumble();
Method position_tumble_lag();
Method position_tumble_live();
Method position_oracle();
Method slam_icp();
Method slam_icp_raw();
Method slam_tumble();
Method slam_oracle();
Method slam_poses_rolling();
Method slam_poses_autogain_fusion();
Method slam_poses_tumble();
Method slam_rolling_prior();

/// Rate methods and slam methods share these rate stages, which estimate one RateState per sample. On error, `out` is
/// empty.
Status raw_rates(const sim::Sensors& sensors, std::span<const ImuSample> samples, std::vector<RateState>& out);
Status unclipped_rates(const sim::Sensors& sensors, const sim::Truth& truth, std::vector<RateState>& out);

/// Adds to `health` how many rates come from each source, for example measured or estimated.
void count_sources(std::span<const RateState> rates, std::map<std::string, double>& health);

/// KnownMotion is the motion of the IMU according to an odometer.
struct KnownMotion {
  /// Returns the motion of the IMU between two times; empty if the odometer does not cover both times.
  std::function<std::optional<OdometerReading>(TimeNs from_ns, TimeNs to_ns)> between;
  double correction_max_m = 1.0;  ///< registrations with a larger correction are rejected
  double correction_max_rad = 1.0;
};

/// SlamChain contains the options of the lidar-inertial mapping chain.
struct SlamChain {
  /// true: the mapping chain estimates lidar mounting, lidar clock offset and gravity in a first pass over the
  /// recording. A second pass starts with this calibration.
  bool calibration = false;
  const KnownMotion* along = nullptr;  ///< odometer
  /// OracleInput::on_sweep, which displays progress.
  std::function<void(std::size_t done, std::size_t all)> on_sweep = {};
};

struct SlamStage;

/// Runs the lidar-inertial mapping chain of all registration methods: deskewing with the rates in the estimate,
/// registration, mapping. slam_settings.hpp describes the parameters. Returns true if the run ends with a known pose in
/// its map.
bool run_slam_chain(const sim::Sensors& sensors, std::span<const ImuSample> samples, const SlamStage& stage,
                    const SlamChain& chain, Estimate& estimate);

}  // namespace tumble::scenarios
