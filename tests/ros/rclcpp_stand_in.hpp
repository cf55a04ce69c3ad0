// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// rclcpp_stand_in.hpp declares the parts of rclcpp, rclcpp_components and tf2_ros that ros/nodes uses, without
/// function bodies. The nodes are checked for errors against these declarations and the real messages, because PyPI has
/// no rclcpp.
#include <builtin_interfaces/msg/time.hpp>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <functional>
#include <geometry_msgs/msg/transform_stamped.hpp>
#include <memory>
#include <rcl_interfaces/msg/parameter_descriptor.hpp>
#include <stdexcept>
#include <string>
#include <vector>

namespace rclcpp {

struct NodeOptions {};
struct QoS {
  QoS(std::size_t depth);
  QoS& transient_local();
  QoS& reliability_best_available();
};
struct Time {
  explicit Time(std::int64_t nanoseconds);
  Time(const builtin_interfaces::msg::Time& stamp);
  std::int64_t nanoseconds() const;
  operator builtin_interfaces::msg::Time() const;
};
struct Clock {
  using SharedPtr = std::shared_ptr<Clock>;
};
struct Logger {};
template <class Message>
struct Publisher {
  using SharedPtr = std::shared_ptr<Publisher>;
  void publish(const Message& message);
  std::size_t get_subscription_count() const;
};
struct SubscriptionBase {
  using SharedPtr = std::shared_ptr<SubscriptionBase>;
};
template <class Message>
struct Subscription : SubscriptionBase {
  using SharedPtr = std::shared_ptr<Subscription>;
};
template <class Type>
struct Service {
  using SharedPtr = std::shared_ptr<Service>;
};
struct GenericSubscription : SubscriptionBase {
  using SharedPtr = std::shared_ptr<GenericSubscription>;
};
struct SerializedMessage {
  struct Bytes {
    std::uint8_t* buffer;
    std::size_t buffer_length;
  };
  const Bytes& get_rcl_serialized_message() const;
};
struct TopicEndpointInfo {
  const std::string& topic_type() const;
};
struct NodeTopicsInterface {
  std::string resolve_topic_name(const std::string& name, bool only_expand = false) const;
};
struct TimerBase {
  using SharedPtr = std::shared_ptr<TimerBase>;
};
struct Parameter {
  std::string as_string() const;
  std::vector<double> as_double_array() const;
};

struct Node {
  Node(const std::string& name, const NodeOptions& options);
  virtual ~Node();
  Clock::SharedPtr get_clock();
  Logger get_logger() const;
  const char* get_name() const;
  std::vector<TopicEndpointInfo> get_publishers_info_by_topic(const std::string& topic, bool no_mangle = false) const;
  std::shared_ptr<NodeTopicsInterface> get_node_topics_interface();
  GenericSubscription::SharedPtr create_generic_subscription(
      const std::string& topic, const std::string& type, const QoS& quality,
      std::function<void(std::shared_ptr<SerializedMessage>)> callback);
  template <class Value>
  Value declare_parameter(const std::string& name, const Value& value, const rcl_interfaces::msg::ParameterDescriptor&);
  Parameter get_parameter(const std::string& name) const;
  template <class Message>
  typename Publisher<Message>::SharedPtr create_publisher(const std::string& topic, const QoS& quality);
  template <class Message>
  typename Subscription<Message>::SharedPtr create_subscription(const std::string& topic, const QoS& quality,
                                                                std::function<void(const Message&)> callback);
  template <class Type>
  typename Service<Type>::SharedPtr create_service(
      const std::string& name,
      std::function<void(typename Type::Request::SharedPtr, typename Type::Response::SharedPtr)> callback);
  TimerBase::SharedPtr create_wall_timer(std::chrono::milliseconds period, std::function<void()> callback);
};

}  // namespace rclcpp

#define RCLCPP_WARN(logger, ...) static_cast<void>(logger), std::snprintf(nullptr, 0, __VA_ARGS__)
#define RCLCPP_WARN_THROTTLE(logger, clock, period, ...) \
  static_cast<void>(clock), static_cast<void>(period), RCLCPP_WARN(logger, __VA_ARGS__)
#define RCLCPP_COMPONENTS_REGISTER_NODE(Class)                       \
  inline void create_component(const rclcpp::NodeOptions& options) { \
    Class component(options);                                        \
  }

namespace tf2 {

struct TransformException : std::runtime_error {
  using std::runtime_error::runtime_error;
};
struct TimePoint {};
inline constexpr TimePoint TimePointZero;

}  // namespace tf2

namespace tf2_ros {

struct Buffer {
  explicit Buffer(rclcpp::Clock::SharedPtr clock);
  geometry_msgs::msg::TransformStamped lookupTransform(const std::string& target, const std::string& source,
                                                       const tf2::TimePoint& time) const;
};
struct TransformListener {
  explicit TransformListener(Buffer& buffer);
};
struct TransformBroadcaster {
  explicit TransformBroadcaster(rclcpp::Node& node);
  void sendTransform(const geometry_msgs::msg::TransformStamped& transform);
};

}  // namespace tf2_ros
