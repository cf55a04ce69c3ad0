// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/recordings/trajectories/reference.hpp"

#include "scenarios/recordings/export.hpp"
#include "scenarios/recordings/fixture_recording.hpp"
#include "scenarios/recordings/import.hpp"

namespace tumble::scenarios {
namespace {

/// Returns poses of a steady motion: 1 m/s along x, 0.5 rad/s about z, a pose every `step_ns`.
std::vector<ReferencePose> steady(std::int64_t first_ns, std::int64_t step_ns, int count) {
  std::vector<ReferencePose> poses;
  for (int k = 0; k < count; ++k) {
    const std::int64_t time = first_ns + k * step_ns;
    const double t = static_cast<double>(time) * 1e-9;
    poses.push_back({time, Vector3d(t, 0, 0), Quaterniond(Eigen::AngleAxisd(0.5 * t, Eigen::Vector3d::UnitZ()))});
  }
  return poses;
}

TEST(ReferenceTruth, PosesOnAGridComeBackAsTheyWere) {
  const std::vector<ReferencePose> poses = steady(0, 50000000, 21);
  const sim::Truth truth = reference_truth(poses, 5000000000);
  EXPECT_EQ(truth.period_ns, 50000000);
  ASSERT_EQ(truth.p_WB_m.size(), 21u);
  for (std::size_t k = 0; k < poses.size(); ++k) {
    EXPECT_EQ(truth.p_WB_m[k], poses[k].p_WA_m);
    EXPECT_EQ(truth.q_WB[k].coeffs(), poses[k].q_WA.coeffs());
    EXPECT_NEAR((truth.v_WB_m_s[k] - Eigen::Vector3d::UnitX()).norm(), 0.0, 1e-12);
    EXPECT_NEAR((truth.w_WB_B_rad_s[k] - 0.5 * Eigen::Vector3d::UnitZ()).norm(), 0.0, 1e-12);
  }
}

TEST(ReferenceTruth, OtherwiseItIsInterpolatedWhereTwoPosesAreNear) {
  std::vector<ReferencePose> poses = steady(20000123, 100000000, 11);
  poses.erase(poses.begin() + 4, poses.begin() + 7);  // a gap of 0.4 s
  const sim::Truth truth = reference_truth(poses, 5000000000);
  EXPECT_EQ(truth.period_ns, 1000000);
  int known = 0;
  for (std::size_t k = 0; k < truth.p_WB_m.size(); ++k) {
    const double t = static_cast<double>(k) * 1e-3;
    const bool expected = (t > 0.0200001 && t < 0.3200002) || t > 0.7200001;
    EXPECT_EQ(truth.p_WB_m[k].allFinite(), expected) << t;
    if (!expected) continue;
    ++known;
    EXPECT_NEAR((truth.p_WB_m[k] - Vector3d(t, 0, 0)).norm(), 0.0, 1e-9);
    EXPECT_NEAR(truth.q_WB[k].angularDistance(Quaterniond(Eigen::AngleAxisd(0.5 * t, Eigen::Vector3d::UnitZ()))), 0.0,
                1e-7);
  }
  EXPECT_EQ(known, 300 + 300);
}

TEST(ReferenceTruth, EndsWithTheSensorsAndMustMeetThem) {
  EXPECT_EQ(reference_truth(steady(0, 50000000, 21), 400000000).p_WB_m.size(), 9u);
  const auto complaint = [](const std::vector<ReferencePose>& poses) {
    return test::complaint([&] { reference_truth(poses, 1000000000); });
  };
  EXPECT_THAT(complaint(steady(2000000000, 50000000, 3)), HasSubstr("check that both use the same clock"));
  EXPECT_THAT(complaint(steady(-2000000000, 50000000, 3)), HasSubstr("check that both use the same clock"));
  EXPECT_THAT(complaint({}), HasSubstr("contains no pose"));
  EXPECT_THAT(
      test::complaint([] { reference_truth(steady(0, 50000000000000, 3), std::numeric_limits<std::int64_t>::max()); }),
      HasSubstr("at most one day"));
}

using Reference = test::TemporaryFolder;

TEST_F(Reference, TumWrittenByExportComesBackToTheBit) {
  const sim::Truth given = fixture::recording().truth;
  export_tum(given, folder_ / "truth.tum");
  EXPECT_EQ(pose_format(folder_ / "truth.tum"), "tum");
  const Imported imported = import_trajectory({folder_ / "truth.tum", "tum", true, false, {}, 0});
  EXPECT_TRUE(imported.sensors.imus.empty());
  EXPECT_TRUE(imported.sensors.lidars.empty());
  ASSERT_TRUE(imported.reference.has_value());
  EXPECT_EQ(imported.reference->period_ns, given.period_ns);
  EXPECT_EQ(imported.reference->p_WB_m, given.p_WB_m);
  ASSERT_EQ(imported.reference->q_WB.size(), given.q_WB.size());
  for (std::size_t k = 0; k < given.q_WB.size(); ++k)
    EXPECT_EQ(imported.reference->q_WB[k].coeffs(), given.q_WB[k].coeffs()) << k;
  write_recording(folder_ / "a.h5", imported.info, imported.sensors, &*imported.reference);
  EXPECT_EQ(read_truth(folder_ / "a.h5").p_WB_m, given.p_WB_m);
}

TEST_F(Reference, KittiWrittenByExportComesBack) {
  const sim::Truth given = fixture::recording().truth;
  export_kitti(given, folder_ / "truth.txt");
  EXPECT_EQ(pose_format(folder_ / "truth.txt"), "kitti");
  const Imported imported = import_trajectory({folder_ / "truth.txt", "kitti", true, false, {}, given.period_ns});
  EXPECT_EQ(imported.reference->period_ns, given.period_ns);
  EXPECT_EQ(imported.reference->p_WB_m, given.p_WB_m);
  // the quaternion is converted to a matrix and back: measured 3e-16
  for (std::size_t k = 0; k < given.q_WB.size(); ++k)
    EXPECT_NEAR(std::abs(imported.reference->q_WB[k].dot(given.q_WB[k])), 1.0, 1e-14) << k;
  EXPECT_THAT(test::complaint([&] {
                import_trajectory({folder_ / "truth.txt", "kitti", true, false, {}, 0});
              }),
              HasSubstr("the KITTI format has no times; give a file of time stamps (--times)"));
}

TEST_F(Reference, BadLinesAreNamed) {
  const auto complaint = [&](const std::string& text) {
    fixture::put(folder_ / "a.txt", text);
    return test::complaint([&] { read_tum_poses(folder_ / "a.txt", false); });
  };
  const std::string good = "# t x y z q\n1.0 0 0 0 0 0 0 1\n1.5 1 0 0 0 0 0 1\n";
  EXPECT_EQ(complaint(good), "");
  EXPECT_THAT(complaint(good + "1.5 1 0 0 0 0 0 1\n"),
              HasSubstr("a.txt:4: the time stamp 1500000000 ns must be larger than"));
  EXPECT_THAT(complaint(good + "1.2 1 0 0 0 0 0 1\n"),
              HasSubstr("a.txt:4: the time stamp 1200000000 ns must be larger than"));
  EXPECT_THAT(complaint(good + "1.6 nan 0 0 0 0 0 1\n"), HasSubstr("a.txt:4: the pose is not finite"));
  EXPECT_THAT(complaint(good + "1.6 0 -1e308 0 0 0 0 1\n"),
              HasSubstr("a.txt:4: the position of this pose is 1e+308 m from the origin; it must be within 1e+09 m"));
  EXPECT_THAT(complaint(good + "1.6 0 0 0 0 0 0 2\n"), HasSubstr("a.txt:4: the norm of this pose's quaternion is 2.0"));
  EXPECT_THAT(complaint(good + "1.6 0 0 0 0 0 0\n"), HasSubstr("a.txt:4: the row has 7 columns; it must have 8"));
  fixture::put(folder_ / "a.txt", good + "1.6 nan nan nan nan nan nan nan\n1.7 0 0 0 0 0 0 1\n");
  EXPECT_EQ(read_tum_poses(folder_ / "a.txt", false).size(), 3u) << "an optical system may lose sight of its markers";
  EXPECT_THAT(complaint("1.0 0 0 0 0 0 0 1\n"), HasSubstr("has 1 poses; it needs at least 2"));
  fixture::put(folder_ / "a.txt", good + "1.2 5 0 0 0 0 0 1\n1.5 9 0 0 0 0 0 1\n");
  const auto sorted = read_tum_poses(folder_ / "a.txt", true);
  ASSERT_EQ(sorted.size(), 3u);
  EXPECT_EQ(sorted[1].p_WA_m.x(), 5.0);
  EXPECT_EQ(sorted[2].p_WA_m.x(), 1.0) << "of equal stamps the first";
  fixture::put(folder_ / "k.txt", "1 0 0 0 0 1 0 0 0 0 1 0\n2 0 0 0 0 1 0 0 0 0 1 0\n");
  EXPECT_THAT(test::complaint([&] {
                read_kitti_poses(folder_ / "k.txt", {0, 1});
              }),
              HasSubstr("k.txt:2: the first three columns of the matrix differ from a rotation by 3.0"));
  EXPECT_THAT(test::complaint([&] {
                read_kitti_poses(folder_ / "k.txt", {0, 1, 2});
              }),
              HasSubstr("has 2 poses, but there are 3 times"));
  fixture::put(folder_ / "c.txt", "1 2 3\n");
  EXPECT_THAT(test::complaint([&] { pose_format(folder_ / "c.txt"); }),
              HasSubstr("has 3 numbers. A line of a TUM file has 8"));
}

TEST_F(Reference, PosesOfTheLidarBecomePosesOfTheBody) {
  sim::Recording recording = fixture::recording();
  export_ply(recording.sensors, folder_ / "sweeps");
  SweepSource source;
  source.folder = folder_ / "sweeps";
  source.format = "ply";
  source.reading.device.T_BL = recording.sensors.lidars[0].T_BL;
  Imported imported = import_sweeps(source);
  fixture::put(folder_ / "poses.tum", "0 1 2 3 0 0 0 1\n0.1 1 2 3 0 0 0 1\n0.2 1 2 3 0 0 0 1\n");
  attach_reference(imported, {folder_ / "poses.tum", "tum", false, false, {}, 0});
  const Isometry3d T_WB = Eigen::Translation3d(1, 2, 3) * recording.sensors.lidars[0].T_BL.inverse(Eigen::Isometry);
  const sim::Truth& truth = *imported.reference;
  ASSERT_EQ(truth.p_WB_m.size(), 3u);
  EXPECT_NEAR((truth.p_WB_m[1] - T_WB.translation()).norm(), 0.0, 1e-12);
  EXPECT_NEAR(truth.q_WB[1].angularDistance(Quaterniond(T_WB.linear())), 0.0, 1e-7);
  ASSERT_EQ(truth.lidars.size(), 1u);
  EXPECT_EQ(truth.lidars[0].T_BL.matrix(), source.reading.device.T_BL.matrix());
  // the recording can be used like any other, and the frame makes a difference
  write_recording(folder_ / "a.h5", imported.info, imported.sensors, &truth);
  EXPECT_EQ(read_truth(folder_ / "a.h5").period_ns, 100000000);
  attach_reference(imported, {folder_ / "poses.tum", "tum", true, false, {}, 0});
  EXPECT_EQ(imported.reference->p_WB_m[1], Vector3d(1, 2, 3));
  fixture::put(folder_ / "two.txt", "1 0 0 0 0 1 0 0 0 0 1 0\n1 0 0 0 0 1 0 0 0 0 1 0\n");
  EXPECT_THAT(test::complaint([&] {
                attach_reference(imported, {folder_ / "two.txt", "kitti", false, false, {}, 0});
              }),
              HasSubstr("has 2 poses, but there are 3 times"));
}

}  // namespace
}  // namespace tumble::scenarios
