// SPDX-License-Identifier: BSD-3-Clause
// The test checks that nodes declare each parameter once, with its description, and that poses, boxes and data sheets
// are read or rejected by name.
#include "tumble_ros/node_params.hpp"

#include "tests/testing.hpp"

namespace tumble {

namespace {

template <class Params>
std::set<std::string> names() {
  std::set<std::string> out;
  Params params;
  ros::visit_parameters(params, [&](const std::string& name, auto&, const ParameterInfo& field) {
    EXPECT_TRUE(out.insert(name).second) << name << " is declared twice";
    EXPECT_STRNE(field.description, "") << name;
  });
  for (const ros::TextParameter& text : ros::text_parameters()) EXPECT_TRUE(out.insert(text.name).second) << text.name;
  return out;
}

TEST(NodeParams, AreThoseThatHaveAnEffect) {
  const auto tumbling = names<ros::TumblingAdapterParams>(), rolling = names<ros::RollingAdapterParams>();
  for (const char* name :
       {"imu_rate_hz", "lever_arm_m", "lag_s", "range_max_m", "map_period_s", "diagnostics_period_s"})
    EXPECT_TRUE(tumbling.contains(name)) << name;
  for (const char* name : {"radius_m", "lag_s", "gravity_m_s2"}) EXPECT_TRUE(rolling.contains(name)) << name;
  for (const char* name : {"rate_lag_s", "mapping_gravity_m_s2", "mapping_range_max_m"})
    EXPECT_FALSE(tumbling.contains(name)) << name << " is derived";
  EXPECT_FALSE(rolling.contains("rolling_radius_m")) << "is derived";
  EXPECT_FALSE(rolling.contains("map_period_s"));
}

TEST(NodeParams, ReadsPosesBoxesAndSheets) {
  const std::vector<double> numbers = {1.0, 2.0, 3.0, 0.0, 0.0, 0.7071, 0.7071};
  const Isometry3d pose = ros::pose_of("T_base_imu", numbers);
  EXPECT_EQ(pose.translation(), Vector3d(1.0, 2.0, 3.0));
  EXPECT_TRUE((pose.linear() * Eigen::Vector3d::UnitX()).isApprox(Eigen::Vector3d::UnitY(), 1e-4));
  EXPECT_THROW(ros::pose_of("T_base_imu", std::vector<double>(6, 0.0)), InvalidParams);
  EXPECT_THROW(ros::pose_of("T_base_imu", std::vector<double>(7, 0.0)), InvalidParams) << "no rotation";
  EXPECT_TRUE(ros::box_of("own_body", {}).isEmpty());
  EXPECT_EQ(ros::box_of("own_body", std::vector<double>{-1, -2, -3, 1, 2, 3}).max(), Vector3d(1, 2, 3));
  EXPECT_THROW(ros::box_of("own_body", std::vector<double>(5, 0.0)), InvalidParams);
  EXPECT_EQ(ros::imu_sheet("mti30").gyro_range_rad_s, sheets::mti30().gyro_range_rad_s);
  EXPECT_EQ(ros::imu_sheet("").rate_hz, ImuDataSheet{}.rate_hz);
  EXPECT_EQ(ros::lidar_sheet("rs16").range_min_m, 0.2);
  try {
    ros::imu_sheet("mti300");
    FAIL() << "an unknown sheet";
  } catch (const InvalidParams& error) {
    EXPECT_NE(std::string(error.what()).find("mti30, vn100"), std::string::npos) << error.what();
  }
}

}  // namespace

}  // namespace tumble
