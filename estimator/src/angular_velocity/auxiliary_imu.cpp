// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/angular_velocity/detail/rate_smoother.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "tumble/angular_velocity/detail/clipping_finder.hpp"
#include "tumble/common/detail/imu_average.hpp"
#include "tumble/common/detail/sample_check.hpp"

namespace tumble {

namespace {

using Eigen::Vector3d;

Vector3d empty_reading() {
  return Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());
}

struct SampleInterval {
  Vector3d value, sigma;
};

SampleInterval between(const Vector3d& value, const Vector3d& change, const ImuSamplePair& near, double noise,
                       double error, const AuxiliaryImu& auxiliary_imu) {
  // The standard deviation of an auxiliary IMU's interpolated reading includes interpolation error and clock error.
  const double crooked =
      near.interpolation_weight * (1.0 - near.interpolation_weight) + auxiliary_imu.clock_error_s / near.length_s;
  const double scaled = auxiliary_imu.scale_error * value.norm();
  return {value, (Vector3d::Constant(noise * noise + error * error + scaled * scaled) + (crooked * change).cwiseAbs2())
                     .cwiseSqrt()};
}

}  // namespace

AuxiliaryReading::AuxiliaryReading()
    : rate_rad_s(empty_reading()),
      force_m_s2(empty_reading()),
      rate_sigma_rad_s(empty_reading()),
      force_sigma_m_s2(empty_reading()) {}

Status align(const AuxiliaryImu& auxiliary_imu, std::span<const ImuSample> samples, std::span<const Clipping> clippings,
             std::span<const ImuSample> primary, double gap_max_s, std::vector<AuxiliaryReading>& out) {
  const Status status = check_samples(samples, std::numeric_limits<double>::infinity());
  if (!status.ok()) return status;
  if (clippings.size() != samples.size()) {
    return {ErrorCode::insufficient_data, "clippings", static_cast<double>(clippings.size()),
            static_cast<double>(samples.size())};
  }
  out.assign(primary.size(), {});
  if (samples.size() < 2) return {};
  const double root_rate = 1.0 / std::sqrt(median_period_s(samples));
  ImuInterpolation interpolation(samples);
  for (std::size_t k = 0; k < primary.size(); ++k) {
    const ImuSamplePair near = interpolation.samples_around(primary[k].time_ns);
    if (!near.is_inside_recording() || near.length_s > gap_max_s) continue;
    const ImuSample here = interpolation.at(primary[k].time_ns, near);
    const ImuSample &a = samples[near.index_before], &b = samples[near.index_after];
    const SampleInterval rate =
        between(here.angular_velocity_rad_s, b.angular_velocity_rad_s - a.angular_velocity_rad_s, near,
                auxiliary_imu.gyro_noise_density * root_rate, auxiliary_imu.gyro_error_rad_s, auxiliary_imu);
    const SampleInterval force =
        between(here.specific_force_m_s2, b.specific_force_m_s2 - a.specific_force_m_s2, near,
                auxiliary_imu.accel_noise_density * root_rate, auxiliary_imu.accel_error_m_s2, auxiliary_imu);
    const Clipping &c = clippings[near.index_before], &d = clippings[near.index_after];
    const bool left = near.interpolation_weight<1.0, right = near.interpolation_weight> 0.0;
    const unsigned gyro = (left ? c.gyro | c.unusable_gyro : 0u) | (right ? d.gyro | d.unusable_gyro : 0u);
    const unsigned accel = (left ? c.accel : 0u) | (right ? d.accel : 0u);
    out[k].rate_along_sensing_axes = gyro != 0;
    out[k].force_along_sensing_axes = accel != 0;
    const Vector3d rates =
        gyro != 0 ? auxiliary_imu.gyro_sensing_directions.sensing_directions * rate.value : rate.value;
    const Vector3d forces =
        accel != 0 ? auxiliary_imu.accel_sensing_directions.sensing_directions * force.value : force.value;
    for (int j = 0; j < 3; ++j) {
      if ((gyro >> j & 1u) == 0) {
        out[k].rate_rad_s[j] = rates[j];
        out[k].rate_sigma_rad_s[j] = rate.sigma[j];
      }
      if ((accel >> j & 1u) == 0) {
        out[k].force_m_s2[j] = forces[j];
        out[k].force_sigma_m_s2[j] = force.sigma[j];
      }
    }
  }
  return {};
}

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
