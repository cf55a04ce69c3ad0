// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>

#include "odometry_impl.hpp"
#include "tumble/common/so3.hpp"

namespace tumble {

namespace {

constexpr double kExcessTries_rad_s[] = {3.0, 6.0, 9.0, 15.0};
constexpr int kExcessTriesMax = 5;         // of these for one sweep, all axes together
constexpr int kStartsPerSweep = 3;         // of a search, the prior itself among them
constexpr std::size_t kFewPoints = 300;    // serve a start that may be far off
constexpr std::size_t kSomePoints = 1000;  // tell whether it leads somewhere
constexpr double kSearchTurn_rad = 0.3;    // starts of a search reach so far at first, in attitude
constexpr double kSearchShift_m = 1.0;     // and so far in position
constexpr int kSearchRounds = 3;           // each reaches that much further than the last
constexpr double kStillSpeed_m_s = 0.01;   // during the rest at the start
constexpr double kRestSpeed_m_s = 0.05;    // of an IMU that says nothing but gravity
constexpr double kCreepSpeed_m_s =
    0.5;                             // below it, such an IMU is believed to rest: a world that holds nothing lets creep
constexpr int kRestSweeps = 3;       // after so many in a row
constexpr double kCarryMax = 3.0;    // an excess carried over a border grows by no more where less is known after it
constexpr double kKnotFloor = 0.05;  // of the prior's standard deviation: a knot differs from its neighbours by this

/// Start number `index` of a search: the prior itself, then moved along each axis by what it may be off by, nearer ones
/// first, mapping.md (R54).
Registration::Prior moved_start(Registration::Prior prior, int index) {
  if (index == 0) return prior;
  const int rounds = (index - 1) / 12;  // of all axes both ways
  const double reach = 1.0 + rounds;
  const int axis = (index - 1) / 2 % 6;
  const double sign = (index - 1) % 2 == 0 ? 1.0 : -1.0;
  const double sigma = std::sqrt(prior.covariance(axis, axis));
  MotionState& state = prior.mean.state;
  if (axis < 3) {
    state.p_WI_m[axis] += sign * std::clamp(1.5 * sigma, 0.3, reach * kSearchShift_m);
  } else {
    const double angle = sign * std::clamp(1.5 * sigma, 0.1, reach * kSearchTurn_rad);
    state.q_WI = so3::exp(angle * Eigen::Vector3d::Unit(axis - 3)) * state.q_WI;
  }
  return prior;
}
constexpr int kStarts = 1 + 12 * kSearchRounds;

/// At most `count` of the points, evenly.
void thin(const std::vector<SweepPoint>& points, std::size_t count, std::vector<SweepPoint>& out) {
  out.clear();
  const std::size_t every = std::max<std::size_t>(1, (points.size() + count - 1) / count);
  for (std::size_t i = 0; i < points.size(); i += every) out.push_back(points[i]);
}

}  // namespace

/// mapping.md (R29).
void mapping::Prediction::compose(const Registration::Matrix& covariance,
                                  const Registration::Matrix& error_covariance) {
  prior.covariance = by_last * covariance * by_last.transpose() + noise;
  errors = by_last * error_covariance * by_last.transpose() + noise;
}

void mapping::Prediction::hold_still(double sigma_m_s) {
  prior.mean.state.v_WI_m_s.setZero();
  by_last.middleRows<3>(6).setZero();
  noise.middleRows<3>(6).setZero();
  noise.middleCols<3>(6).setZero();
  noise.diagonal().segment<3>(6).setConstant(sigma_m_s * sigma_m_s);
}

/// mapping.md (R30).
void mapping::Prediction::follow(const Eigen::Vector3d& v_WI_I_m_s, double sigma_m_s) {
  hold_still(sigma_m_s);
  const Eigen::Vector3d v_WI_m_s = prior.mean.state.q_WI * v_WI_I_m_s;
  prior.mean.state.v_WI_m_s = v_WI_m_s;
  by_last.middleRows<3>(6) = -so3::hat(v_WI_m_s) * by_last.middleRows<3>(3);
}

mapping::Prediction LidarInertialOdometry::Impl::predict() const {
  mapping::Prediction next;
  next.prior.mean.state = state;
  next.prior.mean.calibration = calibration;
  carry_excess(next);
  if (samples.front().at_rest) next.hold_still(kStillSpeed_m_s);
  // surfaces that hold the sensor tell a slow drive from a rest by themselves; `result` is still the last sweep's
  const bool held =
      result.verdict == RegistrationVerdict::converged && result.weakest_sigma_m <= params.degenerate_sigma_m;
  if (resting_sweeps >= kRestSweeps && !held && state.v_WI_m_s.norm() < kCreepSpeed_m_s) {
    next.hold_still(kRestSpeed_m_s);
  }
  if (odometer.known) next.follow(odometer.v_WI_I_m_s, odometer.sigma_m_s);
  const std::uint8_t axes = params.estimate_saturation_deficit ? trajectory.clipped_axes() : 0;
  next.noise.topLeftCorner<9, 9>() += mapping::inertial_noise(params, trajectory, samples, axes);
  // a force that comes late in a stretch is not in the velocity that the stretch is fitted with: the next one hears of
  // it as well
  next.noise.block<3, 3>(6, 6) += railed_before + mapping::railed_velocity_variance(params, trajectory, samples);
  add_excess_noise(next);
  next.prior.excess_start_rad_s = next.prior.mean.excess_rad_s;
  next.compose(covariance, error_covariance);
  return next;
}

/// The excess of a clipped axis that is on the rail at the border goes on from where it was, and forgets as time goes:
/// mapping.md (R38).
void LidarInertialOdometry::Impl::carry_excess(mapping::Prediction& next) const {
  constexpr int kLast = SweepTrajectory::kKnots - 1;
  next.by_last.middleRows<SweepTrajectory::kExcess>(Registration::kExcess).setZero();
  if (!params.estimate_saturation_deficit) return;
  const Eigen::Vector3d share_at_start = trajectory.excess_share_at_start();
  for (int axis = 0; axis < 3; ++axis) {
    if (!(share_at_start[axis] > 0.0 && excess_share_at_end[axis] > 0.0)) continue;
    double remains = std::clamp(excess_share_at_end[axis] / share_at_start[axis], 0.0, kCarryMax);
    for (int knot = 0; knot <= kLast; ++knot) {
      next.prior.mean.excess_rad_s(axis, knot) = remains * excess_rad_s(axis, kLast);
      next.by_last(Registration::kExcess + 3 * knot + axis, Registration::kExcess + 3 * kLast + axis) = remains;
      remains *= mapping::knot_correlation(params, trajectory);
    }
  }
}

/// Knots as samples of a process that forgets: of the reported standard deviation, correlated from knot to knot,
/// mapping.md (R36), (R37), (R39): the last where the first knot is carried.
void LidarInertialOdometry::Impl::add_excess_noise(mapping::Prediction& next) const {
  if (!params.estimate_saturation_deficit) return;
  const double rho = mapping::knot_correlation(params, trajectory);
  for (int axis = 0; axis < 3; ++axis) {
    if (!(trajectory.clipped_axes() >> axis & 1)) continue;
    double sigma = params.excess_sigma_min_rad_s;
    for (const MotionSample& sample : samples) {
      // those after the stretch wait for the next one
      if (seconds(sample.from_ns - trajectory.start_ns()) >= trajectory.duration_s()) break;
      if (sample.clipped_axes >> axis & 1) sigma = std::max(sigma, sample.rate_sigma_rad_s[axis]);
    }
    const int first = Registration::kExcess + axis;
    const bool carried = next.by_last.row(first).squaredNorm() > 0.0;
    for (int a = 0; a < SweepTrajectory::kKnots; ++a) {
      for (int b = 0; b < SweepTrajectory::kKnots; ++b) {
        const double known = carried ? std::pow(rho, a + b) : 0.0;
        next.noise(first + 3 * a, first + 3 * b) += sigma * sigma * (std::pow(rho, std::abs(a - b)) - known);
      }
      next.noise(first + 3 * a, first + 3 * a) += kKnotFloor * kKnotFloor * sigma * sigma;
    }
  }
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

/// At most kFewPoints and kSomePoints of the chosen, evenly.
void LidarInertialOdometry::Impl::choose_few() {
  thin(chosen, kFewPoints, few);
  thin(chosen, kSomePoints, some);
}

/// From a start that may be far off: first coarsely and with few points, then with some, and in full where these lead
/// somewhere, so that a start in vain costs a fraction of a registration.
Status LidarInertialOdometry::Impl::try_start(const Registration::Prior& start, const Registration::Prior& prior,
                                              TimeNs end_ns, Registration::Result& found) {
  Registration::Result rough;
  Status status = coarse.align(start, samples, end_ns, few, map, trajectory, rough);
  found.verdict = rough.verdict;
  if (!status.ok() || rough.verdict != RegistrationVerdict::converged) return status;
  Registration::Prior fine = prior;
  fine.start = rough.mean.state;
  fine.excess_start_rad_s = rough.mean.excess_rad_s;
  return align_to_convergence(fine, end_ns, found);
}

/// With some of the points for as long as it takes, and in full from where these lead.
Status LidarInertialOdometry::Impl::align_to_convergence(const Registration::Prior& prior, TimeNs end_ns,
                                                         Registration::Result& found) {
  Status status = patient.align(prior, samples, end_ns, some, map, trajectory, found);
  if (!status.ok() || found.verdict != RegistrationVerdict::converged) return status;
  Registration::Prior near = prior;
  near.start = found.mean.state;
  near.excess_start_rad_s = found.mean.excess_rad_s;
  const int iterations = found.iterations;
  status = registration.align(near, samples, end_ns, chosen, map, trajectory, found);
  found.iterations += iterations;
  return status;
}

/// Registers; where that fails and the rate may be short on a clipped axis, tries again from larger saturation
/// deficits, since a rail that is left behind within one sweep may put the start a whole radian off.
Status LidarInertialOdometry::Impl::align(const Registration::Prior& prior, TimeNs end_ns,
                                          Registration::Result& found) {
  Status status = registration.align(prior, samples, end_ns, chosen, map, trajectory, found);
  int iterations = found.iterations, tries = 0;
  // one that ran beyond its bound would do so again
  const bool out_of_bounds =
      found.correction_m > params.correction_max_m || found.correction_rad > params.correction_max_rad;
  if (status.ok() && found.verdict == RegistrationVerdict::diverged && !out_of_bounds) {
    status = align_to_convergence(prior, end_ns, found);
    iterations += found.iterations;
  }
  for (const double more : kExcessTries_rad_s) {
    for (int axis = 0; axis < 3; ++axis) {
      if (!status.ok() || found.verdict == RegistrationVerdict::converged || tries == kExcessTriesMax) break;
      const int first = Registration::kExcess + axis;
      if (std::sqrt(prior.covariance(first, first)) < more / 5.0) continue;
      Registration::Prior start = prior;
      start.excess_start_rad_s.row(axis).array() += more;
      status = try_start(start, prior, end_ns, found);
      iterations += found.iterations;
      ++tries;
    }
  }
  found.iterations = iterations;
  return status;
}

/// Looks for the way back: from the prior and from starts around it. A search goes on with the next sweep where this
/// one ended, so that no sweep costs too much.
Status LidarInertialOdometry::Impl::search(const Registration::Prior& prior, TimeNs end_ns,
                                           Registration::Result& found) {
  Status status = try_start(prior, prior, end_ns, found);
  const RegistrationVerdict verdict = found.verdict;  // of the sweep where nothing is found
  for (int k = 0; k + 1 < kStartsPerSweep; ++k) {
    if (!status.ok() || found.verdict == RegistrationVerdict::converged) return status;
    const int index = 1 + (failed_searches * (kStartsPerSweep - 1) + k) % (kStarts - 1);
    status = try_start(moved_start(prior, index), prior, end_ns, found);
  }
  if (found.verdict != RegistrationVerdict::converged) found.verdict = verdict;
  return status;
}

bool LidarInertialOdometry::Impl::register_sweep(TimeNs end_ns, SweepReport& report) {
  const bool prior_trusted = prior_is_trusted();
  result = Registration::Result{};
  result.points = chosen.size();
  choose_few();
  const Status status =
      lost_sweeps == 0 ? align(prediction.prior, end_ns, result) : search(prediction.prior, end_ns, result);
  report.iterations = result.iterations;
  report.inlier_share = result.points == 0 ? 0.0 : double(result.inliers) / double(result.points);
  if (!status.ok()) return false;
  if (result.verdict != RegistrationVerdict::converged) {
    const bool too_few = result.verdict == RegistrationVerdict::too_few;
    unmatched = too_few && chosen.size() >= params.matches_min;
    const bool given_up = ++failed_searches >= params.lost_sweeps_max;
    if (chosen.size() >= params.matches_min && ((too_few && prior_trusted) || given_up)) {
      report.verdict = SweepVerdict::degenerate;
    }
    return false;
  }
  failed_searches = 0;
  report.conditioning = result.eigenvalues[5] > 0.0 ? result.eigenvalues[0] / result.eigenvalues[5] : 0.0;
  report.weakest_direction = result.directions.col(0);
  report.weakest_sigma_m = result.weakest_sigma_m;
  report.verdict =
      report.weakest_sigma_m > params.degenerate_sigma_m ? SweepVerdict::degenerate : SweepVerdict::registered;
  report.saturation_deficit_rad_s = result.mean.excess_rad_s.rowwise().mean();
  return true;
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
  if (lost_sweeps > 0 && imu_rests(end_ns) && !odometer.known) {
    prediction.hold_still(kRestSpeed_m_s);
    prediction.compose(covariance, error_covariance);
  }
  result = Registration::Result{};
  result.mean = prediction.prior.mean;
  result.mean.state.covariance = prediction.prior.covariance.topLeftCorner<9, 9>();
  result.covariance = prediction.prior.covariance;
  return trajectory.build(result.mean.state, samples, end_ns, result.mean.calibration.gravity_W_m_s2,
                          result.mean.excess_rad_s);
}

}  // namespace tumble
