// SPDX-License-Identifier: BSD-3-Clause
#include <limits>

#include "scenarios/scoring/beside_truth.hpp"
#include "scenarios/scoring/families.hpp"
#include "tumble/common/types.hpp"

namespace tumble::scenarios {

namespace {

/// OffsetFit fits a time offset by least squares. The fitted model is: error of the estimate = offset * rate of change
/// of the truth.
class OffsetFit {
 public:
  void add(const Eigen::Vector3d& behind, const Eigen::Vector3d& change_per_s) {
    if (!change_per_s.allFinite()) return;
    product_ += change_per_s.dot(behind);
    square_ += change_per_s.squaredNorm();
  }

  bool offset_s(double& value) const {
    if (!(square_ > std::numeric_limits<double>::min())) return false;
    value = product_ / square_;
    return true;
  }

 private:
  double product_ = 0.0, square_ = 0.0;
};

// Clipped samples are omitted, because a time offset is not the main cause of their rate errors.
bool rate_offset(const ScoredEstimate& scored, double& value) {
  const ClippingTruth& truth = clipping_truth(scored);
  const std::int64_t period_ns = scored.sensors().imus.front().period_ns;
  OffsetFit fit;
  for (const PairedRate& pair : paired_rates(scored)) {
    if (!pair.truth || pair.clipped_axes() != 0) continue;
    const auto before = truth.at(pair.estimate->time_ns - period_ns),
               after = truth.at(pair.estimate->time_ns + period_ns);
    if (!before || !after) continue;
    const double span_s = 2e-9 * static_cast<double>(period_ns);
    fit.add(-pair.error_rad_s(), (after->rate_rad_s - before->rate_rad_s) / span_s);
  }
  return fit.offset_s(value);
}

Eigen::Vector3d lacking_rad(const Eigen::Quaterniond& q_estimate, const Eigen::Quaterniond& q_true) {
  return so3::logarithm(q_estimate.conjugate() * q_true);
}

bool attitude_offset(const ScoredEstimate& scored, double& value) {
  const TruthTrack& truth = truth_track(scored);
  OffsetFit fit;
  Eigen::Quaterniond q_align = Eigen::Quaterniond::Identity();
  bool aligned = false;
  for (const AttitudeState& attitude : scored.estimate().attitudes) {
    if (!truth.covers_attitude(attitude.time_ns)) continue;
    const Eigen::Quaterniond q_true = truth.pose(attitude.time_ns).orientation_W;
    if (!aligned) {
      const double heading = twist_about_z_rad(q_true * attitude.orientation_W.conjugate());
      q_align = Eigen::AngleAxisd(heading, Eigen::Vector3d::UnitZ());
      aligned = true;
    }
    fit.add(lacking_rad(q_align * attitude.orientation_W, q_true), truth.rate_rad_s(attitude.time_ns));
  }
  return fit.offset_s(value);
}

bool pose_offset(const ScoredEstimate& scored, double& value) {
  const TruthTrack& truth = truth_track(scored);
  OffsetFit fit;
  for (const PairedPose& pair : paired_track(scored).poses)
    fit.add(lacking_rad(pair.estimate.orientation_W, pair.truth.orientation_W), truth.rate_rad_s(pair.time_ns));
  return fit.offset_s(value);
}

Metric offset_metric(const char* name, const char* doc, Kind kind, bool (*compute)(const ScoredEstimate&, double&)) {
  return {{name, Unit::time_offset, doc, Sense::two_sided, Place::held, 0.0, Compared::by_difference}, kind, compute};
}

}  // namespace

std::vector<Metric> time_offset_metrics() {
  constexpr const char* kPoses =
      "time delay of the attitudes of the poses (negative: too early), from a least-squares fit of the attitude errors "
      "to the true rate";
  return {
      offset_metric("rate_time_offset_s",
                    "time delay of the rates (negative: too early), from a least-squares fit of the errors of "
                    "unclipped axes to the true angular acceleration",
                    Kind::rate, rate_offset),
      offset_metric("attitude_time_offset_s",
                    "time delay of the attitudes (negative: too early), from a least-squares fit of the attitude "
                    "errors to the true rate",
                    Kind::attitude, attitude_offset),
      offset_metric("pose_time_offset_s", kPoses, Kind::position, pose_offset),
      offset_metric("pose_time_offset_s", kPoses, Kind::slam, pose_offset),
  };
}

}  // namespace tumble::scenarios
