// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>

#include "odometry_impl.hpp"
#include "tumble/common/so3.hpp"

namespace tumble {

namespace {

constexpr double kExcessTries_rad_s[] = {3.0, 6.0, 9.0, 15.0};
constexpr int kStartsPerSweep = 4;       // a search goes on with the next sweep, so that no sweep costs too much
constexpr double kSearchTurn_rad = 0.3;  // starts of a search reach so far at first, in attitude
constexpr double kSearchShift_m = 1.0;   // and so far in position
constexpr int kSearchRounds = 3;         // each reaches that much further than the last
constexpr double kRestSpeed_m_s = 0.05;  // of an IMU that says nothing but gravity
constexpr double kCreepSpeed_m_s =
    0.5;                        // below it, such an IMU is believed to rest: a world that holds nothing lets creep
constexpr int kRestSweeps = 3;  // after so many in a row

/// Start number `index` of a search: the prior itself, then moved along each axis by what it may be off by, nearer ones
/// first.
Registration::Prior moved_start(Registration::Prior prior, int index) {
  if (index == 0) return prior;
  const double reach = 1.0 + (index - 1) / 12;
  const int axis = (index - 1) / 2 % 6;
  const double sign = (index - 1) % 2 == 0 ? 1.0 : -1.0;
  const double sigma = std::sqrt(prior.state.covariance(axis, axis));
  if (axis < 3) {
    prior.state.p_WI_m[axis] += sign * std::clamp(1.5 * sigma, 0.3, reach * kSearchShift_m);
  } else {
    const double angle = sign * std::clamp(1.5 * sigma, 0.1, reach * kSearchTurn_rad);
    prior.state.q_WI = so3::exp(angle * Eigen::Vector3d::Unit(axis - 3)) * prior.state.q_WI;
  }
  return prior;
}
constexpr int kStarts = 1 + 12 * kSearchRounds;

}  // namespace

Registration::Prior LidarInertialOdometry::Impl::prior() const {
  Registration::Prior prior;
  prior.state = state;
  prior.calibration = calibration;
  prior.calibration_covariance = calibration_covariance;
  prior.motion_calibration = motion_calibration;
  if (samples.front().at_rest) {
    mapping::hold_still(prior.state);
    prior.motion_calibration.bottomRows<3>().setZero();
  }
  // surfaces that hold the sensor tell a slow drive from a rest by themselves; `result` is still the last sweep's
  const bool held =
      result.verdict == RegistrationVerdict::converged && result.weakest_sigma_m <= params.degenerate_sigma_m;
  if (resting_sweeps >= kRestSweeps && !held && prior.state.v_WI_m_s.norm() < kCreepSpeed_m_s) {
    mapping::hold_still(prior.state);
    prior.state.covariance.diagonal().tail<3>().setConstant(kRestSpeed_m_s * kRestSpeed_m_s);
    prior.motion_calibration.bottomRows<3>().setZero();
  }
  const std::uint8_t axes = params.estimate_excess_rate ? trajectory.clipped_axes() : 0;
  prior.state.covariance += mapping::inertial_noise(params, trajectory, samples, axes);
  for (int axis = 0; axis < 3; ++axis) {
    if (!(axes >> axis & 1)) continue;
    double sigma = params.excess_sigma_min_rad_s;
    for (const MotionSample& sample : samples) {
      if (sample.clipped_axes >> axis & 1) sigma = std::max(sigma, sample.rate_sigma_rad_s[axis]);
    }
    prior.excess_sigma_rad_s[axis] = sigma;
    prior.excess_rad_s[axis] = excess_at_end_rad_s[axis];
  }
  prior.excess_start_rad_s = prior.excess_rad_s;
  return prior;
}

bool LidarInertialOdometry::Impl::prior_is_trusted() const {
  // clipped axes count in full here, also where the registration estimates their excess
  const Eigen::Matrix<double, 9, 9> P = state.covariance + mapping::inertial_noise(params, trajectory, samples, 0);
  const Eigen::Vector3d m2 = P.diagonal().head<3>(), rad2 = P.diagonal().segment<3>(3);
  return m2.maxCoeff() <= params.trusted_prior_m * params.trusted_prior_m &&
         rad2.maxCoeff() <= params.trusted_prior_rad * params.trusted_prior_rad;
}

void LidarInertialOdometry::Impl::choose_points() {
  compute_levers(trajectory, points, positions_W_m);
  for (std::size_t i = 0; i < points.size(); ++i) positions_W_m[i] += trajectory.base_m(points[i].t_s).cast<float>();
  sampler.choose(positions_W_m, params.sweep_voxel_m, chosen_index);
  chosen.clear();
  for (const std::uint32_t index : chosen_index) chosen.push_back(points[index]);
}

/// Registers; where that fails and the rate may be short on a clipped axis, tries again from larger excess rates, since
/// a rail that is left behind within one sweep may put the start a whole radian off.
Status LidarInertialOdometry::Impl::align(const Registration::Prior& given, TimeNs end_ns,
                                          Registration::Result& found) {
  Registration::Prior prior = given;
  Status status = registration.align(prior, samples, end_ns, chosen, map, trajectory, found);
  int iterations = found.iterations;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double more : kExcessTries_rad_s) {
      if (!status.ok() || found.verdict == RegistrationVerdict::converged) break;
      if (prior.excess_sigma_rad_s[axis] < more / 5.0) break;
      prior.excess_start_rad_s = prior.excess_rad_s;
      prior.excess_start_rad_s[axis] += more;
      status = registration.align(prior, samples, end_ns, chosen, map, trajectory, found);
      iterations += found.iterations;
    }
  }
  found.iterations = iterations;
  return status;
}

