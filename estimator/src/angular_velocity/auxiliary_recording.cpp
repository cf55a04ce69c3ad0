// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/angular_velocity/detail/auxiliary_recording.hpp"

#include <algorithm>
#include <utility>

#include "tumble/angular_velocity/detail/clipping_finder.hpp"

namespace tumble {

Status align(std::span<const AuxiliaryRecording> recordings, std::span<const ImuSample> primary, double gap_max_s,
             AngularRateModelParams& model, std::vector<std::vector<AuxiliaryReading>>& out) {
  out.clear();
  for (const AuxiliaryRecording& recording : recordings.first(std::min(recordings.size(), kAuxiliaryImusMax))) {
    ClippingFinder::Params clipping;
    clipping.axis_limit_params = recording.stated_saturation_limits;
    const ClippingFinder::ClippingSearchResult found = ClippingFinder(clipping).find(recording.samples);
    AuxiliaryImu imu = recording.imu;
    imu.gyro_sensing_directions = found.saturation_levels.rows(Triad::gyro, model.element_sigma);
    imu.accel_sensing_directions = found.saturation_levels.rows(Triad::accelerometer, model.element_sigma);
    std::vector<AuxiliaryReading> aligned;
    const Status status = align(imu, recording.samples, found.clipping_per_sample, primary, gap_max_s, aligned);
    if (!status.ok()) return status;
    model.auxiliary_imus.push_back(imu);
    out.push_back(std::move(aligned));
  }
  return {};
}

}  // namespace tumble
