// SPDX-License-Identifier: BSD-3-Clause
#include <Eigen/Geometry>
#include <algorithm>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <iterator>
#include <rclcpp_components/register_node_macro.hpp>
#include <sensor_msgs/msg/point_cloud2.hpp>
#include <span>
#include <stdexcept>

#include "odometry_node.hpp"
#include "tumble_ros/tumbling_adapter.hpp"

namespace tumble::ros {

namespace {

/// Returns a cloud of float32 fields from records that consist of floats.
template <class Record>
sensor_msgs::msg::PointCloud2 cloud(const std::string& frame, TimeNs stamp_ns, std::initializer_list<const char*> names,
                                    const std::vector<Record>& records) {
  sensor_msgs::msg::PointCloud2 out;
  out.header.frame_id = frame;
  out.header.stamp = rclcpp::Time(stamp_ns);
  for (const char* name : names) {
    auto& field = out.fields.emplace_back();
    field.name = name;
    field.offset = out.point_step;
    field.datatype = field.FLOAT32;
    field.count = 1;
    out.point_step += 4;
  }
  out.height = 1;
  out.width = static_cast<std::uint32_t>(records.size());
  out.row_step = out.width * out.point_step;
  out.is_dense = true;
  out.data.resize(out.row_step);
  static_assert(sizeof(Record) % sizeof(float) == 0);
  if (!records.empty()) std::memcpy(out.data.data(), records.data(), out.data.size());
  return out;
}

}  // namespace

/// TumblingNode runs TumblingOdometry with the topics imu and points.
class TumblingNode : public OdometryNode {
 public:
  explicit TumblingNode(const rclcpp::NodeOptions& options) : OdometryNode("tumbling_odometry", options) {
    params_.odometry.imu = imu_sheet(text("imu_sheet"));
    params_.odometry.lidar = lidar_sheet(text("lidar_sheet"));
    declare_numbers(params_);
    params_.odometry.own_body_L = box_of("own_body", list("own_body"));
    params_.position_arm_B_m = position_of("position_arm", list("position_arm"));
    params_.time_field = text("time_field");
    imu_frame_ = text("imu_frame");
    lidar_frame_ = text("lidar_frame");
    imu_publisher_ = create_publisher<sensor_msgs::msg::Imu>("~/imu", kImuDepth);
    points_publisher_ = create_publisher<sensor_msgs::msg::PointCloud2>("~/points", 10);
    map_publisher_ = create_publisher<sensor_msgs::msg::PointCloud2>("~/map", rclcpp::QoS(1).transient_local());
    save_map_ = saving("~/save_map", "map_file", [this] { return adapter_->map_file(text("map_file")); });
    save_calibration_ =
        saving("~/save_calibration", "calibration_file", [this] { return adapter_->calibration_yaml(); });
    load_map_ = create_service<Trigger>(
        "~/load_map", [this](const Trigger::Request::SharedPtr, const Trigger::Response::SharedPtr& answer) {
          answer->success = adapter_.has_value() && load_map(answer->message);
          if (!adapter_) answer->message = kNoData.message();
        });
    subscribe<sensor_msgs::msg::Imu>("imu", kImuDepth, [this](const sensor_msgs::msg::Imu& message) {
      if (imu_frame_.empty()) imu_frame_ = message.header.frame_id;
      if (start()) report("imu", adapter_->on_imu(sample_of(message)));
    });
    position_publisher_ = create_publisher<Position>("~/pose", 10);
    subscribe<Position>("position", kCloudDepth, [this](const Position& message) { on_position(message); });
    subscribe<sensor_msgs::msg::PointCloud2>(
        "points", kCloudDepth, [this](const sensor_msgs::msg::PointCloud2& message) { on_points(message); },
        [this](const std::shared_ptr<rclcpp::SerializedMessage>& message) { on_livox(*message); });
  }

  bool wants(Output output) override {
    if (output == Output::points) return points_publisher_->get_subscription_count() > 0;
    return output == Output::map || OdometryNode::wants(output);
  }
  void imu(const RecoveredImu& recovered) override {
    sensor_msgs::msg::Imu out;
    out.header.frame_id = imu_frame_;
    out.header.stamp = rclcpp::Time(recovered.rate.time_ns);
    const Eigen::Vector3d &w = recovered.rate.w_WI_I_rad_s, &f = recovered.specific_force_m_s2;
    out.angular_velocity.x = w.x();
    out.angular_velocity.y = w.y();
    out.angular_velocity.z = w.z();
    out.linear_acceleration.x = f.x();
    out.linear_acceleration.y = f.y();
    out.linear_acceleration.z = f.z();
    std::copy_n(recovered.rate.covariance_rad2_s2.data(), 9, out.angular_velocity_covariance.begin());
    for (const int k : {0, 4, 8}) out.linear_acceleration_covariance[k] = recovered.force_variance_m2_s4;
    out.orientation_covariance[0] = -1.0;  // sensor_msgs/Imu: no orientation
    imu_publisher_->publish(out);
  }
  void position_pose(const Odometry& odometry) override {
    Position out;
    out.header.stamp = rclcpp::Time(odometry.stamp_ns);
    out.header.frame_id = position_frame_;
    out.pose = base_pose(odometry);
    position_publisher_->publish(out);
  }
  void points(const DeskewedSweep& sweep) override {
    points_publisher_->publish(cloud(lidar_frame_, sweep.stamp_ns, {"x", "y", "z", "intensity"}, sweep.points));
  }
  void map(TimeNs stamp_ns, const std::vector<MapPoint>& map) override {
    map_publisher_->publish(
        cloud(text("odom_frame"), stamp_ns, {"x", "y", "z", "normal_x", "normal_y", "normal_z", "sigma"}, map));
  }

