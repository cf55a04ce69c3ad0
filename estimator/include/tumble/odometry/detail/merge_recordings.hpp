// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "tumble/angular_velocity/detail/frozen_axes.hpp"
#include "tumble/attitude/detail/unit_sign_check.hpp"
#include "tumble/attitude/imu_merge.hpp"
#include "tumble/common/imu.hpp"
#include "tumble/common/status.hpp"
#include "tumble/odometry/imu_sheet.hpp"

namespace tumble {

/// UnitRecording contains all readings of one of several IMUs on a body, in time order.
struct UnitRecording {
  ImuSheet sheet;
  Eigen::Isometry3d T_BI = Eigen::Isometry3d::Identity();
  std::vector<ImuSample> samples;
};

/// UnitFault is a fault of one IMU. The readings of a faulty IMU are not used.
struct UnitFault {
  enum class Kind : std::uint8_t {
    silent,       ///< no readings for half a second or until the end
    frozen,       ///< gyro or accelerometer repeats one reading while the other IMUs' readings change
    frozen_axis,  ///< `axis` repeats one reading; only the readings of this interval are not used
    disagrees,    ///< the IMU contradicts the others; none of its readings is used
  };
  Kind kind = Kind::silent;
  std::size_t unit = 0;  ///< index of the IMU
  TimeNs since_ns = 0;
  FrozenAxis axis;
};

/// MergedRecordings is one virtual IMU that replaces several IMUs.
struct MergedRecordings {
  /// Unit contains the calibration of one IMU relative to the mean of all IMUs.
  struct Unit {
    std::size_t unit = 0;                                   ///< index of the IMU
    double time_offset_s = 0.0, time_offset_sigma_s = 0.0;  ///< positive: the IMU is late
    double rate_bias_rad_s = 0.0;                           ///< norm of the gyro bias
  };
  std::vector<ImuSample> samples;                         ///< merged samples, in body axes
  Eigen::Vector3d lever_arm_m = Eigen::Vector3d::Zero();  ///< position of the merged IMU, in body axes
  std::vector<Unit> units;                                ///< IMUs in use
  std::vector<UnitFault> faults;
  std::size_t excluded_readings = 0;                        ///< readings that ImuMerge excluded
  std::optional<double> lever_arm_agreement;                ///< ImuMerge::lever_arm_agreement
  std::optional<UnitSignCheck::Detected> mislabelled_axes;  ///< mislabelled axes of the IMUs, as found by ImuMerge
};

/// Merges the recordings of up to ImuMerge::kImus IMUs on one body with knowledge of the whole recording.
/// ClippingFinder flags the clipped readings, UnitAlignment resamples the IMUs to common times, and ImuMerge merges the
/// samples. The function excludes an IMU while an axis is frozen or no readings exist. If ImuMerge finds a frozen or
/// contradicting IMU, a second pass excludes the IMU from the start of the fault. The function ignores IMUs without
/// samples. The argument `params` contains ranges and gaps; the function sets the number, mountings and sensing
/// directions of the IMUs.
///
/// Returns `empty` if no IMU has a sample, or an error of ImuMerge. Returns `out_of_range` with the axis if frozen axes
/// leave no IMU; `out.faults` then lists the excluded IMUs. Cost: O(N).
Status merge_recordings(std::span<const UnitRecording> recordings, ImuMerge::Params params, MergedRecordings& out);

}  // namespace tumble
