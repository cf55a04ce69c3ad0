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

/// All IMUs of a sphere as one.
namespace tumble::scenarios {

struct MergedImus {
  /// What was learnt of one unit; offset and bias about the mean of all.
  struct Unit {
    std::string name;
    double time_offset_s = 0.0, time_offset_sigma_s = 0.0;  ///< later is positive
    double rate_bias_rad_s = 0.0;                           ///< length
  };

  std::vector<ImuSample> samples;                         ///< body axes
  Eigen::Vector3d lever_arm_m = Eigen::Vector3d::Zero();  ///< from the centre of mass, body axes
  double gyro_range_rad_s = 1e3, accel_range_m_s2 = 1e5;  ///< readings from here on are taken to be at the rail
  int units = 0;
  double left_out = 0.0;            ///< readings
  double beyond_range = 0.0;        ///< readings that their device cannot have measured, which are no part of it either
  int resampled = 0;                ///< units whose stamps differ from the primary one's
  double offset_max_s = 0.0;        ///< largest time offset of a unit about the mean
  std::vector<Unit> each;           ///< those in use
  std::optional<double> arm_share;  ///< ImuMerge::arm_share
  std::optional<UnitSenses::Told> other_sense;  ///< of the units' axes
  std::vector<Doubt> out;  ///< units not in use, or not all the time: frozen, silent (NaN, no readings), or disagreeing
};

/// Merges the primary IMU with the others; `imu_reference` is not one of them. The stamps are those of the first unit
/// whose own are without trouble; readings with other stamps are interpolated at them. A unit that is silent for a
/// while (NaN, no readings) is left out for so long. Twice: who froze or disagrees is known after the first time, and
/// left out from the beginning of it. So is a unit while one of its axes is frozen (find_frozen_axes). Trouble: that of
/// the primary one's samples, when no unit is without; `out_of_range` naming the axis where that leaves no unit, when
/// `out.out` says which froze. O(N).
Status merge_imus(const sim::Sensors& sensors, MergedImus& out);

}  // namespace tumble::scenarios
