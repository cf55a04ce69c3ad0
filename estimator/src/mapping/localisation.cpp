// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/mapping/detail/localisation.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <vector>

#include "inertial_track.hpp"
#include "tumble/common/types.hpp"
#include "tumble/mapping/detail/registration.hpp"

namespace tumble {

namespace {

constexpr double kLeast = 0.02, kScaleDeviations = 5.0;
// Over short time spans, registered poses follow the IMU, which hides a scale error of the lidar's ranges. If all
// ranges are 10 % too long, velocity changes over 0.4 s give an estimated range scale of 1.08.
constexpr double kSpan_s = 0.4;
constexpr double kChange_m_s = 0.2;  // minimum change of velocity; noise dominates smaller changes
constexpr std::size_t kChangesMin = 5, kChangesMax = 1000;
constexpr int kDisjointMin = 4;       // minimum number of velocity changes without a common sweep, to determine sigma
constexpr std::size_t kSpanMax = 64;  // maximum number of buffered sweeps
constexpr int kIterations = 10;
constexpr double kBias_m_s2 = 0.05;         // constant error of the acceleration, without the error from the tilt
constexpr double kForgettingTime_s = 60.0;  // maximum age of a velocity change, so that a finding ends
// width of the Huber kernel in standard deviations; ratio of the standard deviation to the median absolute deviation
constexpr double kHuber = 1.5, kPerMedian = 1.4826;

using Change = LidarScaleEstimator::VelocityChange;

class ImuMotion {
 public:
  template <class Sweeps>
  ImuMotion(std::span<const ImuSample> samples, const Sweeps& sweeps, double gravity_m_s2)
      : samples_(samples), gravity_W_m_s2_(0.0, 0.0, -gravity_m_s2) {
    for (const SweepResult& sweep : sweeps)
      attitudes_.insert(attitudes_.end(), sweep.trajectory.begin(), sweep.trajectory.end());
  }

  /// Returns the standard deviation of the acceleration from bias and tilt.
  double acceleration_sigma_m_s2(const PoseState& pose) const {
    const double tilt_variance_rad2 = std::max(pose.covariance(3, 3), pose.covariance(4, 4));
    return std::hypot(kBias_m_s2, gravity_W_m_s2_.z() * std::sqrt(std::max(0.0, tilt_variance_rad2)));
  }

  /// Returns the mean velocity from `middle_ns` to `to_ns`, minus the mean velocity from `from_ns` to `middle_ns`.
  /// Returns nothing if an accelerometer reading between `from_ns` and `to_ns` is clipped or missing.
  std::optional<Eigen::Vector3d> velocity_change(TimeNs from_ns, TimeNs middle_ns, TimeNs to_ns) const {
    if (attitudes_.empty()) return std::nullopt;
    const auto later = [](const ImuSample& sample, TimeNs time_ns) { return sample.time_ns <= time_ns; };
    auto next = std::lower_bound(samples_.begin(), samples_.end(), from_ns, later);
    Eigen::Vector3d velocity = Eigen::Vector3d::Zero(), place = velocity, at_middle = velocity;
    for (TimeNs now = from_ns; now < to_ns;) {
      if (next == samples_.end() || (next->device_clip_flags & kClipAccel) != 0) return std::nullopt;
      const TimeNs before_ns = next == samples_.begin() ? from_ns : std::prev(next)->time_ns;
      if (next->time_ns - before_ns > mapping::kGap_ns) return std::nullopt;
      const TimeNs until = std::min({next->time_ns, to_ns, now < middle_ns ? middle_ns : to_ns});
      const double dt_s = seconds(until - now);
      const Eigen::Vector3d a = attitude(now + (until - now) / 2) * next->specific_force_m_s2 + gravity_W_m_s2_;
      place += dt_s * velocity + 0.5 * dt_s * dt_s * a;
      velocity += dt_s * a;
      if (until == middle_ns) at_middle = place;
      if (until == next->time_ns) ++next;
      now = until;
    }
    return (place - at_middle) / seconds(to_ns - middle_ns) - at_middle / seconds(middle_ns - from_ns);
  }

