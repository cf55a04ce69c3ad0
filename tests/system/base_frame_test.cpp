// SPDX-License-Identifier: BSD-3-Clause
// The test runs `tumble odometry` with poses of the base frame, on a bag with /tf_static.
#include "scenarios/recordings/recording_file.hpp"
#include "system/program.hpp"

namespace tumble::system_test {
namespace {

std::vector<Isometry3d> poses(const fs::path& trajectory) {
  std::ifstream file(trajectory);
  std::vector<Isometry3d> out;
  for (std::string line; std::getline(file, line);) {
    std::istringstream row(line);
    double time_s = 0.0;
    Vector3d p_m;
    Quaterniond q;
    if (line.front() != '#' && row >> time_s >> p_m.x() >> p_m.y() >> p_m.z() >> q.x() >> q.y() >> q.z() >> q.w())
      out.push_back(Eigen::Translation3d(p_m) * q);
  }
  return out;
}

std::vector<Isometry3d> run_live(const std::string& input, const fs::path& out, std::vector<std::string> options) {
  options.insert(options.begin(), {"odometry", input, "--live", "--json", "-o", out.string()});
  const Ended ended = run_program(options);
  EXPECT_EQ(ended.status, 0) << out << ended.err;
  return poses(out / "trajectory.tum");
}

TEST(OdometrySoak, TheBaseFrameIsAFrameOfTheBag) {
  const fs::path folder = test_folder();
  const std::string bag = (folder / "stroll.mcap").string();
  run_successfully({"export", short_stroll().string(), "-o", bag});
  const auto of_imu = run_live(bag, folder / "imu", {}),
             of_body = run_live(bag, folder / "body", {"--base-frame", "body"});
  const Isometry3d T_imu_body = scenarios::read_sensors(short_stroll()).imus.front().T_BI.inverse();
  ASSERT_GT(T_imu_body.translation().norm(), 0.05);
  ASSERT_GT(of_imu.size(), 600u);
  ASSERT_EQ(of_body.size(), of_imu.size());
  for (std::size_t k = 0; k < of_body.size(); ++k) ASSERT_TRUE(of_body[k].isApprox(of_imu[k] * T_imu_body, 1e-9)) << k;
}

TEST(Odometry, WritesPosesOfTheBaseFrame) {
  const fs::path folder = test_folder();
  const std::string recording = short_stroll().string(), bag = (folder / "stroll.mcap").string();
  run_successfully({"export", recording, "-o", bag});
  const auto of_imu = run_live(recording, folder / "imu", {}),
             shifted = run_live(recording, folder / "shifted", {"--T-base-imu", "0.3", "0", "0", "0", "0", "0", "1"});
  ASSERT_GT(of_imu.size(), 600u);
  ASSERT_EQ(shifted.size(), of_imu.size());
  for (std::size_t k = 0; k < of_imu.size(); ++k)
    ASSERT_TRUE(shifted[k].isApprox(of_imu[k] * Eigen::Translation3d(-0.3, 0.0, 0.0), 1e-9)) << k;
  for (const char* file : {"map.ply", "sweeps.csv"})
    EXPECT_EQ(read_file(folder / "shifted" / file), read_file(folder / "imu" / file)) << file;
  EXPECT_NE(read_file(folder / "shifted" / "position_covariance.csv"),
            read_file(folder / "imu" / "position_covariance.csv"));
  const json estimate = json::parse(read_file(folder / "shifted" / "estimate.json"));
  EXPECT_EQ(estimate["frame"], "base");
  EXPECT_EQ(estimate["T_base_imu"], json({0.3, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0}));

  // the score needs poses of the IMU
  const auto error_m = [&](const char* name) {
    return metric(json_of(run_program({"score", (folder / name).string(), recording, "--json"})), "ate_m");
  };
  EXPECT_NEAR(error_m("shifted"), error_m("imu"), 1e-6);

  const Ended unknown = run_program({"odometry", bag, "--base-frame", "mast", "-o", (folder / "none").string()});
  EXPECT_EQ(unknown.status, 2);
  EXPECT_THAT(unknown.err, HasSubstr("--base-frame mast: "));
  const Ended both = run_program({"odometry", bag, "--base-frame", "body", "--T-base-imu", "0", "0", "0", "0", "0", "0",
                                  "1", "-o", (folder / "none").string()});
  EXPECT_THAT(both.err, HasSubstr("--T-base-imu and --base-frame exclude each other"));
}

}  // namespace
}  // namespace tumble::system_test
