// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/recordings/recording_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <initializer_list>
#include <set>
#include <span>
#include <utility>

namespace tumble::scenarios {

namespace {

using FieldLengths = std::initializer_list<std::pair<const char*, std::size_t>>;

/// Largest accepted deviation of a rotation matrix from orthogonality, and of a squared quaternion norm from 1.
constexpr double kUnitTolerance = 1e-6;
constexpr std::int64_t kTimeMax_ns = 100'000'000'000'000'000;

std::string in(const std::string& place, const std::string& problem) {
  return problem.empty() ? "" : place + ": " + problem;
}

std::string length_problem(const FieldLengths& lengths) {
  const auto& [first_name, first] = *lengths.begin();
  for (const auto& [name, length] : lengths) {
    if (length == first) continue;
    return fmt::format("{} has {} rows, but {} has {}; the numbers must be equal", name, length, first_name, first);
  }
  return "";
}

std::string pose_problem(const char* name, const Eigen::Isometry3d& pose) {
  const Eigen::Matrix3d rotation = pose.linear();
  if (!pose.matrix().allFinite()) return std::string(name) + " is not finite";
  const double departure = (rotation.transpose() * rotation - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
  if (!(departure <= kUnitTolerance) || rotation.determinant() < 0.0)
    return fmt::format("{} must be a rigid transform (rotation and translation)", name);
  return "";
}

std::string at_least(const char* name, double value, double bound) {
  if (std::isfinite(value) && value >= bound) return "";
  return fmt::format("{} is {}; it must be at least {}", name, value, bound);
}

std::string positive(const char* name, std::int64_t value) {
  return value > 0 ? "" : fmt::format("{} is {}; it must be greater than 0", name, value);
}

std::string first_of(std::initializer_list<std::string> problems) {
  const auto found = std::find_if(problems.begin(), problems.end(), [](const std::string& p) { return !p.empty(); });
  return found == problems.end() ? "" : *found;
}

std::string optional_length_problem(const char* name, std::size_t length, std::size_t needed) {
  if (length == 0 || length == needed) return "";
  return fmt::format("{} has {} rows; it must have {} or none", name, length, needed);
}

/// Names of sensors and surfaces appear in tables, so each name must be UTF-8 text without control characters.
std::string text_problem(const char* name, const std::string& text) {
  std::size_t following = 0;
  for (const unsigned char c : text) {
    const bool continues = (c & 0xc0) == 0x80;
    if (continues != (following > 0) || (following == 0 && (c < 0x20 || c == 0x7f)) || c >= 0xf8) {
      return fmt::format("{} must be UTF-8 text without control characters", name);
    }
    following = continues ? following - 1 : c >= 0xf0 ? 3 : c >= 0xe0 ? 2 : c >= 0xc0 ? 1 : 0;
  }
  return following == 0 ? "" : fmt::format("{} must be UTF-8 text without control characters", name);
}

/// Times more than three years from the start of the recording come from a wrong clock, and differences of such times
/// can overflow.
std::string times_problem(const char* name, const std::vector<std::int64_t>& times_ns) {
  const auto far = [](std::int64_t t) { return t > kTimeMax_ns || t < -kTimeMax_ns; };
  const auto found = std::find_if(times_ns.begin(), times_ns.end(), far);
  if (found == times_ns.end()) return "";
  return fmt::format("{} is {} in row {}; it must be within 1e17 ns of the start of the recording", name, *found,
                     found - times_ns.begin());
}

std::string imu_problem(const sim::ImuRecord& imu) {
  const std::size_t n = imu.time_ns.size();
  return first_of(
      {text_problem("name", imu.name), text_problem("device", imu.device), times_problem("time_ns", imu.time_ns),
       positive("period_ns", imu.period_ns), at_least("stated_gyro_range_rad_s", imu.stated_gyro_range_rad_s, 0.0),
       at_least("stated_accel_range_m_s2", imu.stated_accel_range_m_s2, 0.0),
       at_least("gyro_noise_rad_s_sqrt_hz", imu.gyro_noise_rad_s_sqrt_hz, 0.0),
       at_least("accel_noise_m_s2_sqrt_hz", imu.accel_noise_m_s2_sqrt_hz, 0.0), pose_problem("T_BI", imu.T_BI),
       length_problem({{"time_ns", n},
                       {"gyro_I_rad_s", imu.gyro_rad_s.size()},
                       {"accel_I_m_s2", imu.accel_m_s2.size()},
                       {"clip_flags", imu.clip_flags.size()}}),
       optional_length_problem("magnetic_field_I_t", imu.magnetic_field_t.size(), n),
       imu.earth_field_W_t.allFinite() ? "" : "earth_field_W_t is not finite"});
}

std::string sweep_problem(const sim::LidarRecord& lidar, std::size_t points) {
  const std::size_t sweeps = lidar.sweep_start_ns.size();
  if (sweeps == 0 && points == 0 && lidar.sweep_first.empty()) return "";
  if (lidar.sweep_first.size() != sweeps + 1) {
    return fmt::format("sweep_first has {} rows; it must have one more than sweep_start_ns ({})",
                       lidar.sweep_first.size(), sweeps);
  }
  if (lidar.sweep_first.front() != 0 || lidar.sweep_first.back() != points) {
    return fmt::format("sweep_first must increase from 0 to the number of points, {}", points);
  }
  if (!std::is_sorted(lidar.sweep_first.begin(), lidar.sweep_first.end())) return "sweep_first decreases";
  const auto stuck = [](std::int64_t a, std::int64_t b) { return a >= b; };
  const auto& start = lidar.sweep_start_ns;
  if (std::adjacent_find(start.begin(), start.end(), stuck) != start.end()) return "sweep_start_ns does not increase";
  return "";
}

template <class Row, class Judge>
std::string first_wrong(std::span<const Row> rows, const Judge& judge, std::size_t first = 0) {
  std::string problem;
  for (std::size_t i = 0; i < rows.size() && problem.empty(); ++i) problem = judge(rows[i], first + i);
  return problem;
}
template <class Row, class Judge>
std::string first_wrong(const std::vector<Row>& rows, const Judge& judge) {
  return first_wrong(std::span<const Row>(rows), judge);
}
template <class Row, class Judge>
std::string first_wrong(const ColumnFile<Row>& rows, const Judge& judge) {
  constexpr std::size_t kLength = (std::size_t{1} << 20) / sizeof(Row);
  std::string problem;
  rows.for_segments(kLength, [&](std::size_t first, std::span<const Row> segment) {
    if (problem.empty()) problem = first_wrong(segment, judge, first);
  });
  return problem;
}

template <class Offsets>
std::string offset_problem(const Offsets& offsets) {
  return first_wrong(offsets, [](std::uint32_t offset, std::size_t i) -> std::string {
    if (offset == 0) return "";
    return fmt::format("offset_ns is {} at point {}; it must be 0 if points have no time stamps", offset, i);
  });
}

template <class Offsets>
std::string point_times_problem(const sim::LidarRecord& lidar, const Offsets& offsets) {
  if (lidar.point_times > sim::PointTimes::unknown)
    return "the field point_times must be measured, not_skewed or unknown";
  return lidar.point_times == sim::PointTimes::measured ? "" : offset_problem(offsets);
}

template <class Points>
std::string lidar_problem(const sim::LidarRecord& lidar, const Points& points) {
  return first_of({text_problem("name", lidar.name), text_problem("device", lidar.device),
                   times_problem("sweep_start_ns", lidar.sweep_start_ns),
                   positive("sweep_period_ns", lidar.sweep_period_ns), pose_problem("T_BL", lidar.T_BL),
                   length_problem({{"position_L_m", points.position_L_m.size()},
                                   {"range_m", points.range_m.size()},
                                   {"intensity", points.intensity.size()},
                                   {"offset_ns", points.offset_ns.size()},
                                   {"ring", points.ring.size()}}),
                   sweep_problem(lidar, points.position_L_m.size()), point_times_problem(lidar, points.offset_ns)});
}

std::string column_problem(const std::string& name) {
  const auto plain = [](unsigned char c) { return std::isalnum(c) != 0 || c == '_'; };
  if (!name.empty() && std::all_of(name.begin(), name.end(), plain)) return "";
  return "the name of this entry must consist of letters, digits and _, and must not be empty";
}

template <class Record>
std::string names_problem(const std::string& list, const std::vector<Record>& records) {
  std::set<std::string> names;
  std::string problem;
  for (std::size_t i = 0; i < records.size() && problem.empty(); ++i) {
    const std::string& name = records[i].name;
    problem = in(list + "/" + std::to_string(i),
                 first_of({column_problem(name),
                           names.insert(name).second ? "" : "two entries of '" + list + "' have the same name"}));
  }
  return problem;
}

template <class Quantity>
std::string quantities_problem(const std::vector<Quantity>& quantities) {
  std::string problem = names_problem("quantities", quantities);
  for (std::size_t i = 0; i < quantities.size() && problem.empty(); ++i)
    problem = in("quantities/" + std::to_string(i), text_problem("unit", quantities[i].unit));
  return problem;
}

std::string series_problem(const sim::SeriesRecord& series) {
  std::string problem = first_of({text_problem("name", series.name), text_problem("kind", series.kind),
                                  text_problem("device", series.device), times_problem("time_ns", series.time_ns),
                                  positive("period_ns", series.period_ns), pose_problem("T_BX", series.T_BX),
                                  quantities_problem(series.quantities), names_problem("constants", series.constants)});
  for (std::size_t i = 0; i < series.constants.size() && problem.empty(); ++i) {
    if (!std::isfinite(series.constants[i].value))
      problem = in("constants/" + std::to_string(i), "the value of this constant is not finite");
  }
  for (std::size_t i = 0; i < series.quantities.size() && problem.empty(); ++i) {
    const sim::Quantity& quantity = series.quantities[i];
    problem = in("quantities/" + std::to_string(i),
                 first_of({at_least("noise", quantity.noise, 0.0),
                           length_problem({{"time_ns", series.time_ns.size()}, {"values", quantity.values.size()}})}));
  }
  return problem;
}

std::string series_truth_problem(const sim::SeriesTruth& series) {
  return first_of(
      {text_problem("name", series.name), pose_problem("T_BX", series.T_BX), quantities_problem(series.quantities)});
}

std::string series_mismatch(const sim::SeriesRecord& series, const sim::SeriesTruth& truth) {
  if (truth.quantities.empty()) return "";  // reference instruments measure no quantities
  if (truth.quantities.size() != series.quantities.size())
    return "truth and sensor differ in the number of measured quantities; the numbers must be equal";
  std::string problem;
  for (std::size_t i = 0; i < truth.quantities.size() && problem.empty(); ++i) {
    problem = in("quantities/" + std::to_string(i),
                 optional_length_problem("truth values", truth.quantities[i].values.size(), series.time_ns.size()));
  }
  return problem;
}

template <class Imu>
std::string imu_truth_problem(const Imu& imu) {
  return first_of(
      {pose_problem("T_BI", imu.T_BI),
       optional_length_problem("specific_force_I_m_s2", imu.specific_force_m_s2.size(), imu.rate_rad_s.size()),
       length_problem({{"specific_force_I_m_s2", imu.specific_force_m_s2.size()},
                       {"gyro_unclipped_I_rad_s", imu.gyro_unclipped_rad_s.size()},
                       {"accel_unclipped_I_m_s2", imu.accel_unclipped_m_s2.size()},
                       {"gyro_bias_I_rad_s", imu.gyro_bias_rad_s.size()},
                       {"accel_bias_I_m_s2", imu.accel_bias_m_s2.size()}}),
       optional_length_problem("magnetic_field_I_t", imu.magnetic_field_t.size(), imu.rate_rad_s.size()),
       optional_length_problem("gyro_elements_I", imu.gyro_elements.size(), 3),
       optional_length_problem("accel_elements_I", imu.accel_elements.size(), 3),
       imu.gyro_element_offset_rad_s.allFinite() ? "" : "gyro_element_offset_rad_s is not finite",
       imu.accel_element_offset_m_s2.allFinite() ? "" : "accel_element_offset_m_s2 is not finite"});
}

std::string surface_problem(std::int32_t id, std::size_t surfaces) {
  // The surface id -1 means an unknown surface, and the surface id -2 means the robot's cage.
  if (id >= -2 && id < static_cast<std::int64_t>(surfaces)) return "";
  return fmt::format("surface_id {} has no name, because 'surfaces' has only {} names", id, surfaces);
}

template <class Lidar>
std::string lidar_truth_problem(const Lidar& lidar, std::size_t surfaces) {
  return first_of(
      {pose_problem("T_BL", lidar.T_BL),
       length_problem({{"hit_W_m", lidar.hit_W_m.size()}, {"surface_id", lidar.surface_id.size()}}),
       first_wrong(lidar.surface_id, [&](std::int32_t id, std::size_t) { return surface_problem(id, surfaces); })});
}

class RisingTimes {
 public:
  std::string operator()(std::int64_t time_ns, std::size_t) {
    if (time_ns < before_) return "time_ns must not decrease and must not be negative";
    before_ = time_ns;
    return "";
  }

 private:
  std::int64_t before_ = 0;
};

std::string contacts_problem(const std::vector<sim::ContactTruth>& contacts, std::size_t surfaces) {
  RisingTimes times;
  for (const sim::ContactTruth& contact : contacts) {
    if (std::string problem = times(contact.time_ns, 0); !problem.empty()) return "contacts/" + problem;
    if (std::string problem = surface_problem(contact.surface_id, surfaces); !problem.empty()) {
      return "contacts: " + problem;
    }
  }
  return "";
}

std::string contacts_problem(const StoredContacts& contacts, std::size_t surfaces) {
  RisingTimes times;
  const std::string falling =
      first_wrong(contacts.time_ns, [&](std::int64_t time_ns, std::size_t i) { return times(time_ns, i); });
  if (!falling.empty()) return "contacts/" + falling;
  return in("contacts", first_wrong(contacts.surface_id,
                                    [&](std::int32_t id, std::size_t) { return surface_problem(id, surfaces); }));
}

std::string attitude_problem(const Eigen::Quaterniond& q_WB, std::size_t) {
  const bool unknown = q_WB.coeffs().array().isNaN().all();  // the reference has no pose at this time
  if (unknown || std::abs(q_WB.squaredNorm() - 1.0) <= kUnitTolerance) return "";
  return "the quaternion q_WB (attitude of the body in the world) must have norm 1";
}

std::string label_problem(sim::ContactLabel label, std::size_t) {
  if (label <= sim::ContactLabel::slide) return "";
  return fmt::format("contact label {} is unknown; contact labels are 0 to 3", static_cast<int>(label));
}

template <class Truth>
std::string truth_problem(const Truth& truth) {
  std::string problem =
      in("truth", first_of({positive("period_ns", truth.period_ns),
                            length_problem({{"p_WB_m", truth.p_WB_m.size()},
                                            {"q_WB", truth.q_WB.size()},
                                            {"v_WB_m_s", truth.v_WB_m_s.size()},
                                            {"w_WB_B_rad_s", truth.w_WB_B_rad_s.size()}}),
                            optional_length_problem("f_B_m_s2", truth.f_B_m_s2.size(), truth.p_WB_m.size()),
                            optional_length_problem("label", truth.label.size(), truth.p_WB_m.size()),
                            first_wrong(truth.q_WB, attitude_problem), first_wrong(truth.label, label_problem),
                            truth.p_BG_m.allFinite() ? "" : "p_BG_m is not finite",
                            contacts_problem(truth.contacts, truth.surfaces.size())}));
  for (std::size_t i = 0; i < truth.imus.size() && problem.empty(); ++i) {
    problem = in("truth/imus/" + std::to_string(i), imu_truth_problem(truth.imus[i]));
  }
  for (std::size_t i = 0; i < truth.lidars.size() && problem.empty(); ++i) {
    problem = in("truth/lidars/" + std::to_string(i), lidar_truth_problem(truth.lidars[i], truth.surfaces.size()));
  }
  for (std::size_t i = 0; i < truth.series.size() && problem.empty(); ++i) {
    problem = in("truth/series/" + std::to_string(i), series_truth_problem(truth.series[i]));
  }
  return problem;
}

}  // namespace

std::string find_problem(const sim::Sensors& sensors, const std::vector<PointStore>& points) {
  std::string problem = in("sensors", first_of({text_problem("robot", sensors.robot),
                                                at_least("sphere_radius_m", sensors.sphere_radius_m, 0.0),
                                                at_least("gravity_m_s2", sensors.gravity_m_s2, 0.0)}));
  for (std::size_t i = 0; i < sensors.imus.size() && problem.empty(); ++i) {
    problem = in("sensors/imus/" + std::to_string(i), imu_problem(sensors.imus[i]));
  }
  for (std::size_t i = 0; i < sensors.lidars.size() && problem.empty(); ++i) {
    const sim::LidarRecord& lidar = sensors.lidars[i];
    problem = in("sensors/lidars/" + std::to_string(i),
                 points.empty() ? lidar_problem(lidar, lidar) : lidar_problem(lidar, points.at(i)));
  }
  for (std::size_t i = 0; i < sensors.series.size() && problem.empty(); ++i) {
    problem = in("sensors/series/" + std::to_string(i), series_problem(sensors.series[i]));
  }
  return problem;
}

std::string find_problem(const sim::Truth& truth) {
  return truth_problem(truth);
}

std::string find_problem(const StoredTruth& truth) {
  return truth_problem(truth);
}

std::string find_mismatch(const sim::Sensors& sensors, const sim::Truth& truth) {
  if (truth.imus.size() != sensors.imus.size())
    return "truth and sensors differ in the number of IMUs; the numbers must be equal";
  if (truth.lidars.size() != sensors.lidars.size())
    return "truth and sensors differ in the number of lidars; the numbers must be equal";
  if (truth.series.size() != sensors.series.size())
    return "truth and sensors differ in the number of series (sensors other than IMU and lidar); the numbers must be "
           "equal";
  std::string problem;
  for (std::size_t i = 0; i < truth.imus.size() && problem.empty(); ++i) {
    const sim::ImuRecord& imu = sensors.imus[i];
    const sim::ImuTruth& imu_truth = truth.imus[i];
    problem =
        in("imus/" + std::to_string(i),
           first_of({optional_length_problem("truth rate_I_rad_s", imu_truth.rate_rad_s.size(), imu.time_ns.size()),
                     optional_length_problem("truth magnetic_field_I_t", imu_truth.magnetic_field_t.size(),
                                             imu.magnetic_field_t.size())}));
  }
  for (std::size_t i = 0; i < truth.lidars.size() && problem.empty(); ++i) {
    const std::vector<std::uint64_t>& first = sensors.lidars[i].sweep_first;
    problem = in("lidars/" + std::to_string(i),
                 optional_length_problem("truth hit_W_m", truth.lidars[i].hit_W_m.size(),
                                         first.empty() ? 0 : static_cast<std::size_t>(first.back())));
  }
  for (std::size_t i = 0; i < truth.series.size() && problem.empty(); ++i) {
    problem = in("series/" + std::to_string(i), series_mismatch(sensors.series[i], truth.series[i]));
  }
  return problem;
}

}  // namespace tumble::scenarios
