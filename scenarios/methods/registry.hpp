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

/// The header registry.hpp declares all methods of this build. A new method needs a file KIND_NAME.cpp that defines
/// `Method KIND_NAME()`, a declaration in this file, a line in registry.cpp, and the file's name in CMakeLists.txt.
namespace tumble::scenarios {

/// RunCore is the function that computes the estimate of a method. The values in `parameters` are complete and within
/// their limits. The pointer `oracle.truth` is set if the method needs the truth.
using RunCore = Estimate (*)(const sim::Sensors&, const sim::Values& parameters, const OracleInput& oracle);

/// Creates a method from its description and its function `run`. When the method runs, missing parameters get their
/// defaults, and `run` receives the truth only if the method needs the truth. Running the method throws BadInput for an
/// unknown parameter, a value out of range, or a missing truth.
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

/// The rate methods and the slam methods share the following rate stages. Each rate stage estimates one RateState per
/// sample. On error, a rate stage returns an empty `out`.
Status raw_rates(const sim::Sensors& sensors, std::span<const ImuSample> samples, std::vector<RateState>& out);
Status unclipped_rates(const sim::Sensors& sensors, const sim::Truth& truth, std::vector<RateState>& out);

/// Counts the rates by their source, for example measured or estimated, and adds the counts to `health`.
void count_sources(std::span<const RateState> rates, std::map<std::string, double>& health);

/// KnownMotion is the motion of the IMU that an odometer measures.
struct KnownMotion {
  /// Returns the motion of the IMU between two times, or nothing unless the odometer covers both times.
  std::function<std::optional<OdometerReading>(TimeNs from_ns, TimeNs to_ns)> between;
  double correction_max_m = 1.0;  ///< registrations with a larger correction are rejected
  double correction_max_rad = 1.0;
};

/// SlamChain contains the options of the lidar-inertial mapping chain.
struct SlamChain {
  /// If `calibration` is true, the mapping chain estimates lidar mounting, lidar clock offset and gravity. A mapping
  /// chain with calibration processes the recording twice. The second pass over the recording starts with the
  /// calibration from the first pass.
  bool calibration = false;
  const KnownMotion* along = nullptr;  ///< odometer
  /// The function `on_sweep` is OracleInput::on_sweep, which displays progress.
  std::function<void(std::size_t done, std::size_t all)> on_sweep = {};
};

struct SlamStage;

/// Runs the lidar-inertial mapping chain of all registration methods: deskewing with the rates in the estimate,
/// registration, mapping. The header slam_settings.hpp describes the parameters. Returns whether the run ends with a
/// known pose in its map.
bool run_slam_chain(const sim::Sensors& sensors, std::span<const ImuSample> samples, const SlamStage& stage,
                    const SlamChain& chain, Estimate& estimate);

}  // namespace tumble::scenarios
