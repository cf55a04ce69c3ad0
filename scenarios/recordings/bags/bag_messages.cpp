// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/recordings/bags/bag_messages.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <initializer_list>
#include <limits>

#include "scenarios/errors.hpp"
#include "scenarios/recordings/left_out.hpp"
#include "scenarios/recordings/number_text.hpp"

namespace tumble::scenarios {

namespace {

template <std::size_t kCount, class Vector>
std::array<double, kCount> array_of(const Vector& vector) {
  std::array<double, kCount> out;
  std::copy(vector.data(), vector.data() + kCount, out.begin());
  return out;
}

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

namespace {

constexpr std::int64_t kSaid_ns = 1'000'000;
/// If a header stamp is more than 10 ms later than the record stamp of its message, both stamps come from different
/// clocks.
constexpr std::int64_t kAhead_ns = 10'000'000;
/// If the delay from header stamps to record stamps varies by more than 0.5 s, the two clocks drift apart, or the
/// header stamps are not measurement times.
constexpr std::int64_t kSteady_ns = 500'000'000;

std::string seconds_text(std::int64_t time_ns) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.6g s", 1e-9 * static_cast<double>(time_ns));
  return text.data();
}

constexpr std::int64_t kLast_ns = 4294967295 * kSecond_ns;

std::int64_t between(std::int64_t from_ns, std::int64_t to_ns) {
  std::int64_t step_ns = 0;
  if (!__builtin_sub_overflow(to_ns, from_ns, &step_ns)) return step_ns;
  return to_ns > from_ns ? std::numeric_limits<std::int64_t>::max() : std::numeric_limits<std::int64_t>::min();
}

std::string course(const char* which, std::int64_t before_ns, std::int64_t now_ns) {
  if (now_ns > before_ns)
    return fmt::format("the {} stamp increases by {}", which, seconds_text(between(before_ns, now_ns)));
  if (now_ns < before_ns)
    return fmt::format("the {} stamp decreases by {}", which, seconds_text(between(now_ns, before_ns)));
  return now_ns == 0 ? fmt::format("the {} stamp is 0 in this message and the previous message", which)
                     : fmt::format("the {} stamp does not change", which);
}

}  // namespace

std::int64_t stamp_of(const ros::Header& header) {
  return std::int64_t{header.sec} * kSecond_ns + header.nanosec;
}

std::int64_t BagStamps::chosen(std::int64_t header_ns, std::int64_t record_ns, const std::string& where) const {
  if (source_ == StampSource::header) return header_ns;
  if (record_ns < 0 || record_ns > kLast_ns)
    throw BadInput(fmt::format("{}: the record stamp of the message is {} ns; it must be from 0 to {} ns", where,
                               record_ns, kLast_ns));
  return record_ns;
}

void BagStamps::add(std::int64_t header_ns, std::int64_t record_ns) {
  header_ns_.push_back(header_ns);
  record_ns_.push_back(record_ns);
}

std::string BagStamps::disorder(std::size_t k) const {
  if (k == 0) return "the time stamp of this message is far from the time stamps of all other messages";
  const std::string header = course("header", header_ns_[k - 1], header_ns_[k]),
                    record = course("record", record_ns_[k - 1], record_ns_[k]);
  const bool by_header = source_ == StampSource::header;
  const bool header_rises = header_ns_[k] > header_ns_[k - 1], record_rises = record_ns_[k] > record_ns_[k - 1];
  const bool rises = by_header ? header_rises : record_rises, other_rises = by_header ? record_rises : header_rises;
  return std::string(rises ? "the time stamp is out of order: " : "the time stamp does not increase: ") +
         (by_header ? header + ", " + record : record + ", " + header) +
         (rises || !other_rises ? ""
          : by_header           ? " (set '--stamps record')"
                                : " (set '--stamps header')");
}

std::pair<std::int64_t, std::int64_t> BagStamps::lag_ns() const {
  std::pair<std::int64_t, std::int64_t> out{};
  const std::vector<bool> in_order = stamps_in_order(times_ns());
  bool first = true;
  for (std::size_t k = 0; k < in_order.size(); ++k) {
    if (!in_order[k]) continue;
    const std::int64_t lag = between(header_ns_[k], record_ns_[k]);
    out = first ? std::pair(lag, lag) : std::pair(std::min(out.first, lag), std::max(out.second, lag));
    first = false;
  }
  return out;
}

bool BagStamps::other_clock() const {
  const auto [least_ns, most_ns] = lag_ns();
  return least_ns < -kAhead_ns || most_ns >= kSecond_ns;
}

std::string BagStamps::remark() const {
  const auto [least_ns, most_ns] = lag_ns();
  if (least_ns > -kSaid_ns && most_ns < kSaid_ns) return "";
  const bool changes = between(least_ns, most_ns) > kSteady_ns;
  const bool by_header = source_ == StampSource::header;
  const bool ahead = most_ns < 0;  // impossible if sensor and recorder use one clock
  return fmt::format(
      "{}the {} stamps of the messages are {} to {} later than the {} stamps{}; this import uses the stamps of the {}",
      by_header && (other_clock() || changes) ? "caution: " : "", ahead ? "header" : "record",
      seconds_text(ahead ? -most_ns : least_ns), seconds_text(ahead ? -least_ns : most_ns), ahead ? "record" : "header",
      other_clock() ? "; the clocks of sensor and recorder may differ"
      : changes     ? "; the clock of the sensor or of the recorder may drift"
                    : "",
      !by_header                         ? "records"
      : changes && least_ns < -kAhead_ns ? "headers (set '--stamps record', because the header stamps jump)"
                                         : "headers");
}

}  // namespace tumble::scenarios
