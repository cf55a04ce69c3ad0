// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/recordings/bags/bag_messages.hpp"

#include <algorithm>
#include <cstring>
#include <initializer_list>

#include "scenarios/recordings/whole_seconds.hpp"

namespace tumble::scenarios {

namespace {

template <std::size_t kCount, class Vector>
std::array<double, kCount> array_of(const Vector& vector) {
  std::array<double, kCount> out;
  std::copy(vector.data(), vector.data() + kCount, out.begin());
  return out;
}

/// The variance of an IMU sample is the squared noise density times the output rate.
std::array<double, 9> covariance_of(double density_sqrt_hz, std::int64_t period_ns) {
  const double variance = density_sqrt_hz * density_sqrt_hz / (static_cast<double>(period_ns) * 1e-9);
  return {variance, 0, 0, 0, variance, 0, 0, 0, variance};
}

void set_unknown(std::size_t first_row, std::array<double, 36>& covariance) {
  constexpr std::size_t kRows = 6;
  for (std::size_t row = first_row; row < first_row + 3; ++row) covariance[row * kRows + row] = -1.0;
}

struct NamedType {
  const char* name;
  ros::PointField::Type type;
};

ros::PointCloud2 empty_cloud(std::initializer_list<NamedType> fields, std::size_t points, const ros::Header& header) {
  ros::PointCloud2 out;
  out.header = header;
  for (const NamedType& field : fields) {
    out.fields.push_back({field.name, out.point_step, field.type, 1});
    out.point_step += 4;
  }
  out.width = static_cast<std::uint32_t>(points);
  out.row_step = out.width * out.point_step;
  out.data.reserve(out.row_step);
  return out;
}

template <class Number>
void append(ros::PointCloud2& cloud, const Number& number) {
  const auto* first = reinterpret_cast<const std::uint8_t*>(&number);
  cloud.data.insert(cloud.data.end(), first, first + sizeof(number));
}

void append(ros::PointCloud2& cloud, const Eigen::Vector3f& position_m) {
  for (const float coordinate : {position_m.x(), position_m.y(), position_m.z()}) append(cloud, coordinate);
}

}  // namespace

ros::Header header_of(std::int64_t stamp_ns, const std::string& frame) {
  return {0, static_cast<std::uint32_t>(stamp_ns / kSecond_ns), static_cast<std::uint32_t>(stamp_ns % kSecond_ns),
          frame};
}

ros::Clock clock_message(std::int64_t stamp_ns) {
  return {static_cast<std::uint32_t>(stamp_ns / kSecond_ns), static_cast<std::uint32_t>(stamp_ns % kSecond_ns)};
}

ros::Imu imu_message(const sim::ImuRecord& imu, std::size_t i, const ros::Header& header) {
  ros::Imu out;
  out.header = header;
  out.angular_velocity = array_of<3>(imu.gyro_rad_s[i]);
  out.angular_velocity_covariance = covariance_of(imu.gyro_noise_rad_s_sqrt_hz, imu.period_ns);
  out.linear_acceleration = array_of<3>(imu.accel_m_s2[i]);
  out.linear_acceleration_covariance = covariance_of(imu.accel_noise_m_s2_sqrt_hz, imu.period_ns);
  return out;
}

ros::PointCloud2 cloud_message(const BagCloud& cloud, const ros::Header& header) {
  using Field = ros::PointField;
  const bool erring = !cloud.error_m.empty();
  const std::initializer_list<NamedType> plain = {{"x", Field::float32}, {"y", Field::float32}, {"z", Field::float32}};
  const std::initializer_list<NamedType> with_error = {
      {"x", Field::float32}, {"y", Field::float32}, {"z", Field::float32}, {"error_m", Field::float32}};
  ros::PointCloud2 out = empty_cloud(erring ? with_error : plain, cloud.position_W_m.size(), header);
  for (std::size_t k = 0; k < cloud.position_W_m.size(); ++k) {
    append(out, cloud.position_W_m[k]);
    if (erring) append(out, cloud.error_m[k]);
  }
  return out;
}

ros::Odometry odometry_message(const BagTrack::Pose& pose, const std::string& child, const ros::Header& header) {
  ros::Odometry out;
  out.header = header;
  out.child_frame_id = child;
  out.position = array_of<3>(pose.p_WB_m);
  out.orientation_xyzw = array_of<4>(pose.q_WB.coeffs());
  out.pose_covariance = array_of<36>(pose.covariance);  // symmetric: rows equal columns
  if (!pose.exact && pose.covariance.topLeftCorner<3, 3>().isZero(0.0)) set_unknown(0, out.pose_covariance);
  if (!pose.exact && pose.covariance.bottomRightCorner<3, 3>().isZero(0.0)) set_unknown(3, out.pose_covariance);
  if (pose.v_WB_B_m_s.allFinite())
    out.linear_velocity = array_of<3>(pose.v_WB_B_m_s);
  else
    set_unknown(0, out.twist_covariance);
  if (pose.w_WB_B_rad_s.allFinite())
    out.angular_velocity = array_of<3>(pose.w_WB_B_rad_s);
  else
    set_unknown(3, out.twist_covariance);
  return out;
}

ros::TransformStamped transform_message(const Eigen::Vector3d& p, const Eigen::Quaterniond& q, const std::string& child,
                                        const ros::Header& header) {
  return {header, child, array_of<3>(p), array_of<4>(q.coeffs())};
}

}  // namespace tumble::scenarios
