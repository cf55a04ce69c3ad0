// SPDX-License-Identifier: BSD-3-Clause
#include "odometry_node.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace tumble::ros {

OdometryNode::OdometryNode(const std::string& name, const rclcpp::NodeOptions& options)
    : rclcpp::Node(name, options), buffer_(get_clock()), listener_(buffer_), broadcaster_(*this) {
  for (const TextParameter& each : text_parameters()) {
    rcl_interfaces::msg::ParameterDescriptor described;
    described.description = each.meaning;
    described.read_only = each.at_start;
    if (each.count > 0) {
      declare_parameter(each.name, std::vector<double>{}, described);
    } else {
      declare_parameter(each.name, std::string(each.value), described);
    }
  }
  odometry_publisher_ = create_publisher<nav_msgs::msg::Odometry>("~/odom", 10);
  odometry_imu_publisher_ = create_publisher<nav_msgs::msg::Odometry>("~/odom_imu", kImuDepth);
  diagnostics_publisher_ = create_publisher<diagnostic_msgs::msg::DiagnosticArray>("/diagnostics", 10);
  reset_ = create_service<Trigger>(
      "~/reset", [this](const Trigger::Request::SharedPtr, const Trigger::Response::SharedPtr& answer) {
        const Status status = start_again(std::nullopt);
        answer->success = status.ok();
        answer->message = status.ok() ? "started again" : status.message();
      });
  timer_ = create_wall_timer(std::chrono::milliseconds(200), [this] {
    std::erase_if(inputs_, [](const std::function<bool()>& subscribe) { return subscribe(); });
  });
  initial_pose_ = create_subscription<geometry_msgs::msg::PoseWithCovarianceStamped>(
      "initialpose", 1, [this](const geometry_msgs::msg::PoseWithCovarianceStamped& given) {
        const auto& p = given.pose.pose.position;
        const auto& q = given.pose.pose.orientation;
        const auto& covariance = given.pose.covariance;  // order: position x y z, rotations about x y z
        try {
          report("initialpose",
                 start_again(StartPose{pose_of("initialpose", std::vector<double>{p.x, p.y, p.z, q.x, q.y, q.z, q.w}),
                                       std::sqrt(std::max({covariance[0], covariance[7], 0.0})),
                                       std::sqrt(std::max(covariance[35], 0.0))}));
        } catch (const InvalidParams& error) {
          RCLCPP_WARN(get_logger(), "%s", error.what());
        }
      });
}

bool OdometryNode::wants(Output output) {
  return output == Output::odometry_imu &&
         (text("tf") == "imu" || odometry_imu_publisher_->get_subscription_count() > 0);
}

void OdometryNode::odometry(const Odometry& odometry) {
  odometry_publisher_->publish(message(odometry, false));
}

void OdometryNode::odometry_imu(const Odometry& odometry) {
  odometry_imu_publisher_->publish(message(odometry, true));
}

void OdometryNode::diagnostics(TimeNs stamp_ns, const Diagnostics& now) {
  diagnostic_msgs::msg::DiagnosticArray out;
  out.header.stamp = rclcpp::Time(stamp_ns);
  auto& status = out.status.emplace_back();
  status.level = now.ok ? status.OK : status.WARN;
  status.name = get_name();
  status.message = now.message;
  for (const auto& [key, value] : now.values) {
    status.values.emplace_back();
    status.values.back().key = key;
    status.values.back().value = value;
  }
  diagnostics_publisher_->publish(out);
}

std::optional<Eigen::Isometry3d> OdometryNode::mounting(const std::string& parameter, const std::string& frame) {
  if (const std::vector<double> numbers = list(parameter); !numbers.empty()) return pose_of(parameter, numbers);
  if (frame.empty()) return std::nullopt;
  if (frame == text("base_frame")) return Eigen::Isometry3d::Identity();
  try {
    const auto found = buffer_.lookupTransform(text("base_frame"), frame, tf2::TimePointZero).transform;
    const auto& p = found.translation;
    const auto& q = found.rotation;
    return pose_of(frame, std::vector<double>{p.x, p.y, p.z, q.x, q.y, q.z, q.w});
  } catch (const tf2::TransformException& error) {
    RCLCPP_WARN_THROTTLE(get_logger(), *get_clock(), 5000, "waiting for TF: %s; or set %s", error.what(),
                         parameter.c_str());
    return std::nullopt;
  }
}

void OdometryNode::report(const char* topic, const Status& status) {
  if (!status.ok()) RCLCPP_WARN_THROTTLE(get_logger(), *get_clock(), 1000, "%s: %s", topic, status.message().c_str());
}

geometry_msgs::msg::PoseWithCovariance OdometryNode::base_pose(const Odometry& odometry) {
  geometry_msgs::msg::PoseWithCovariance out;
  const Eigen::Vector3d p = odometry.T_OB.translation();
  const Eigen::Quaterniond q(odometry.T_OB.linear());
  out.pose.position.x = p.x();
  out.pose.position.y = p.y();
  out.pose.position.z = p.z();
  out.pose.orientation.x = q.x();
  out.pose.orientation.y = q.y();
  out.pose.orientation.z = q.z();
  out.pose.orientation.w = q.w();
  std::copy_n(odometry.pose_covariance.data(), 36, out.covariance.begin());
  return out;
}

nav_msgs::msg::Odometry OdometryNode::message(const Odometry& odometry, bool from_imu) {
  nav_msgs::msg::Odometry out;
  out.header.stamp = rclcpp::Time(odometry.stamp_ns);
  out.header.frame_id = text("odom_frame");
  out.child_frame_id = text("base_frame");
  out.pose = base_pose(odometry);
  out.twist.twist.linear.x = odometry.twist_B[0];
  out.twist.twist.linear.y = odometry.twist_B[1];
  out.twist.twist.linear.z = odometry.twist_B[2];
  out.twist.twist.angular.x = odometry.twist_B[3];
  out.twist.twist.angular.y = odometry.twist_B[4];
  out.twist.twist.angular.z = odometry.twist_B[5];
  std::copy_n(odometry.twist_covariance.data(), 36, out.twist.covariance.begin());
  if (text("tf") != (from_imu ? "imu" : "sweep")) return out;
  geometry_msgs::msg::TransformStamped moved;
  moved.header = out.header;
  moved.child_frame_id = out.child_frame_id;
  moved.transform.translation.x = out.pose.pose.position.x;
  moved.transform.translation.y = out.pose.pose.position.y;
  moved.transform.translation.z = out.pose.pose.position.z;
  moved.transform.rotation = out.pose.pose.orientation;
  broadcaster_.sendTransform(moved);
  return out;
}

}  // namespace tumble::ros
