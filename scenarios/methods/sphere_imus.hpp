// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <vector>

#include "scenarios/methods/doubts.hpp"
#include "sim/recording.hpp"
#include "tumble/attitude/detail/unit_senses.hpp"
#include "tumble/common/imu.hpp"
#include "tumble/common/status.hpp"

/// Merges all IMUs of a sphere to one.
namespace tumble::scenarios {

struct MergedImus {
  /// Calibration of one IMU; time offset and bias are relative to the mean of all IMUs.
  struct Unit {
    std::string name;
    double time_offset_s = 0.0, time_offset_sigma_s = 0.0;  ///< positive is later
    double rate_bias_rad_s = 0.0;                           ///< norm
  };

  std::vector<ImuSample> samples;                         ///< body axes
  Eigen::Vector3d lever_arm_m = Eigen::Vector3d::Zero();  ///< from the centre of mass, body axes
  double gyro_range_rad_s = 1e3, accel_range_m_s2 = 1e5;  ///< readings from this value on count as saturated
  int units = 0;
  double left_out = 0.0;                            ///< number of ignored readings
  double beyond_range = 0.0;                        ///< number of further ignored readings beyond the device's range
  int resampled = 0;                                ///< number of units whose stamps differ from the primary unit's
  double offset_max_s = 0.0;                        ///< largest time offset of a unit from the mean
  std::vector<Unit> each;                           ///< units in use
  std::optional<double> arm_share;                  ///< ImuMerge::arm_share
  std::optional<UnitSenses::Detected> other_sense;  ///< detected wrong axes of the units
  std::vector<Doubt> out;  ///< units not used, or not all the time: frozen, silent (NaN, no readings), or inconsistent
};

/// Merges all IMUs except `imu_reference`. The stamps are those of the first IMU with valid stamps; readings of the
/// other IMUs are interpolated. An IMU is excluded while it has no readings (or NaN) or while one of its axes is frozen
/// (find_frozen_axes). A second pass excludes frozen or inconsistent IMUs from the start of the fault.
///
/// Errors are those of the primary IMU if no IMU is valid, and `out_of_range` with the axis if frozen axes leave no IMU
/// (`out.out` lists the excluded IMUs). O(N).
Status merge_imus(const sim::Sensors& sensors, MergedImus& out);

}  // namespace tumble::scenarios