/// Looks for the sensor around the prior, a few starts per sweep: coarsely on few points, then as always.
Status LidarInertialOdometry::Impl::search(const Registration::Prior& prior, TimeNs end_ns,
                                           Registration::Result& found) {
  std::vector<SweepPoint> few;
  for (std::size_t i = 0; i < chosen.size(); i += mapping::kCoarseEvery) few.push_back(chosen[i]);
  Status status;
  for (int k = 0; k < kStartsPerSweep; ++k) {
    // a covered lidar tries nothing: only sweeps with points count
    const int index = k == 0 ? 0 : 1 + (failed_searches * (kStartsPerSweep - 1) + k - 1) % (kStarts - 1);
    Registration::Result rough;
    Registration::Prior start = moved_start(prior, index);
    status = coarse.align(start, samples, end_ns, few, map, trajectory, rough);
    if (!status.ok()) return status;
    if (rough.verdict != RegistrationVerdict::converged) continue;
    start.state = rough.state;
    start.state.covariance = prior.state.covariance;
    start.excess_start_rad_s = rough.excess_rad_s;
    status = registration.align(start, samples, end_ns, chosen, map, trajectory, found);
    if (!status.ok() || found.verdict == RegistrationVerdict::converged) return status;
  }
  return status;
}

void LidarInertialOdometry::Impl::register_sweep(TimeNs end_ns, SweepReport& report) {
  const bool prior_trusted = prior_is_trusted();
  const Registration::Prior before = prior();
  Status status = align(before, end_ns, result);
  if (status.ok() && result.verdict != RegistrationVerdict::converged && lost_sweeps > 0) {
    status = search(before, end_ns, result);
  }
  report.iterations = result.iterations;
  report.inlier_share = result.points == 0 ? 0.0 : double(result.inliers) / double(result.points);
  if (!status.ok()) return;
  if (result.verdict != RegistrationVerdict::converged) {
    const bool too_few = result.verdict == RegistrationVerdict::too_few;
    unmatched = too_few && chosen.size() >= params.matches_min;
    const bool given_up = ++failed_searches >= params.lost_sweeps_max;
    if (chosen.size() >= params.matches_min && ((too_few && prior_trusted) || given_up)) {
      report.verdict = SweepVerdict::degenerate;
    }
    return;
  }
  failed_searches = 0;
  report.conditioning = result.eigenvalues[5] > 0.0 ? result.eigenvalues[0] / result.eigenvalues[5] : 0.0;
  report.weakest_direction = result.directions.col(0);
  report.weakest_sigma_m = result.weakest_sigma_m;
  report.verdict =
      report.weakest_sigma_m > params.degenerate_sigma_m ? SweepVerdict::degenerate : SweepVerdict::registered;
  report.excess_rate_rad_s = result.excess_rad_s;
}

/// Whether the IMU has nothing to say but gravity over the present stretch.
bool LidarInertialOdometry::Impl::imu_rests(TimeNs end_ns) const {
  const auto rests = [&](const MotionSample& sample) {
    return sample.from_ns >= end_ns ||
           (sample.w_WI_I_rad_s.norm() <= params.rest_rate_rad_s && sample.clipped_axes == 0 &&
            std::abs(sample.f_I_m_s2.norm() - params.gravity_m_s2) <= params.rest_force_m_s2);
  };
  return std::all_of(samples.begin(), samples.end(), rests);
}

/// Whether the specific force is more than gravity over the present stretch, by the attitude as it is believed.
bool LidarInertialOdometry::Impl::trajectory_speeds_up() const {
  const Eigen::Vector3d gained_m_s = trajectory.state(trajectory.duration_s()).v_WI_m_s - state.v_WI_m_s;
  return gained_m_s.norm() > params.rest_force_m_s2 * trajectory.duration_s();
}

/// The inertial prior stands for the sweep; an IMU at rest stops the drift of its velocity.
Status LidarInertialOdometry::Impl::fall_back_on_inertia(TimeNs end_ns) {
  Registration::Prior loose = prior();
  if (lost_sweeps > 0 && imu_rests(end_ns)) {
    mapping::hold_still(loose.state);
    loose.state.covariance.diagonal().tail<3>().setConstant(kRestSpeed_m_s * kRestSpeed_m_s);
    loose.motion_calibration.bottomRows<3>().setZero();
  }
  result = Registration::Result{};
  result.state = loose.state;
  result.calibration = loose.calibration;
  constexpr int kCal = Registration::kCalibration;
  constexpr int kErrors = SweepCalibration::kErrors;
  result.covariance.topLeftCorner<9, 9>() = loose.state.covariance;
  result.covariance.diagonal().segment<3>(Registration::kExcess) = loose.excess_sigma_rad_s.cwiseAbs2();
  result.covariance.block<9, kErrors>(0, kCal) = loose.motion_calibration;
  result.covariance.block<kErrors, 9>(kCal, 0) = loose.motion_calibration.transpose();
  result.covariance.bottomRightCorner<kErrors, kErrors>() = loose.calibration_covariance;
  return trajectory.build(loose.state, samples, end_ns, loose.calibration.gravity_W_m_s2, loose.excess_rad_s);
}

}  // namespace tumble
