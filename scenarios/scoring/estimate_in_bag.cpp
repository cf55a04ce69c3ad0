// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/scoring/estimate_in_bag.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <set>

#include "scenarios/errors.hpp"
#include "scenarios/estimates/estimate_clock.hpp"
#include "scenarios/estimates/estimate_file.hpp"
#include "scenarios/recordings/export_names.hpp"
#include "scenarios/recordings/recording_clock.hpp"
#include "scenarios/recordings/recording_file.hpp"
#include "scenarios/scoring/truth_track.hpp"

namespace tumble::scenarios {

namespace {

constexpr std::int64_t kHole_ns = 200000000;

Eigen::Isometry3d mounting_of(const Estimate& estimate, const sim::Sensors& sensors, const StoredTruth* truth) {
  Eigen::Isometry3d T_BA = Eigen::Isometry3d::Identity();
  switch (estimate.frame) {
    case Frame::body:
      break;
    case Frame::centre:
      T_BA.translation() = truth != nullptr ? truth->p_BG_m : estimate.centre_B_m;
      break;
    case Frame::imu:
      if (sensors.imus.empty()) throw BadInput("the estimate contains poses of an IMU, but the recording has no IMU");
      return sensors.imus.front().T_BI;
    case Frame::lidar:
      if (sensors.lidars.empty())
        throw BadInput("the estimate contains poses of a lidar, but the recording has no lidar");
      return sensors.lidars.front().T_BL;
  }
  return T_BA;
}

Alignment alignment_of(const Estimate& estimate, const StoredTruth* truth) {
  if (truth == nullptr) return {};
  for (const PoseState& pose : estimate.poses) {
    const std::size_t before = static_cast<std::size_t>(std::max<std::int64_t>(pose.time_ns, 0) / truth->period_ns);
    if (pose.time_ns < 0 || before >= truth->size()) continue;
    const sim::Truth around = truth->states(before, std::min(before + 2, truth->size()));
    const TruthTrack track(around, estimate.frame);
    const std::int64_t after_ns = pose.time_ns % truth->period_ns;
    if (track.covers(after_ns)) return Alignment::at(pose, track.pose(after_ns));
  }
  throw BadInput(
      "no pose of the estimate is within the duration of the truth; check that truth and estimate use the same clock");
}

PoseState moved_by(const Alignment& alignment, const PoseState& pose) {
  PoseState out = alignment.apply(pose);
  Eigen::Matrix<double, 6, 6> turn = Eigen::Matrix<double, 6, 6>::Zero();
  turn.topLeftCorner<3, 3>() = turn.bottomRightCorner<3, 3>() = alignment.transform().linear();
  out.covariance = turn * pose.covariance * turn.transpose();
  return out;
}

BagTrack::Pose body_pose(PoseState moved, const Eigen::Isometry3d& T_AB) {
  moved.orientation_W.normalize();
  const PoseState body = moved.transformed_to(T_AB, Eigen::Vector3d::Zero());  // the velocity is not used
  BagTrack::Pose out;
  out.time_ns = body.time_ns;
  out.p_WB_m = body.position_W_m;
  out.q_WB = body.orientation_W.normalized();
  out.covariance = body.covariance;
  return out;
}

class BodyAt {
 public:
  explicit BodyAt(const std::vector<BagTrack::Pose>& poses) : poses_(poses) {}
  bool operator()(std::int64_t time_ns, Eigen::Isometry3d& T_WB) const {
    const auto after = std::lower_bound(poses_.begin(), poses_.end(), time_ns,
                                        [](const BagTrack::Pose& pose, std::int64_t t) { return pose.time_ns < t; });
    if (after == poses_.end() || (after == poses_.begin() && after->time_ns != time_ns)) return false;
    const auto before = after->time_ns == time_ns ? after : std::prev(after);
    const std::int64_t step_ns = after->time_ns - before->time_ns;
    if (step_ns > kHole_ns) return false;
    const double share =
        step_ns > 0 ? static_cast<double>(time_ns - before->time_ns) / static_cast<double>(step_ns) : 0;
    T_WB.setIdentity();
    T_WB.linear() = before->q_WB.slerp(share, after->q_WB).toRotationMatrix();
    T_WB.translation() = before->p_WB_m + share * (after->p_WB_m - before->p_WB_m);
    return true;
  }

