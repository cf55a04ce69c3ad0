// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "tumble/angular_velocity/detail/clipping_finder.hpp"
#include "tumble/attitude/detail/imu_merge.hpp"
#include "tumble/attitude/detail/multi_imu_sign_check.hpp"
#include "tumble/common/status.hpp"
#include "tumble/common/types.hpp"
#include "tumble/odometry/sensor_sheets.hpp"

namespace tumble {

/// All readings of one of several IMUs on a body, in time order.
struct ImuRecording {
  ImuDataSheet data_sheet;
  Eigen::Isometry3d T_BI = Eigen::Isometry3d::Identity();
  std::vector<ImuSample> samples;
};

struct MergedRecordings {
  /// Calibration of one IMU relative to the mean of all IMUs.
  struct MergedImu {
    std::size_t imu_index = 0;
    double time_offset_s = 0.0, time_offset_sigma_s = 0.0;  ///< positive: the IMU lags behind the mean
    double rate_bias_rad_s = 0.0;
  };
  std::vector<ImuSample> samples;                         ///< fused samples, in body axes
  Eigen::Vector3d lever_arm_m = Eigen::Vector3d::Zero();  ///< mean position of the IMUs, in body axes
  std::vector<MergedImu> imus;                            ///< IMUs in use
  /// IMUs that are silent, frozen, or contradict the other IMUs, and are therefore excluded. An IMU with a frozen axis
  /// is excluded only during the fault.
  SensorHealth faults;
  std::size_t excluded_readings = 0;
  std::optional<double> lever_arm_agreement;
  std::optional<MultiImuSignCheck::DetectedMirroring>
      mislabelled_axes;  ///< flipped or swapped axes that all IMUs share
};

ClippingFinder::Params clipping_finder_params(const ImuDataSheet& sheet);
/// Selects from the saturation limits `detected` those that a frozen IMU cannot imitate.
ConfirmedSaturation confirmed_saturation(const SaturationLevels& detected, const ImuDataSheet& sheet);

/// Returns the name of an IMU in health findings: "imu_1" for index 0, or "imu" if there is only one IMU.
std::string imu_name(std::size_t unit, std::size_t units);

/// Fuses the recordings of up to ImuMerge::kImus IMUs on one body, with the saturation limits and faults of the whole
/// recording. ClippingFinder flags the clipped readings, ImuTimeAlignment resamples the IMUs to common times, and
/// ImuMerge fuses them. An IMU is excluded while an axis is frozen or readings are missing. If ImuMerge detects a
/// frozen or contradicting IMU, a second pass excludes this IMU from the start of the fault. IMUs without samples are
/// ignored. `setup` states the ranges; the function sets the number, poses and sensing elements of the IMUs.
///
/// Returns `empty` if no IMU has a sample, or an error of ImuMerge. Returns `out_of_range` with the axis if frozen axes
/// leave no IMU; `out.faults` then lists the excluded IMUs. Cost: O(N).
Status merge_recordings(std::span<const ImuRecording> recordings, ImuMerge::Setup setup, MergedRecordings& out);

}  // namespace tumble
