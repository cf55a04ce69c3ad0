// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <tf2_ros/buffer.h>
#include <tf2_ros/transform_broadcaster.h>
#include <tf2_ros/transform_listener.h>
#include <Eigen/Geometry>
#include <cstdint>
#include <type_traits>

#include <chrono>
#include <diagnostic_msgs/msg/diagnostic_array.hpp>
#include <functional>
#include <geometry_msgs/msg/pose_with_covariance_stamped.hpp>
#include <memory>
#include <nav_msgs/msg/odometry.hpp>
#include <optional>
#include <rclcpp/rclcpp.hpp>
#include <sensor_msgs/msg/imu.hpp>
#include <std_srvs/srv/trigger.hpp>
#include <string>
#include <vector>

#include "tumble_ros/node_params.hpp"
#include "tumble_ros/point_fields.hpp"
#include "tumble_ros/publisher.hpp"
#include "tumble_ros/tumbling_adapter.hpp"

namespace tumble::ros {

/// OdometryNode is the base class of both nodes, with parameters, /tf, odometry and diagnostics. The file tumble/ros.py
/// contains the same node in Python.
class OdometryNode : public rclcpp::Node, public Publisher {
 public:
  OdometryNode(const std::string& name, const rclcpp::NodeOptions& options);

  bool wants(Output output) override;
  void odometry(const Odometry& odometry) override;
  void odometry_imu(const Odometry& odometry) override;
  void diagnostics(TimeNs stamp_ns, const Diagnostics& now) override;

 protected:
  using Trigger = std_srvs::srv::Trigger;
  static constexpr std::size_t kImuDepth = 2000;  ///< queue of IMU samples that arrive while a sweep is registered

  /// Starts a new run at a pose of the base. Without a pose, the run starts at the origin, or anywhere in a prior map.
  /// Returns `empty` before the first data.
  virtual Status start_again(const std::optional<StartPose>& start) = 0;

  std::string text(const std::string& parameter) { return get_parameter(parameter).as_string(); }
  std::vector<double> list(const std::string& parameter) { return get_parameter(parameter).as_double_array(); }
  using Serialized = std::function<void(std::shared_ptr<rclcpp::SerializedMessage>)>;
  /// Subscribes as soon as the topic has a publisher. The subscription is reliable if all publishers of the topic are
  /// reliable, because best-effort subscriptions lose large clouds. If the topic has the type CustomMsg of Livox,
  /// `livox` receives the messages.
  template <class Message>
  void subscribe(const std::string& topic, std::size_t depth, std::function<void(const Message&)> callback,
                 Serialized livox = nullptr);
  /// Returns the pose of a sensor in the base frame, from the parameter, or else from TF. The result is empty while TF
  /// lacks the pose.
  std::optional<Eigen::Isometry3d> mounting(const std::string& parameter, const std::string& frame);
  void report(const char* topic, const Status& status);
  /// Returns the pose of the base with its covariance.
  static geometry_msgs::msg::PoseWithCovariance base_pose(const Odometry& odometry);

  /// Declares the numbers in `params` as parameters of the node, and reads their values. The defaults are the values in
  /// `params`.
  template <class Params>
  void declare_numbers(Params& params);

 private:
  nav_msgs::msg::Odometry message(const Odometry& odometry, bool from_imu);

  std::vector<std::function<bool()>>
      inputs_;  ///< each function subscribes to a topic if it has a publisher, and returns true after the subscription
  std::vector<rclcpp::SubscriptionBase::SharedPtr> subscriptions_;
  rclcpp::TimerBase::SharedPtr timer_;
  tf2_ros::Buffer buffer_;
  tf2_ros::TransformListener listener_;
  tf2_ros::TransformBroadcaster broadcaster_;
  rclcpp::Publisher<nav_msgs::msg::Odometry>::SharedPtr odometry_publisher_, odometry_imu_publisher_;
  rclcpp::Publisher<diagnostic_msgs::msg::DiagnosticArray>::SharedPtr diagnostics_publisher_;
  rclcpp::Subscription<geometry_msgs::msg::PoseWithCovarianceStamped>::SharedPtr initial_pose_;
  rclcpp::Service<Trigger>::SharedPtr reset_;
};

inline ImuSample sample_of(const sensor_msgs::msg::Imu& message) {
  const auto &w = message.angular_velocity, &f = message.linear_acceleration;
  return {rclcpp::Time(message.header.stamp).nanoseconds(), {w.x, w.y, w.z}, {f.x, f.y, f.z}, 0};
}

template <class Message>
void OdometryNode::subscribe(const std::string& topic, std::size_t depth, std::function<void(const Message&)> callback,
                             Serialized livox) {
  inputs_.push_back([this, topic, depth, callback, livox] {
    const auto publishers = get_publishers_info_by_topic(get_node_topics_interface()->resolve_topic_name(topic));
    if (publishers.empty()) return false;
    const rclcpp::QoS quality = rclcpp::QoS(depth).reliability_best_available();
    const std::string type = publishers.front().topic_type();
    if (livox && LivoxCloud::is_type(type)) {
      subscriptions_.push_back(create_generic_subscription(topic, type, quality, livox));
    } else {
      subscriptions_.push_back(create_subscription<Message>(topic, quality, callback));
    }
    return true;
  });
}

template <class Params>
void OdometryNode::declare_numbers(Params& params) {
  visit_parameters(params, [&](const std::string& name, auto& value, const ParameterInfo& field) {
    using Value = std::remove_cvref_t<decltype(value)>;
    rcl_interfaces::msg::ParameterDescriptor described;
    described.description = std::string(field.description) + " [" + field.unit + "]";
    described.read_only = true;
    if constexpr (std::is_same_v<Value, Eigen::Vector3d>) {
      const auto given = declare_parameter(name, std::vector<double>(value.begin(), value.end()), described);
      if (given.size() != 3) throw InvalidParams(name, static_cast<double>(given.size()), "3 numbers");
      value = Eigen::Vector3d(given.data());
    } else if constexpr (std::is_floating_point_v<Value>) {
      value = declare_parameter(name, static_cast<double>(value), described);
    } else if constexpr (std::is_same_v<Value, bool>) {
      value = declare_parameter(name, value, described);
    } else {
      value = static_cast<Value>(declare_parameter(name, static_cast<std::int64_t>(value), described));
    }
  });
}

}  // namespace tumble::ros
