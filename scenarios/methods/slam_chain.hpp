// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "scenarios/estimates/method.hpp"
#include "scenarios/methods/settings.hpp"
#include "tumble/common/types.hpp"
#include "tumble/mapping/lidar_inertial_odometry.hpp"
#include "tumble/mapping/types.hpp"

namespace tumble::scenarios {

struct SlamParams {
  LidarInertialOdometry::Params odometry = on_the_rig();

  static LidarInertialOdometry::Params on_the_rig();

  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit.group("", p.odometry);
  }
};

/// Sets the prior uncertainties of lidar mounting and clock offset to typical values of a hand-assembled sensor rig.
SlamParams with_calibration(SlamParams params);
/// Configures the odometry to accept a registration with few matches if the registered pose agrees with the prediction.
/// Baseline methods reject a registration with few matches, because a clipped gyro makes their prediction wrong.
SlamParams with_few_matches(SlamParams params);
Settings<SlamParams> slam_settings(const SlamParams& defaults, std::vector<std::string> fixed = {});

struct SlamStage {
  const Settings<SlamParams>& settings;
  const sim::Values& parameters;
};

Estimate begin_with_rates(const sim::Sensors& sensors, std::vector<ImuSample>& samples,
                          const std::function<Status(Estimate&)>& rates);

struct KnownMotion {
  /// Returns the motion of the IMU between two times, or nothing if the odometer does not cover both times.
  std::function<std::optional<OdometerReading>(TimeNs from_ns, TimeNs to_ns)> between;
  double correction_max_m = 1.0;  ///< larger corrections are rejected
  double correction_max_rad = 1.0;
};

struct SlamChain {
  /// If true, the recording is processed twice. The first pass estimates lidar mounting, clock offset and gravity, and
  /// the second pass starts with the estimates of the first pass.
  bool calibration = false;
  const KnownMotion* along = nullptr;  ///< odometer that measures the motion of the IMU
  std::function<void(std::size_t done, std::size_t all)> on_sweep = {};
};

/// Estimates poses and map from sweeps and angular rates. Returns true if the final pose in the map is known.
bool run_slam_chain(const sim::Sensors& sensors, std::span<const ImuSample> samples, const SlamStage& stage,
                    const SlamChain& chain, Estimate& estimate);

}  // namespace tumble::scenarios