 private:
  Eigen::Quaterniond attitude(TimeNs time_ns) const {
    const auto earlier = [](const PoseState& pose, TimeNs time) { return pose.time_ns < time; };
    const auto after = std::lower_bound(attitudes_.begin(), attitudes_.end(), time_ns, earlier);
    if (after == attitudes_.end()) return attitudes_.back().orientation_W;
    if (after == attitudes_.begin()) return after->orientation_W;
    const PoseState &a = *(after - 1), &b = *after;
    return a.orientation_W.slerp(seconds(time_ns - a.time_ns) / seconds(b.time_ns - a.time_ns), b.orientation_W);
  }

  std::span<const ImuSample> samples_;
  Eigen::Vector3d gravity_W_m_s2_;
  std::vector<PoseState> attitudes_;
};

bool is_registered_in_map(const SweepResult& sweep) {
  return sweep.verdict == SweepVerdict::registered || sweep.verdict == SweepVerdict::degenerate;
}

template <class Sweeps>
std::size_t sweep_count_in_duration(double span_s, const Sweeps& sweeps) {
  if (sweeps.size() < 2) return 1;
  const double all_s = seconds(sweeps.back().pose.time_ns - sweeps.front().pose.time_ns);
  const double count = span_s * static_cast<double>(sweeps.size() - 1) / std::max(all_s, 1e-9);
  return static_cast<std::size_t>(std::clamp(std::round(count), 1.0, static_cast<double>(sweeps.size())));
}

template <class Sweeps>
std::optional<Change> velocity_change_until(std::size_t last, std::size_t span, const Sweeps& sweeps,
                                            const ImuMotion& imu_motion) {
  for (std::size_t k = last - 2 * span; k <= last; ++k) {
    if (!is_registered_in_map(sweeps[k])) return std::nullopt;
  }
  const PoseState &from = sweeps[last - 2 * span].pose, &middle = sweeps[last - span].pose, &to = sweeps[last].pose;
  if (!(from.time_ns < middle.time_ns && middle.time_ns < to.time_ns)) return std::nullopt;
  const auto by_imu = imu_motion.velocity_change(from.time_ns, middle.time_ns, to.time_ns);
  if (!by_imu || !(by_imu->norm() >= kChange_m_s)) return std::nullopt;
  return Change{to.time_ns, *by_imu,
                (to.position_W_m - middle.position_W_m) / seconds(to.time_ns - middle.time_ns) -
                    (middle.position_W_m - from.position_W_m) / seconds(middle.time_ns - from.time_ns),
                imu_motion.acceleration_sigma_m_s2(middle)};
}

template <class Changes>
int disjoint_velocity_changes(const Changes& changes) {
  int count = 0;
  std::optional<TimeNs> last_ns;
  for (const Change& change : changes) {
    if (last_ns && seconds(change.time_ns - *last_ns) < 2.0 * kSpan_s) continue;
    last_ns = change.time_ns;
    ++count;
  }
  return count;
}

/// Returns the variance of the score (weighted residuals times velocity changes) for correlated residuals (Newey and
/// West, 1987).
template <class Changes>
double score_variance(const Changes& changes, const std::vector<Eigen::Vector3d>& weighted) {
  double variance = 0.0;
  for (std::size_t k = 0; k < changes.size(); ++k) {
    for (std::size_t l = k + 1; l-- > 0;) {
      const double pair = 1.0 - seconds(changes[k].time_ns - changes[l].time_ns) / (2.0 * kSpan_s);
      if (pair <= 0.0) break;
      const double product = weighted[k].dot(weighted[l]) *
                             changes[k].imu_velocity_change_m_s.dot(changes[l].imu_velocity_change_m_s) / 3.0;
      variance += (k == l ? 1.0 : 2.0) * pair * product;
    }
  }
  return variance;
}

template <class Changes>
LidarScale fit(const Changes& changes) {
  LidarScale out;
  out.velocity_change_count = changes.size();
  const int disjoint = disjoint_velocity_changes(changes);
  if (changes.size() < kChangesMin || disjoint < kDisjointMin) return out;
  std::vector<Eigen::Vector3d> residuals(changes.size());
  std::vector<double> sizes(changes.size());
  for (int i = 0; i < kIterations; ++i) {
    for (std::size_t k = 0; k < changes.size(); ++k) {
      residuals[k] = changes[k].lidar_velocity_change_m_s - out.scale * changes[k].imu_velocity_change_m_s;
      sizes[k] = residuals[k].norm();
    }
    std::vector<double> sorted = sizes;
    std::nth_element(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2), sorted.end());
    const double deviation = std::max(1e-6, kPerMedian * sorted[sorted.size() / 2]);
    double together = 0.0, squared = 0.0;
    Eigen::Vector3d by_bias = Eigen::Vector3d::Zero();
    for (std::size_t k = 0; k < changes.size(); ++k) {
      const double weight = std::min(1.0, kHuber * deviation / std::max(sizes[k], 1e-12));
      together += weight * changes[k].imu_velocity_change_m_s.dot(changes[k].lidar_velocity_change_m_s);
      squared += weight * changes[k].imu_velocity_change_m_s.squaredNorm();
      by_bias += weight * kSpan_s * changes[k].acceleration_sigma_m_s2 * changes[k].imu_velocity_change_m_s;
      residuals[k] *= weight;
    }
    out.scale = together / squared;
    if (i + 1 < kIterations) continue;
    // The variance from n disjoint velocity changes is multiplied by n / (n - 1), because the fit estimates one
    // parameter, the scale.
    const double residual = score_variance(changes, residuals) * disjoint / (disjoint - 1.0);
    out.sigma = std::sqrt(residual + by_bias.squaredNorm()) / squared;
  }
  return out;
}

// If the covariances are correct, the chi-square value of the innovation (9 degrees of freedom) exceeds 32.9 at least
// twice in 1000 sweeps with a probability of 1 %.
constexpr double kContradictionChi2Min = 32.9;

// Wrong point times or a wrong lidar mounting distort sweeps. Few points of a distorted sweep fit the map, and the
// registered poses are noisy. If point times and mounting are correct, the mean inlier ratio of the simulated runs is
// at least 0.37.
constexpr double kInlierRatioMin = 0.2, kMeanInnovationMax = 0.2;
constexpr std::size_t kMeanSweepsMin = 20, kMeanSweepsMax = 50;

double innovation_max() {
  return std::sqrt(kContradictionChi2Min / RegistrationUnknowns::kMotionSize);
}

Status misfit(double inlier_ratio) {
  return {ErrorCode::out_of_range, "mean fraction of points on the map, in sweeps with a large innovation",
          inlier_ratio, kInlierRatioMin};
}

}  // namespace