 protected:
  Status start_again(const std::optional<StartPose>& start) override {
    return adapter_ ? adapter_->reset(start) : kNoData;
  }

 private:
  using Position = geometry_msgs::msg::PoseWithCovarianceStamped;
  static constexpr std::size_t kCloudDepth = 20;
  static constexpr Status kNoData{ErrorCode::empty, "messages of imu and points", 0.0, 1.0};

  /// Creates the adapter when the mounting of both sensors is known.
  bool start() {
    if (adapter_) return true;
    const auto T_BI = mounting("T_base_imu", imu_frame_), T_BL = mounting("T_base_lidar", lidar_frame_);
    if (!T_BI || !T_BL) return false;
    params_.T_BI = *T_BI;
    params_.T_BL = *T_BL;
    adapter_.emplace(params_, *this);
    std::string message;
    if (!text("prior_map_file").empty() && !load_map(message)) throw std::runtime_error(message);
    return true;
  }

  /// Reads `prior_map_file` and starts a run in this map. Returns false on error.
  bool load_map(std::string& message) {
    const std::string path = text("prior_map_file");
    std::ifstream file(path, std::ios::binary);
    const std::vector<char> bytes{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
    if (!file) {
      message = "cannot read '" + path + "'; set the parameter prior_map_file";
      return false;
    }
    const Status status = adapter_->load_map(std::as_bytes(std::span(bytes)));
    message = path + ": " + status.message();
    return status.ok();
  }

  void on_position(const Position& message) {
    position_frame_ = message.header.frame_id;
    const auto& p = message.pose.pose.position;
    const Matrix6 covariance(message.pose.covariance.data());
    if (start()) {
      report("position", adapter_->on_position(rclcpp::Time(message.header.stamp).nanoseconds(), {p.x, p.y, p.z},
                                               covariance.topLeftCorner<3, 3>()));
    }
  }

  void on_livox(const rclcpp::SerializedMessage& message) {
    const auto& raw = message.get_rcl_serialized_message();
    const std::span<const std::uint8_t> bytes(raw.buffer, raw.buffer_length);
    if (lidar_frame_.empty()) {
      LivoxCloud cloud;
      if (cloud.parse(bytes).ok()) lidar_frame_ = cloud.frame_id;
    }
    if (start()) report("points", adapter_->on_livox(bytes));
  }

  void on_points(const sensor_msgs::msg::PointCloud2& message) {
    if (lidar_frame_.empty()) lidar_frame_ = message.header.frame_id;
    if (!start()) return;
    std::vector<PointField> fields;
    for (const auto& field : message.fields) fields.push_back({field.name, field.offset, field.datatype, field.count});
    report("points",
           adapter_->on_cloud({rclcpp::Time(message.header.stamp).nanoseconds(), message.height, message.width, fields,
                               message.is_bigendian, message.point_step, message.row_step, message.data}));
  }

  /// Creates a service that writes a file.
  template <class Content>
  rclcpp::Service<Trigger>::SharedPtr saving(const char* name, const char* parameter, Content content) {
    return create_service<Trigger>(name, [this, parameter, content](const Trigger::Request::SharedPtr,
                                                                    const Trigger::Response::SharedPtr& answer) {
      if (!adapter_) return;
      std::ofstream file(text(parameter), std::ios::binary);
      file << content();
      file.close();
      answer->success = !file.fail();
      answer->message = (answer->success ? "wrote " : "cannot write ") + text(parameter);
    });
  }

  TumblingAdapterParams params_;
  std::string imu_frame_, lidar_frame_, position_frame_;
  std::optional<TumblingAdapter> adapter_;
  rclcpp::Publisher<sensor_msgs::msg::Imu>::SharedPtr imu_publisher_;
  rclcpp::Publisher<Position>::SharedPtr position_publisher_;
  rclcpp::Publisher<sensor_msgs::msg::PointCloud2>::SharedPtr points_publisher_, map_publisher_;
  rclcpp::Service<Trigger>::SharedPtr save_map_, save_calibration_, load_map_;
};

}  // namespace tumble::ros

RCLCPP_COMPONENTS_REGISTER_NODE(tumble::ros::TumblingNode)