 private:
  const std::vector<BagTrack::Pose>& poses_;
};

BagCloud cloud_of(const BagTrack& track, const sim::LidarRecord& sweep, const std::vector<Eigen::Vector3f>& hit_W_m) {
  const BodyAt body_at(track.poses);
  BagCloud cloud;
  for (std::size_t k = 0; k < sweep.position_L_m.size(); ++k) {
    Eigen::Isometry3d T_WB;
    if (!body_at(sweep.sweep_start_ns[0] + sweep.offset_ns[k], T_WB)) continue;
    const Eigen::Vector3d position_W_m = T_WB * (sweep.T_BL * sweep.position_L_m[k].cast<double>());
    cloud.position_W_m.push_back(position_W_m.cast<float>());
    if (!hit_W_m.empty())
      cloud.error_m.push_back(static_cast<float>((position_W_m - hit_W_m[k].cast<double>()).norm()));
  }
  return cloud;
}

void add_clouds(const sim::Sensors& sensors, const std::vector<PointStore>* points, const StoredTruth* truth,
                BagTrack& track) {
  if (sensors.lidars.empty()) return;
  const sim::LidarRecord& lidar = sensors.lidars.front();
  const PointStore* aside = points != nullptr ? &points->front() : nullptr;
  const std::uint64_t count = lidar.sweep_first.empty() ? 0 : lidar.sweep_first.back();
  const bool known = truth != nullptr && !truth->lidars.empty() && truth->lidars.front().hit_W_m.size() == count;
  for (const std::int64_t start_ns : lidar.sweep_start_ns)
    track.cloud_time_ns.push_back(start_ns + lidar.sweep_period_ns);
  track.cloud = [&lidar, aside, hits = known ? &truth->lidars.front().hit_W_m : nullptr](const BagTrack& own,
                                                                                         std::size_t sweep) {
    const std::uint64_t first = lidar.sweep_first[sweep], last = lidar.sweep_first[sweep + 1];
    return cloud_of(own, sweep_alone(lidar, aside, sweep),
                    hits != nullptr ? hits->rows(first, last) : std::vector<Eigen::Vector3f>());
  };
}

void require_own(const std::filesystem::path& path, const std::string& own) {
  const std::string made_from = estimated_sensors(path);
  if (made_from.empty() || made_from == own) return;
  throw BadInput(
      fmt::format("the estimate was made from a recording with digest {}, but this recording has digest {}; use the "
                  "recording of the estimate",
                  made_from, own));
}

std::string plain_name(const std::string& method) {
  std::string stem;
  for (const char c : method) stem += std::isalnum(static_cast<unsigned char>(c)) != 0 ? c : '_';
  if (stem.empty() || std::isdigit(static_cast<unsigned char>(stem.front())) != 0) stem.insert(0, "estimate_");
  return stem;
}

}  // namespace

BagTrack in_bag(const std::string& name, const Estimate& estimate, const sim::Sensors& sensors,
                const std::vector<PointStore>* points, const StoredTruth* truth) {
  if (estimate.poses.empty())
    throw BadInput(
        "the estimate contains no poses that a bag could store; choose an estimate of a position or slam method");
  const Eigen::Isometry3d T_AB = mounting_of(estimate, sensors, truth).inverse();
  const Alignment alignment = alignment_of(estimate, truth);
  BagTrack out;
  out.name = name;
  for (const PoseState& pose : estimate.poses) {
    if (!pose.position_W_m.allFinite() || !pose.orientation_W.coeffs().allFinite()) continue;
    out.poses.push_back(body_pose(moved_by(alignment, pose), T_AB));
  }
  add_clouds(sensors, points, truth, out);
  return out;
}

void add_estimates(std::span<const std::filesystem::path> paths, const sim::Sensors& sensors, BagWriting& writing) {
  std::set<std::string> taken = export_names(sensors).taken;
  const std::string own =
      writing.points != nullptr ? digest(sensors, *writing.points, nullptr) : digest(sensors, nullptr);
  const StampSpan span =
      writing.truth == nullptr
          ? span_of(sensors)
          : StampSpan{0, writing.truth->period_ns * (static_cast<std::int64_t>(writing.truth->size()) - 1)};
  for (const std::filesystem::path& path : paths) {
    Kind kind{};
    std::string method;
    Estimate estimate = read_estimate(path, kind, method, sensors.imus.empty() ? Frame::body : Frame::imu);
    move_to_clock(writing.origin_ns, span, estimate);
    try {
      require_own(path, own);
      const bool of_file = !std::filesystem::is_directory(path);
      const std::string name = plain_name((of_file ? "" : std::string(to_string(kind)) + "_") + method);
      writing.tracks.push_back(in_bag(free_name(name, taken), estimate, sensors, writing.points, writing.truth));
    } catch (const BadInput& error) {
      throw BadInput(path.string() + ": " + error.what());
    }
  }
}

}  // namespace tumble::scenarios