bool LidarScale::is_inconsistent() const {
  return std::abs(scale - 1.0) > std::max(kLeast, kScaleDeviations * sigma);
}

Status LidarScale::verdict() const {
  if (!is_inconsistent()) return {};
  const double bound = std::max(kLeast, kScaleDeviations * sigma);
  return {ErrorCode::out_of_range, "scale of the lidar's ranges relative to the motion measured by the IMU", scale,
          scale > 1.0 ? 1.0 + bound : 1.0 - bound};
}

LidarScale find_sweep_scale(std::span<const ImuSample> samples, std::span<const SweepResult> sweeps,
                            double gravity_m_s2) {
  std::vector<Change> changes;
  const ImuMotion imu_motion(samples, sweeps, gravity_m_s2);
  const std::size_t span = sweep_count_in_duration(kSpan_s, sweeps);
  for (std::size_t k = 2 * span; k < sweeps.size(); ++k) {
    if (const auto change = velocity_change_until(k, span, sweeps, imu_motion)) changes.push_back(*change);
  }
  return fit(changes);
}

LidarScaleEstimator::LidarScaleEstimator(double gravity_m_s2, std::size_t samples_max)
    : gravity_m_s2_(gravity_m_s2), samples_max_(samples_max) {
  samples_.reserve(samples_max_);
}

void LidarScaleEstimator::add(const ImuSample& sample) {
  if (samples_.size() >= samples_max_) {  // the lidar has stopped delivering sweeps
    samples_.clear();
    sweeps_.clear();
  }
  samples_.push_back(sample);
}

