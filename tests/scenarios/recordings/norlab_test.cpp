// SPDX-License-Identifier: BSD-3-Clause
// The test checks clouds of libpointmatcher (VTK) and tables of nav_msgs/Odometry, as norlab's mapper writes them.
#include "scenarios/recordings/clouds/import_sweeps.hpp"
#include "scenarios/recordings/fixture_recording.hpp"
#include "scenarios/recordings/import.hpp"
#include "stand_ins/stand_ins.hpp"

namespace tumble::scenarios {
namespace {

class Norlab : public testing::TestWithParam<test::DataFolder> {
 protected:
  Imported import(const char* poses) const {
    const fs::path folder = test::written(GetParam());
    SweepSource source;
    source.folder = folder;
    source.format = "vtk";
    source.reading.device.name = "lidar";
    Imported out = import_sweeps(source);
    ReferenceSource reference;
    reference.file = folder / poses;
    reference.format = pose_format(reference.file);
    attach_reference(out, reference);
    return out;
  }
};

/// Returns the lidar's pose at a time of the recording, interpolated between the truth's samples.
Isometry3d pose_at(const sim::Truth& truth, double time_ns) {
  const double at = time_ns / static_cast<double>(truth.period_ns);
  const auto i = std::min(static_cast<std::size_t>(at), truth.p_WB_m.size() - 2);
  const double share = at - static_cast<double>(i);
  Isometry3d out = Eigen::Isometry3d::Identity();
  out.linear() = truth.q_WB[i].slerp(share, truth.q_WB[i + 1]).toRotationMatrix();
  out.translation() = (1.0 - share) * truth.p_WB_m[i] + share * truth.p_WB_m[i + 1];
  return out;
}

TEST_P(Norlab, TheFolderIsTakenAsItIs) {
  const Imported imported = import("trajectory.csv");
  const sim::LidarRecord& lidar = imported.sensors.lidars.at(0);
  EXPECT_EQ(lidar.sweep_start_ns.size(), 6u);
  EXPECT_NEAR(static_cast<double>(lidar.sweep_period_ns), 1e8, 6e5);
  EXPECT_EQ(lidar.point_times, sim::PointTimes::measured);
  EXPECT_EQ(imported.info.origin_ns, 1690309709'285305600);
  const auto last = *std::max_element(lidar.offset_ns.begin(), lidar.offset_ns.end());
  EXPECT_NEAR(last, 1e8, 1e6) << "t is in nanoseconds";
  EXPECT_LE(last, lidar.sweep_period_ns) << "of the real one a sweep lasts longer than the median step";
  EXPECT_LE(*std::max_element(lidar.intensity.begin(), lidar.intensity.end()), 1.0f);
  if (GetParam().real) {
    EXPECT_EQ(lidar.sweep_first[1], 41400u) << "POINTS of the first file";
    EXPECT_EQ(lidar.position_L_m[0], Vector3f(4.39017f, -0.830303f, -0.814437f)) << "its first line";
  }
}

TEST_P(Norlab, AStatedLengthOfASweepThatTheFilesContradictIsSaid) {
  for (const auto& [stated_ns, said] : {std::pair{500'000'000, true}, {80'000'000, true}, {102'000'000, false}}) {
    SweepSource source;
    source.folder = test::written(GetParam());
    source.format = "vtk";
    source.reading.device.sweep_period_ns = stated_ns;
    const Imported out = import_sweeps(source);
    EXPECT_EQ(out.sensors.lidars.at(0).sweep_period_ns, stated_ns);
    const bool found = std::any_of(out.notes.begin(), out.notes.end(), [](const std::string& note) {
      return note.find("the import uses the stated sweep period of") != std::string::npos &&
             note.find("span up to") != std::string::npos;
    });
    EXPECT_EQ(found, said) << stated_ns;
  }
}

// these are the first and the fourth line of the table; the reference of the real one fluctuates by some mm
TEST_P(Norlab, TheReferenceIsTheTables) {
  const Imported imported = import("trajectory.csv");
  ASSERT_TRUE(imported.reference.has_value());
  const sim::Truth& truth = *imported.reference;
  const Isometry3d first = pose_at(truth, 0.0), fourth = pose_at(truth, 299852288.0);
  if (GetParam().real) {
    EXPECT_TRUE(first.translation().isApprox(Vector3d(0.85824662, -0.13771612, 0.03212672), 1e-5));
    EXPECT_TRUE(fourth.translation().isApprox(Vector3d(0.85897767, -0.13214987, 0.03379368), 1e-2));
  } else {
    EXPECT_TRUE(first.isApprox(test::norlab_pose(0.0), 1e-9));
    EXPECT_TRUE(fourth.isApprox(test::norlab_pose(0.299852288), 1e-9));
  }
}

// each point, placed with the reference pose of the lidar at the point's own time, lies on a wall of the room
TEST(NorlabStandIn, PointsAndPosesBelongTogether) {
  const fs::path folder = test::written(test::data_folders("norlab").front());
  SweepSource source;
  source.folder = folder;
  source.format = "vtk";
  source.reading.device.name = "lidar";
  Imported imported = import_sweeps(source);
  const auto worst_m = [&](const char* poses) {
    ReferenceSource reference;
    reference.file = folder / poses;
    reference.format = "odometry";
    attach_reference(imported, reference);
    const sim::LidarRecord& lidar = imported.sensors.lidars.at(0);
    double worst = 0.0;
    for (std::size_t sweep = 0; sweep < 5; ++sweep) {
      for (std::size_t k = lidar.sweep_first[sweep]; k < lidar.sweep_first[sweep + 1]; ++k) {
        const double time_ns = static_cast<double>(lidar.sweep_start_ns[sweep]) + lidar.offset_ns[k];
        const Vector3d p = pose_at(*imported.reference, time_ns) * lidar.position_L_m[k].cast<double>();
        double off = 1e9;
        for (int axis = 0; axis < 3; ++axis)
          off = std::min(off, std::abs(std::abs(p[axis]) - test::kNorlabRoom_m[static_cast<std::size_t>(axis)]));
        worst = std::max(worst, off);
      }
    }
    return worst;
  };
  EXPECT_LT(worst_m("trajectory.csv"), 1e-4) << "six digits of VTK";
  EXPECT_GT(worst_m("icp_odom.csv"), 2e-3) << "the odometry errs by 5 mm";
}

INSTANTIATE_TEST_SUITE_P(, Norlab, testing::ValuesIn(test::data_folders("norlab")), test::FolderName());

class Vtk : public test::TemporaryFolder {
 protected:
  Cloud read(const std::string& text) {
    fixture::put(folder_ / "a.vtk", text);
    return read_cloud(folder_ / "a.vtk");
  }
  std::string complaint_of(const std::string& text) {
    return test::complaint([&] { read(text); });
  }
  const std::string head_ = "# vtk DataFile Version 3.0\nby hand\nASCII\nDATASET POLYDATA\n";
  const std::string points_ = "POINTS 2 float\n1 2 3\nnan -5e-1 6\n";
};

TEST_F(Vtk, ReadsPointsAndScalars) {
  const Cloud cloud = read(head_ + points_ +
                           "VERTICES 2 4\n1 0\n1 1\nPOINT_DATA 2\nNORMALS n float\n0 0 1\n0 0 1\n"
                           "SCALARS two float 2\nLOOKUP_TABLE default\n1 2 3 4\nCOLOR_SCALARS c 3\n0 0 0 1 1 1\n"
                           "SCALARS t float\nLOOKUP_TABLE default\n0\n9.97396e+07\n");
  EXPECT_THAT(cloud.names, ElementsAre("x", "y", "z", "t"));
  EXPECT_EQ(cloud.points, 2u);
  EXPECT_TRUE(std::isnan((*cloud.find("x"))[1]));
  EXPECT_EQ((*cloud.find("y"))[1], -0.5);
  EXPECT_EQ((*cloud.find("t"))[1], 99739600.0);
}

TEST_F(Vtk, WhatIsNoneIsRefusedWithItsLine) {
  const std::string good = head_ + points_ + "POINT_DATA 2\nSCALARS t float\nLOOKUP_TABLE default\n0\n1\n";
  ASSERT_EQ(complaint_of(good), "");
  for (std::size_t size = 0; size + 2 < good.size(); ++size) {
    const std::string complaint = complaint_of(good.substr(0, size));
    const bool whole_without_scalars = size >= head_.size() + points_.size() - 1 && complaint.empty();
    EXPECT_TRUE(whole_without_scalars || complaint.find("a.vtk:") != std::string::npos) << size << complaint;
  }
  EXPECT_THAT(complaint_of("ply\n"), HasSubstr("a.vtk:2: the file does not begin with '# vtk DataFile Version'"));
  EXPECT_THAT(complaint_of("# vtk DataFile Version 3.0\nx\nBINARY\n"), HasSubstr("a.vtk:3: the file is a binary"));
  EXPECT_THAT(complaint_of(head_ + "POINTS 2 float\n1 2 3\n4 5,5 6\n"),
              HasSubstr("a.vtk:7: word '5,5' is not a number"));
  EXPECT_THAT(complaint_of(head_ + "POINTS 4000000000 float\n1 2 3\n"),
              HasSubstr("a.vtk:5: the file states 4000000000 points"));
  EXPECT_THAT(complaint_of(head_ + "POINTS 9 float\n1 2 3\n"),
              HasSubstr("a.vtk:5: the VTK file states 9 rows of 3 numbers, but only 7 bytes"));
  EXPECT_THAT(complaint_of(head_ + points_ + points_), HasSubstr("a.vtk:8: POINTS occurs twice"));
  EXPECT_THAT(complaint_of(head_ + points_ + "POINT_DATA 3\n"),
              HasSubstr("POINT_DATA states 3 points, but POINTS states 2"));
  EXPECT_THAT(complaint_of(head_ + points_ + "POLYGONS 1 4\n"),
              HasSubstr("section 'POLYGONS' is not supported at this position"));
  EXPECT_THAT(complaint_of(head_), HasSubstr("has no POINTS section"));
}

class OdometryTable : public test::TemporaryFolder {
 protected:
  std::string complaint_of(const std::string& text) {
    fixture::put(folder_ / "a.csv", text);
    ReferenceSource source;
    source.file = folder_ / "a.csv";
    source.format = "odometry";
    return test::complaint([&] { import_trajectory(source); });
  }
  const std::string head_ =
      "header.stamp.sec,header.stamp.nanosec,pose.pose.position.x,pose.pose.position.y,pose.pose.position.z,"
      "pose.pose.orientation.x,pose.pose.orientation.y,pose.pose.orientation.z,pose.pose.orientation.w\n";
};

TEST_F(OdometryTable, AHeaderWithoutItsColumnsIsRefused) {
  EXPECT_THAT(complaint_of("header.stamp.sec," + std::string(70000, 'a') + "\n1\n"),
              HasSubstr("a.csv:1: missing columns: time position x"));
}

TEST_F(OdometryTable, BadLinesAreRefusedWithTheirPlace) {
  const std::string good = head_ + "10,0,1,2,3,0,0,0,1\n10,500000000,1,2,3,0,0,0.6,0.8\n";
  EXPECT_EQ(complaint_of(good), "");
  EXPECT_THAT(complaint_of(good + "10,500000000,1,2,3,0,0,0,1\n"),
              HasSubstr("a.csv:4: the time stamp 10500000000 ns must be larger than"));
  EXPECT_THAT(
      complaint_of(good + "11,1000000000,1,2,3,0,0,0,1\n"),
      HasSubstr("a.csv:4: column 1 must contain a whole number from 0 to 999999999, but contains '1000000000'"));
  EXPECT_THAT(complaint_of(good + "11,0,1,2,3,0,0,0.6,0.9\n"),
              HasSubstr("a.csv:4: the norm of this pose's quaternion is"));
  EXPECT_THAT(complaint_of(good + "11,0,nan,2,3,0,0,0,1\n"), HasSubstr("a.csv:4: the pose is not finite"));
  EXPECT_THAT(complaint_of(good + "11,0,1\n"), HasSubstr("a.csv:4: this line has 3 columns, but the first line has 9"));
  std::string doubled = good;
  doubled.replace(doubled.find("position.y"), 10, "position.x");
  EXPECT_THAT(complaint_of(doubled), HasSubstr("a.csv:1: two columns of the pose table have the same meaning, "
                                               "'pose.pose.position.x' and 'pose.pose.position.x'"));
  EXPECT_THAT(complaint_of(head_ + "10,0,1,2,3,0,0,0,1\n"), HasSubstr("has 1 poses; it needs at least 2"));
}

// `evo_traj --save_as_tum` and `--save_as_kitti` write such files, with numpy's "%.18e"
using PoseFiles = test::TemporaryFolder;
TEST_F(PoseFiles, OfEvoAreRead) {
  fixture::put(folder_ / "a.tum",
               "1.690309709285305500e+09 1.000000000000000000e+00 2.000000000000000000e+00 3.000000000000000000e+00 "
               "0.000000000000000000e+00 0.000000000000000000e+00 0.000000000000000000e+00 1.000000000000000000e+00\n"
               "1.690309709385259150e+09 1.500000000000000000e+00 2.000000000000000000e+00 3.000000000000000000e+00 "
               "0.000000000000000000e+00 0.000000000000000000e+00 0.000000000000000000e+00 1.000000000000000000e+00\n");
  EXPECT_EQ(pose_format(folder_ / "a.tum"), "tum");
  const std::vector<ReferencePose> poses = read_tum_poses(folder_ / "a.tum", false);
  ASSERT_EQ(poses.size(), 2u);
  // a double of such seconds is accurate to 0.24 us
  EXPECT_NEAR(static_cast<double>(poses[0].time_ns - 1690309709'285305600), 0.0, 250.0);
  EXPECT_EQ(poses[1].p_WA_m.x(), 1.5);
  const std::string one = "1.000000000000000000e+00 ", none = "0.000000000000000000e+00 ";
  fixture::put(folder_ / "a.kitti", one + none + none + one + none + one + none + none + none + none + one +
                                        "2.5e+00\n" + one + none + none + none + none + one + none + none + none +
                                        none + one + "3e+00\n");
  EXPECT_EQ(pose_format(folder_ / "a.kitti"), "kitti");
  EXPECT_EQ(read_kitti_poses(folder_ / "a.kitti", {0, 1})[0].p_WA_m, Vector3d(1.0, 0.0, 2.5));
}

// The test reads the same two poses from every kind of file.
TEST_F(PoseFiles, AreReadWithTheirNamesAndUnits) {
  const fs::path file = folder_ / "poses.csv";
  const std::string short_rows = "1700000000.25,1,2,3,0,0,0.6,0.8\n1700000000.75,4,5,6,0,0,0,1\n";
  const auto with = [](std::string text, char by) {
    std::replace(text.begin(), text.end(), ',', by);
    return text;
  };
  const std::vector<std::pair<std::string, std::string>> files = {
      {"tum", short_rows},
      {"tum", with(short_rows, ' ')},
      {"tum", "# t x y z\n" + with(short_rows, ';')},
      {"odometry", "timestamp,tx,ty,tz,qx,qy,qz,qw\n" + short_rows},
      {"odometry", with("timestamp,x,y,z,q_x,q_y,q_z,q_w\n" + short_rows, ' ')},
      {"odometry",
       "#timestamp, p_RS_R_x [m], p_RS_R_y [m], p_RS_R_z [m], q_RS_w [], q_RS_x [], q_RS_y [], q_RS_z [], v_RS_R_x [m "
       "s^-1]\n1700000000250000000,1,2,3,0.8,0,0,0.6,9\n1700000000750000000,4,5,6,1,0,0,0,9\n"},
      {"odometry",
       "%time,field.header.stamp,field.child_frame_id,field.transform.translation.x,field.transform.translation.y,"
       "field.transform.translation.z,field.transform.rotation.x,field.transform.rotation.y,field.transform.rotation.z,"
       "field.transform.rotation.w\n7,1700000000250000000,a,1,2,3,0,0,0.6,0.8\n8,1700000000750000000,a,4,5,6,0,0,0,"
       "1\n"},
      {"odometry",
       "time_ns,x_W_m,y_W_m,z_W_m,qx,qy,qz,qw,vx_W_m_s,label\n1700000000250000000,1,2,3,0,0,0.6,0.8,0,\n"
       "1700000000500000000,nan,nan,nan,nan,nan,nan,nan,nan,\n1700000000750000000,4,5,6,0,0,0,1,0,\n"}};
  for (const auto& [format, text] : files) {
    SCOPED_TRACE(text);
    fixture::put(file, text);
    ASSERT_EQ(pose_format(file), format);
    const std::vector<ReferencePose> poses =
        format == "tum" ? read_tum_poses(file, false) : read_pose_table(file, false);
    ASSERT_EQ(poses.size(), 2u);
    EXPECT_EQ(poses[0].time_ns, 1'700'000'000'250'000'000);
    EXPECT_EQ(poses[1].time_ns, 1'700'000'000'750'000'000);
    EXPECT_EQ(poses[0].p_WA_m, Vector3d(1, 2, 3));
    EXPECT_TRUE(poses[0].q_WA.coeffs().isApprox(Eigen::Vector4d(0, 0, 0.6, 0.8), 1e-12));
  }
  // IMU readings are not poses
  fixture::put(file, "time,gx,gy,gz,ax,ay,az,temp\n0,0,0,0,0,0,9.8,20\n0.01,0,0,0,0,0,9.8,20\n");
  EXPECT_FALSE(is_pose_table(file));
  EXPECT_THAT(test::complaint([&] { pose_format(file); }), HasSubstr("8 other words"));
}

// the times are those of timestamps.txt of KITTI's raw data
TEST_F(PoseFiles, TimesOfKittiAreDates) {
  const fs::path file = folder_ / "timestamps.txt";
  fixture::put(file, "2011-09-26 13:02:25.964389445\n2011-09-26 13:02:26.067\n");
  EXPECT_THAT(read_stamps(file), ElementsAre(1317042145'964389445, 1317042146'067000000));
  fixture::put(file, "2011-13-26 13:02:25.9\n");
  EXPECT_THAT(test::complaint([&] { read_stamps(file); }),
              HasSubstr("timestamps.txt:1: the time stamp '2011-13-26 13:02:25.9' must be in seconds"));
}

}  // namespace
}  // namespace tumble::scenarios
