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

/// A new method needs a file KIND_NAME.cpp that defines `Method KIND_NAME()`, a declaration in this header, a line in
/// registry.cpp, and a line in CMakeLists.txt.
namespace tumble::scenarios {

using RunCore = Estimate (*)(const sim::Sensors&, const sim::Values& parameters, const OracleInput& oracle);

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

Status raw_rates(const sim::Sensors& sensors, std::span<const ImuSample> samples, std::vector<AngularRateState>& out);
Status unclipped_rates(const sim::Sensors& sensors, const sim::Truth& truth, std::vector<AngularRateState>& out);

void count_sources(std::span<const AngularRateState> rates, std::map<std::string, double>& health);

struct KnownMotion {
  /// Motion of the IMU between two times, or nothing if the odometer does not cover both times.
  std::function<std::optional<OdometerReading>(TimeNs from_ns, TimeNs to_ns)> between;
  double correction_max_m = 1.0;  ///< larger corrections are rejected
  double correction_max_rad = 1.0;
};

struct SlamChain {
  /// true: a first pass over the recording estimates lidar mounting, clock offset and gravity, and a second pass starts
  /// with this calibration.
  bool calibration = false;
  const KnownMotion* along = nullptr;  ///< odometer
  std::function<void(std::size_t done, std::size_t all)> on_sweep = {};
};

struct SlamStage;

/// Returns true if the run ends with a known pose in its map.
bool run_slam_chain(const sim::Sensors& sensors, std::span<const ImuSample> samples, const SlamStage& stage,
                    const SlamChain& chain, Estimate& estimate);

}  // namespace tumble::scenarios
