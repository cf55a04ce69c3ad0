// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "scenarios/errors.hpp"
#include "scenarios/not_finite.hpp"
#include "scenarios/recordings/clouds/sweep_stamps.hpp"
#include "scenarios/recordings/trajectories/reference.hpp"

namespace tumble::scenarios {

namespace {

constexpr std::int64_t kStepMin_ns = 100000, kStepUsual_ns = 1000000;
constexpr std::int64_t kSamplesMax = 2000000;
constexpr std::int64_t kLongestReference_ns = 86400ll * 1000000000;
/// Poses are differentiated over twice this interval, so that the noise of an optical reference at rest is below the
/// thresholds for rest.
constexpr std::int64_t kReach_ns = 70000000;

std::vector<std::int64_t> times_of(const std::vector<ReferencePose>& poses) {
  std::vector<std::int64_t> times;
  for (const ReferencePose& pose : poses) times.push_back(pose.time_ns);
  return times;
}

std::int64_t grid_step(const std::vector<std::int64_t>& times, std::int64_t end_ns) {
  std::int64_t step = std::numeric_limits<std::int64_t>::max();
  for (std::size_t k = 1; k < times.size(); ++k) step = std::min(step, times[k] - times[k - 1]);
  const auto on_grid = [&](std::int64_t time) { return time % step == 0; };
  const bool own = step >= kStepMin_ns && std::all_of(times.begin(), times.end(), on_grid);
  if (own && end_ns / step < kSamplesMax) return step;
  const std::int64_t usual_steps = end_ns / kStepUsual_ns / kSamplesMax + 1;
  return usual_steps * kStepUsual_ns;
}

class Interpolation {
 public:
  Interpolation(const std::vector<ReferencePose>& poses, std::int64_t gap_ns) : poses_(poses), gap_ns_(gap_ns) {}

  ReferencePose at(std::int64_t time_ns) {
    while (next_ < poses_.size() && poses_[next_].time_ns < time_ns) ++next_;
    ReferencePose out{time_ns, Eigen::Vector3d::Constant(kNaN), {}};
    out.q_WA.coeffs().setConstant(kNaN);
    if (next_ == poses_.size()) return out;
    const ReferencePose& after = poses_[next_];
    if (after.time_ns == time_ns) return after;
    if (next_ == 0 || after.time_ns - poses_[next_ - 1].time_ns > gap_ns_) return out;
    const ReferencePose& before = poses_[next_ - 1];
    const double share =
        static_cast<double>(time_ns - before.time_ns) / static_cast<double>(after.time_ns - before.time_ns);
    out.p_WA_m = (1.0 - share) * before.p_WA_m + share * after.p_WA_m;
    out.q_WA = before.q_WA.slerp(share, after.q_WA);
    return out;
  }

 private:
  const std::vector<ReferencePose>& poses_;
  std::int64_t gap_ns_;
  std::size_t next_ = 0;
};

Eigen::Vector3d rotation_vector(const Eigen::Quaterniond& q) {
  const Eigen::AngleAxisd turn(q);
  return turn.angle() * turn.axis();
}

void differentiate(sim::Truth& truth, std::size_t reach) {
  const Eigen::Vector3d unknown = Eigen::Vector3d::Constant(kNaN);
  const std::size_t count = truth.q_WB.size();
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t before = k > reach ? k - reach : 0, after = std::min(k + reach, count - 1);
    const double span_s = static_cast<double>(after - before) * static_cast<double>(truth.period_ns) * 1e-9;
    const Eigen::Quaterniond turn = truth.q_WB[before].conjugate() * truth.q_WB[after];
    const Eigen::Quaterniond to_here = truth.q_WB[k].conjugate() * truth.q_WB[before];
    const bool known = turn.coeffs().allFinite() && to_here.coeffs().allFinite() && after > before;
    truth.w_WB_B_rad_s.push_back(known ? Eigen::Vector3d(to_here * rotation_vector(turn) / span_s) : unknown);
    truth.v_WB_m_s.push_back(known ? Eigen::Vector3d((truth.p_WB_m[after] - truth.p_WB_m[before]) / span_s) : unknown);
  }
}

}  // namespace

sim::Truth reference_truth(const std::vector<ReferencePose>& poses, std::int64_t end_ns) {
  if (poses.empty()) throw BadInput("the reference file contains no pose with known position and attitude");
  const std::int64_t last_ns = std::min(end_ns, poses.back().time_ns);
  if (last_ns < 0 || poses.front().time_ns > end_ns) {
    throw BadInput(fmt::format(
        "the reference covers {} to {} ns of the recording, which lasts {} ns; check that both use the same clock",
        poses.front().time_ns, poses.back().time_ns, end_ns));
  }
  if (last_ns > kLongestReference_ns) {
    throw BadInput(fmt::format("the reference lasts {} ns; it must be at most one day", last_ns));
  }
  const std::vector<std::int64_t> times = times_of(poses);
  sim::Truth truth;
  truth.period_ns = grid_step(times, last_ns);
  Interpolation reference(poses, median_step_ns(times) * 5 / 2);
  for (std::int64_t time = 0; time <= last_ns; time += truth.period_ns) {
    const ReferencePose pose = reference.at(time);
    truth.p_WB_m.push_back(pose.p_WA_m);
    truth.q_WB.push_back(pose.q_WA);
  }
  const auto known = [](const Eigen::Quaterniond& q) { return q.coeffs().allFinite(); };
  if (std::none_of(truth.q_WB.begin(), truth.q_WB.end(), known)) {
    throw BadInput("the poses of the reference are too far apart in time for a comparison with the gyro");
  }
  differentiate(truth, static_cast<std::size_t>(std::max<std::int64_t>(kReach_ns / truth.period_ns, 1)));
  return truth;
}

}  // namespace tumble::scenarios