void LidarScaleEstimator::add(const SweepResult& sweep) {
  SweepResult& kept = sweeps_.emplace_back();
  kept.pose = sweep.pose;
  kept.verdict = sweep.verdict;
  kept.trajectory = sweep.trajectory;
  const std::size_t span = std::min(sweep_count_in_duration(kSpan_s, sweeps_), kSpanMax);
  while (sweeps_.size() > 2 * span + 1) sweeps_.pop_front();
  const TimeNs from_ns = sweeps_.front().pose.time_ns;
  std::erase_if(samples_, [&](const ImuSample& earlier) { return earlier.time_ns <= from_ns; });
  const auto is_old = [&](const Change& change) {
    return seconds(sweep.pose.time_ns - change.time_ns) > kForgettingTime_s;
  };
  if (std::erase_if(velocity_changes_, is_old) > 0) scale_ = fit(velocity_changes_);
  if (sweeps_.size() < 2 * span + 1) return;
  const ImuMotion imu_motion(samples_, sweeps_, gravity_m_s2_);
  const std::optional<Change> change = velocity_change_until(2 * span, span, sweeps_, imu_motion);
  if (!change) return;
  velocity_changes_.push_back(*change);
  if (velocity_changes_.size() > kChangesMax) velocity_changes_.pop_front();
  scale_ = fit(velocity_changes_);
}

void Localisation::add(const SweepResult& sweep) {
  map_started_ = map_started_ || sweep.verdict != SweepVerdict::rejected;
  if (!map_started_) return;
  const double variance_m2 = sweep.pose.covariance.topLeftCorner<3, 3>().trace();
  largest_sigma_m_ = std::max(largest_sigma_m_, std::sqrt(variance_m2));
  second_largest_innovation_ =
      std::max(second_largest_innovation_, std::min(largest_innovation_, sweep.normalised_innovation));
  largest_innovation_ = std::max(largest_innovation_, sweep.normalised_innovation);
  observe_fit(sweep);
  sigma_m_ = sweep.position_in_map_sigma_m;
  newest_ns_ = sweep.pose.time_ns;
  if (!(sigma_m_ > distance_when_localised_m_))
    lost_since_ns_.reset();
  else if (!lost_since_ns_)
    lost_since_ns_ = newest_ns_;
  if (!(sweep.normalised_innovation > innovation_max())) return;
  previous_contradicted_sweep_ns_ = last_contradicted_sweep_ns_;
  last_contradicted_sweep_ns_ = newest_ns_;
}

void Localisation::observe_fit(const SweepResult& sweep) {
  if (!(sweep.normalised_innovation > 0.0)) return;
  aligned_sweeps_ = std::min(aligned_sweeps_ + 1, kMeanSweepsMax);
  const double share = 1.0 / static_cast<double>(aligned_sweeps_);
  mean_inlier_ratio_ += share * (sweep.inlier_ratio - mean_inlier_ratio_);
  mean_innovation_ += share * (std::min(1.0, sweep.normalised_innovation) - mean_innovation_);
  if (!fit_verdict().ok()) smallest_inlier_ratio_ = std::min(smallest_inlier_ratio_, mean_inlier_ratio_);
}

Status Localisation::fit_verdict() const {
  const bool fits = mean_inlier_ratio_ >= kInlierRatioMin || mean_innovation_ <= kMeanInnovationMax;
  return aligned_sweeps_ < kMeanSweepsMin || fits ? Status{} : misfit(mean_inlier_ratio_);
}

Status Localisation::current_verdict() const {
  if (sigma_m_ > distance_when_localised_m_)
    return {ErrorCode::out_of_range, "standard deviation in m of the position in the map", sigma_m_,
            distance_when_localised_m_};
  if (!previous_contradicted_sweep_ns_ ||
      check_stamp_order(newest_ns_, *previous_contradicted_sweep_ns_, kForgettingTime_s).error_code == ErrorCode::gap)
    return fit_verdict();
  return {ErrorCode::out_of_range,
          "second-largest innovation of a sweep (registered minus predicted pose) in standard deviations",
          second_largest_innovation_, innovation_max()};
}

/// See mapping.md (R70), (R71).
Status Localisation::verdict() const {
  if (largest_sigma_m_ > distance_when_localised_m_)
    return {ErrorCode::out_of_range, "standard deviation in m of a sweep's position", largest_sigma_m_,
            distance_when_localised_m_};
  if (second_largest_innovation_ > innovation_max())
    return {ErrorCode::out_of_range,
            "second-largest innovation of a sweep (registered minus predicted pose) in standard deviations",
            second_largest_innovation_, innovation_max()};
  return smallest_inlier_ratio_ < kInlierRatioMin ? misfit(smallest_inlier_ratio_) : Status{};
}

}  // namespace tumble
