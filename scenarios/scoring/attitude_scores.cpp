// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <optional>

#include "scenarios/scoring/beside_truth.hpp"
#include "scenarios/scoring/consistency.hpp"
#include "scenarios/scoring/families.hpp"

namespace tumble::scenarios {

namespace {

// AttitudeError contains the parts of the attitude error q_est (x) q_true*, in world axes, as in BROAD (Laidig et al.,
// Data 2021). The heading of the estimate is aligned with the true heading at the first sample.
struct AttitudeError {
  double inclination_rad;
  double heading_rad;
  double total_rad;
};

std::vector<AttitudeError> errors_in_motion(const ScoredEstimate& scored) {
  const TruthTrack& truth = truth_track(scored);
  std::vector<AttitudeError> errors;
  std::optional<Eigen::Quaterniond> q_align;
  for (const AttitudeState& attitude : scored.estimate().attitudes) {
    if (!truth.covers_attitude(attitude.time_ns)) continue;
    const Eigen::Quaterniond q_true = truth.pose(attitude.time_ns).orientation_W;
    if (!q_align) {
      const double heading = twist_about_z_rad(q_true * attitude.orientation_W.conjugate());
      q_align = Eigen::AngleAxisd(heading, Eigen::Vector3d::UnitZ());
    }
    if (truth.at_rest(attitude.time_ns)) continue;
    const Eigen::Quaterniond e = *q_align * attitude.orientation_W * q_true.conjugate();
    errors.push_back({2.0 * std::atan2(std::hypot(e.x(), e.y()), std::hypot(e.w(), e.z())),
                      2.0 * std::atan2(std::abs(e.z()), std::abs(e.w())), rotation_angle_rad(e)});
  }
  return errors;
}

template <double AttitudeError::*Member>
bool rmse(const ScoredEstimate& scored, double& value) {
  std::vector<double> errors;
  for (const AttitudeError& error : scored.once(errors_in_motion)) errors.push_back(error.*Member);
  if (errors.empty()) return false;
  value = rms(errors);
  return true;
}

std::vector<double> normalised_tilt_errors(const ScoredEstimate& scored) {
  const TruthTrack& truth = truth_track(scored);
  std::vector<double> normalised;
  for (const AttitudeState& attitude : scored.estimate().attitudes) {
    const Eigen::Vector2d variance = attitude.covariance_rad2.diagonal().head<2>();
    if (!truth.covers_attitude(attitude.time_ns) || truth.at_rest(attitude.time_ns)) continue;
    if (!(variance.maxCoeff() > 0.0)) continue;
    const Eigen::Vector2d error = tilt_error_rad(attitude.orientation_W, truth.pose(attitude.time_ns).orientation_W);
    for (int axis = 0; axis < 2; ++axis) normalised.push_back(squared_over(error[axis], variance[axis]));
  }
  return normalised;
}

bool tilt_coverage(const ScoredEstimate& scored, double& value) {
  return share_within_3sigma(scored.once(normalised_tilt_errors), value);
}

bool tilt_nees_median(const ScoredEstimate& scored, double& value) {
  return normalised_median(scored.once(normalised_tilt_errors), value);
}

}  // namespace

std::vector<Metric> attitude_metrics() {
  return {
      {{"inclination_rmse_rad", Unit::rad,
        "root mean square (rms) angle between estimated and true vertical, in motion", Sense::lower, Place::headline},
       Kind::attitude,
       rmse<&AttitudeError::inclination_rad>},
      {{"heading_rmse_rad", Unit::rad,
        "rms error of the heading in motion; estimated and true heading are aligned at the start", Sense::lower,
        Place::held},
       Kind::attitude,
       rmse<&AttitudeError::heading_rad>},
      {{"inclination_coverage_3sigma", Unit::share,
        "share of tilt errors (per horizontal axis, in motion) within three reported standard deviations",
        Sense::two_sided, Place::held, kNormal3Sigma, Compared::by_difference},
       Kind::attitude,
       tilt_coverage},
      {{"inclination_nees_median", Unit::number,
        "consistency of the tilt covariance in motion: median of squared error divided by reported variance, scaled so "
        "that a correct covariance gives 1",
        Sense::two_sided, Place::held, 1.0},
       Kind::attitude,
       tilt_nees_median},
      {{"attitude_rmse_rad", Unit::rad, "rms angle of the attitude error, in motion", Sense::lower},
       Kind::attitude,
       rmse<&AttitudeError::total_rad>},
  };
}

}  // namespace tumble::scenarios
