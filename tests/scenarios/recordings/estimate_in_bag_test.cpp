// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/scoring/estimate_in_bag.hpp"

#include "scenarios/estimates/estimate_file.hpp"
#include "scenarios/recordings/fixture_recording.hpp"

namespace tumble::scenarios {
namespace {

/// InBag has a body that moves steadily along x and turns about z, with a lidar that sees points at rest; the estimate
/// is the body's own poses, of the lidar, in a world that is turned by 0.5 rad and shifted.
class InBag : public test::TemporaryFolder {
 protected:
  InBag() {
    fixture::Numbers numbers;
    sim::Truth& truth = recording_.truth;
    truth.period_ns = kStep_ns;
    for (int k = 0; k <= 300; ++k) {
      const double t = 0.001 * k;
      truth.p_WB_m.emplace_back(2.0 * t, 0.5, 1.0);
      truth.q_WB.emplace_back(Eigen::AngleAxisd(3.0 * t, Eigen::Vector3d::UnitZ()));
      truth.v_WB_m_s.emplace_back(2.0, 0, 0);
      truth.w_WB_B_rad_s.emplace_back(0, 0, 3.0);
    }
    truth.surfaces = {"terrain", "rock"};
    fixture::add_lidar(numbers, recording_, "lidar", 3, 20);
    sim::LidarRecord& lidar = recording_.sensors.lidars[0];
    sim::LidarTruth& seen = truth.lidars[0];
    lidar.T_BL = seen.T_BL;
    for (std::size_t k = 0; k < lidar.position_L_m.size(); ++k) {
      lidar.offset_ns[k] = static_cast<std::uint32_t>(k % 20) * 5'000'000u;
      const std::int64_t time = lidar.sweep_start_ns[k / 20] + lidar.offset_ns[k];
      lidar.position_L_m[k] = (pose_of_lidar(time).inverse() * seen.hit_W_m[k].cast<double>()).cast<float>();
    }
    estimate_.frame = Frame::lidar;
    for (std::int64_t time = 0; time <= 300'000'000; time += 5'000'000) {
      const Isometry3d T = T_VW_ * pose_of_lidar(time);
      PoseState pose;
      pose.time_ns = time;
      pose.position_W_m = T.translation();
      pose.orientation_W = Quaterniond(T.linear());
      pose.covariance.diagonal() << 1, 2, 3, 0.01, 0.01, 0.04;
      estimate_.poses.push_back(pose);
    }
  }
  Isometry3d pose_of_body(std::int64_t time_ns) const {
    const auto k = static_cast<std::size_t>(time_ns / kStep_ns);
    Isometry3d T = Eigen::Isometry3d::Identity();
    T.linear() = recording_.truth.q_WB[k].toRotationMatrix();
    T.translation() = recording_.truth.p_WB_m[k];
    return T;
  }
  Isometry3d pose_of_lidar(std::int64_t time_ns) const {
    return pose_of_body(time_ns) * recording_.truth.lidars[0].T_BL;
  }
  struct InBagWhole {
    BagTrack track;
    std::vector<BagCloud> clouds;
  };
  /// Returns the bag with all of its clouds; points and truth are in a separate folder if `with_truth`, otherwise the
  /// points are in the record.
  InBagWhole placed(bool with_truth) {
    StoredTruth truth;
    std::vector<PointStore> points;
    sim::Sensors sensors = recording_.sensors;
    if (with_truth) {
      truth = fixture::stored_truth(recording_, folder_);
      points.emplace_back(folder_).take(sensors.lidars[0]);
    }
    InBagWhole out{in_bag("mine", estimate_, sensors, with_truth ? &points : nullptr, with_truth ? &truth : nullptr),
                   {}};
    for (std::size_t k = 0; k < out.track.cloud_time_ns.size(); ++k)
      out.clouds.push_back(out.track.cloud(out.track, k));
    return out;
  }
  static constexpr std::int64_t kStep_ns = 1'000'000;
  static Isometry3d turned() {
    Isometry3d T = Eigen::Isometry3d::Identity();
    T.linear() = Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    T.translation() = Vector3d(7, -3, 2);
    return T;
  }
  Isometry3d T_VW_ = turned();
  sim::Recording recording_;
  Estimate estimate_;
};

TEST_F(InBag, TheTruthAsAnEstimateHasNoError) {
  const InBagWhole found = placed(true);
  ASSERT_EQ(found.track.poses.size(), estimate_.poses.size());
  for (const BagTrack::Pose& pose : found.track.poses) {
    const Isometry3d T = pose_of_body(pose.time_ns);
    EXPECT_LT((pose.p_WB_m - T.translation()).norm(), 1e-9);
    EXPECT_LT(pose.q_WB.angularDistance(Quaterniond(T.linear())), 1e-7);
  }
  ASSERT_EQ(found.clouds.size(), 3u);
  std::size_t points = 0;
  for (std::size_t sweep = 0; sweep < 3; ++sweep) {
    EXPECT_EQ(found.track.cloud_time_ns[sweep], 100'000'000 * static_cast<std::int64_t>(sweep + 1));
    ASSERT_EQ(found.clouds[sweep].position_W_m.size(), 20u);
    for (std::size_t k = 0; k < 20; ++k, ++points) {
      const Vector3f& hit = recording_.truth.lidars[0].hit_W_m[points];
      EXPECT_LT((found.clouds[sweep].position_W_m[k] - hit).norm(), 1e-4f);  // float32 of some ten metres
      EXPECT_LT(found.clouds[sweep].error_m[k], 1e-4f);
    }
  }
}

// a later error must show with its size
TEST_F(InBag, AnErrorShowsWhereItIs) {
  for (PoseState& pose : estimate_.poses) {
    if (pose.time_ns >= 100'000'000) pose.position_W_m += T_VW_.linear() * Vector3d(0.3, 0, 0.4);
  }
  const InBagWhole found = placed(true);
  EXPECT_LT(found.clouds[0].error_m[5], 1e-4f);
  for (const std::size_t sweep : {1, 2}) {
    for (const float error : found.clouds[sweep].error_m) EXPECT_NEAR(error, 0.5f, 1e-4f);
  }
}

TEST_F(InBag, WithoutATruthNothingIsMovedAndNoErrorKnown) {
  const InBagWhole found = placed(false);
  for (const BagTrack::Pose& pose : found.track.poses)
    EXPECT_LT((pose.p_WB_m - (T_VW_ * pose_of_body(pose.time_ns)).translation()).norm(), 1e-9);
  ASSERT_EQ(found.clouds.size(), 3u);
  EXPECT_TRUE(found.clouds[0].error_m.empty());
}

// the test computes J C J^T by hand: the position's covariance gains that of the attitude over the lever arm, both
// turned into the truth's world
TEST_F(InBag, TheCovarianceIsTheBodys) {
  const Matrix3d R = T_VW_.linear().transpose();
  const BagTrack::Pose pose = placed(true).track.poses[10];
  const Isometry3d T_WL = pose_of_lidar(pose.time_ns);
  const Vector3d lever = pose.p_WB_m - T_WL.translation();
  const Matrix3d attitude = R * Vector3d(0.01, 0.01, 0.04).asDiagonal() * R.transpose();
  Matrix3d cross;
  cross << 0, -lever.z(), lever.y(), lever.z(), 0, -lever.x(), -lever.y(), lever.x(), 0;
  const Matrix3d place = R * Vector3d(1, 2, 3).asDiagonal() * R.transpose() + cross * attitude * cross.transpose();
  EXPECT_TRUE((pose.covariance.topLeftCorner<3, 3>()).isApprox(place, 1e-9));
  EXPECT_TRUE((pose.covariance.bottomRightCorner<3, 3>()).isApprox(attitude, 1e-9));
  EXPECT_GT((cross * attitude * cross.transpose()).norm(), 0.1) << "the lever matters";
}

TEST_F(InBag, ReturnsInAHoleAreLeftOut) {
  std::erase_if(estimate_.poses,
                [](const PoseState& pose) { return pose.time_ns > 20'000'000 && pose.time_ns < 260'000'000; });
  const InBagWhole found = placed(true);
  std::size_t points = 0;
  for (const BagCloud& cloud : found.clouds) points += cloud.position_W_m.size();
  EXPECT_EQ(points, 5u + 8u) << "at 0 to 20 ms and at 260 to 295 ms";
}

TEST_F(InBag, WhatCannotBePlacedIsRefused) {
  const auto complaint = [&] { return test::complaint([&] { placed(true); }); };
  const Estimate good = estimate_;
  estimate_.frame = Frame::imu;
  EXPECT_NE(complaint(), "");
  estimate_ = good;
  estimate_.poses.clear();
  EXPECT_THAT(complaint(), HasSubstr("contains no poses"));
  estimate_ = good;
  for (PoseState& pose : estimate_.poses) pose.time_ns += 1'000'000'000'000;
  EXPECT_THAT(complaint(), HasSubstr("check that truth and estimate use the same clock"));
}

TEST_F(InBag, FilesAreNamedAfterTheirMethods) {
  recording_.sensors.imus.clear();
  write_estimate(folder_ / "a", "mine", Kind::slam, estimate_, digest(recording_.sensors, nullptr));
  write_estimate(folder_ / "b", "mine", Kind::slam, estimate_, "");
  const StoredTruth truth = fixture::stored_truth(recording_, folder_);
  BagWriting writing{0, &truth};
  const fs::path paths[] = {folder_ / "a", folder_ / "b"};
  add_estimates(paths, recording_.sensors, writing);
  ASSERT_EQ(writing.tracks.size(), 2u);
  EXPECT_EQ(writing.tracks[0].name, "slam_mine");
  EXPECT_EQ(writing.tracks[1].name, "slam_mine_2");
  for (const BagTrack& track : writing.tracks) EXPECT_EQ(track.cloud_time_ns.size(), 3u);
  write_estimate(folder_ / "c", "mine", Kind::slam, estimate_, std::string(32, 'a'));
  const fs::path other[] = {folder_ / "c"};
  EXPECT_THAT(
      test::complaint([&] { add_estimates(other, recording_.sensors, writing); }),
      AllOf(HasSubstr("c: the estimate was made from a recording with digest"), HasSubstr(std::string(32, 'a'))));
}

}  // namespace
}  // namespace tumble::scenarios
