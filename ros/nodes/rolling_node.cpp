// SPDX-License-Identifier: BSD-3-Clause
#include <Eigen/Geometry>
#include <rclcpp_components/register_node_macro.hpp>
#include <span>

#include "odometry_node.hpp"
#include "tumble_ros/rolling_adapter.hpp"

namespace tumble::ros {

/// RollingNode runs RollingOdometry. The topic is imu for one IMU, or imu_1 to imu_4 for several IMUs. T_base_imu has
/// seven numbers for each IMU.
class RollingNode : public OdometryNode {
 public:
  explicit RollingNode(const rclcpp::NodeOptions& options) : OdometryNode("rolling_odometry", options) {
    RollingAdapterParams params;
    declare_numbers(params);
    const std::vector<double> poses = list("T_base_imu");
    const std::size_t count = poses.size() / 7;
    if (count < 1 || poses.size() % 7 != 0)
      throw InvalidParams("T_base_imu", static_cast<double>(poses.size()), "7 numbers for each IMU: x y z qx qy qz qw");
    for (std::size_t unit = 0; unit < count; ++unit) {
      params.odometry.imus.push_back(
          {imu_sheet(text("imu_sheet")), pose_of("T_base_imu", std::span(poses).subspan(7 * unit, 7))});
    }
    adapter_.emplace(params, *this);
    for (std::size_t unit = 0; unit < count; ++unit) {
      const std::string name = count == 1 ? "imu" : "imu_" + std::to_string(unit + 1);
      subscribe<sensor_msgs::msg::Imu>(name, kImuDepth, [this, unit](const sensor_msgs::msg::Imu& message) {
        report("imu", adapter_->on_imu(unit, sample_of(message)));
      });
    }
  }

 protected:
  Status start_again(const std::optional<StartPose>& start) override {
    adapter_->reset(start.value_or(StartPose{}).T_OB);
    return {};
  }

 private:
  std::optional<RollingAdapter> adapter_;
};

}  // namespace tumble::ros

RCLCPP_COMPONENTS_REGISTER_NODE(tumble::ros::RollingNode)
