// SPDX-License-Identifier: BSD-3-Clause
// A device whose sensing elements clip along axes of their own keeps its readings on a plane for each element and sign:
//   y_j = +-rho + b + sum over k != j of c_k y_k,  c_k = -M_jk / M_jj, rho = r / M_jj, b = -o_j / M_jj
// with M and o of sim/imu/elements.hpp and the rail r. The row draws devices, makes their elements clip one at a time,
// fits that plane to what they say and holds it to what was drawn.
//
// What the same fit says of two real devices, over their clipped samples (RepoIMU, Szczesna et al., ICCVG 2016; seven
// of its recordings of a wand, five of the third segment of a pendulum): the wand's x rail is at 7.299 to 7.305 rad/s
// with slopes of -0.017 to -0.021 against z and within 0.007 against y, b of -0.043 to -0.058 rad/s; the pendulum's z
// rail is at 10.27 to 10.29 rad/s with slopes of 0.045 to 0.054 against x and within 0.03 against y. The plane leaves
// 0.003 to 0.009 rad/s of the wand's readings (0.005 to 0.010 before) and 0.02 to 0.07 of the pendulum's (0.06 to 0.10
// before). So the tilts drawn here are those of real devices; that a simulated plane leaves nothing is what a device
// with an exact compensation does.
#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>

#include "scenarios/certificate/rows.hpp"
#include "scenarios/certificate/set_up.hpp"
#include "scenarios/draw/data_sheet.hpp"
#include "scenarios/standard_gravity.hpp"
#include "sim/imu/imu_simulation.hpp"

namespace tumble::scenarios {

namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kStep_s = 0.0005;

/// Turns about x, y and z in turn beyond any gyro's rail here, and somewhat about the others; pushed along x so hard
/// that each element of an accelerometer meets its rail as it comes round.
sim::Truth beyond_every_rail(double gyro_rail_rad_s, double accel_rail_m_s2) {
  constexpr double kEach_s = 2.0;
  sim::Truth truth;
  truth.period_ns = std::llround(kStep_s * 1e9);
  Eigen::Quaterniond q = Eigen::Quaterniond::Identity();
  for (int k = 0; k <= std::lround(3.0 * kEach_s / kStep_s); ++k) {
    const double t = k * kStep_s;
    Vector3d rate(std::sin(11.0 * t), std::sin(14.0 * t + 1.0), std::sin(8.0 * t + 2.0));
    for (int axis = 0; axis < 3; ++axis) {
      rate[axis] *= (axis == static_cast<int>(t / kEach_s) ? 1.6 : 0.5) * gyro_rail_rad_s;
    }
    truth.q_WB.push_back(q);
    truth.w_WB_B_rad_s.push_back(rate);
    truth.v_WB_m_s.emplace_back(1.5 * accel_rail_m_s2 * t, 0.0, 0.0);
    truth.p_WB_m.emplace_back(Vector3d::Zero());
    q = (q * Eigen::Quaterniond(Eigen::AngleAxisd(rate.norm() * kStep_s, rate.normalized()))).normalized();
  }
  return truth;
}

sim::SensorSpec tilted(const DataSheet& sheet, const TiltedRailSetup& setup) {
  sim::SensorSpec sensor;
  sensor.name = sheet.device;
  sensor.kind = sheet.sensor_kind;
  sensor.device = sheet.device;
  sensor.values = sim::resolve(sheet.device, sheet.values(), sim::imu_parameters());
  const double gyro_rail = sensor.values.at("gyro_rail_rad_s"), accel_rail = sensor.values.at("accel_rail_m_s2");
  sensor.values.set("output_rate_hz", 500.0);
  sensor.values.set("gyro_element_misalignment", setup.misalignment);
  sensor.values.set("accel_element_misalignment", setup.misalignment);
  sensor.values.set("gyro_element_scale", setup.misalignment / 2.0);
  sensor.values.set("accel_element_scale", setup.misalignment / 2.0);
  sensor.values.set("gyro_element_offset_rad_s", 0.005 * gyro_rail);
  sensor.values.set("accel_element_offset_m_s2", 0.005 * accel_rail);
  return sensor;
}

/// One triad's readings with what the elements were.
struct SensedTriad {
  const std::vector<Vector3d>&readings, &unclipped;
  Matrix3d axes;
  Vector3d offset;
  double rail;
};

Matrix3d matrix(const std::vector<Vector3d>& rows) {
  Matrix3d out = Matrix3d::Identity();
  for (std::size_t i = 0; i < rows.size() && i < 3; ++i) out.row(static_cast<Eigen::Index>(i)) = rows[i];
  return out;
}

/// The sign of the rail that element `j` alone is at during the whole of sample k; 0: none.
int side(const SensedTriad& triad, std::size_t k, int j) {
  constexpr double kMargin = 0.08;  // of the rail: more than the signal moves from sample to sample
  int sign = 0;
  for (std::size_t i = k - 1; i <= k + 1; ++i) {
    const Vector3d sensed = (triad.axes * triad.unclipped[i] + triad.offset) / triad.rail;
    for (int element = 0; element < 3; ++element) {
      if (element != j && std::abs(sensed[element]) > 1.0 - kMargin) return 0;
    }
    if (std::abs(sensed[j]) < 1.0 + kMargin) return 0;
    sign = sensed[j] > 0.0 ? 1 : -1;
  }
  return sign;
}

/// How far fitted planes are from the drawn ones.
struct PlaneErrors {
  double slope = 0.0, distance_share = 0.0;
  int samples = 0;  ///< of the element and sign that had fewest
};

/// Rows of one element's fit: the reading along its axis from the two beside, the side and 1.
void fit_element(const SensedTriad& triad, int j, double believed_tilt, PlaneErrors& errors) {
  const int first = (j + 1) % 3, second = (j + 2) % 3;
  std::vector<std::size_t> clipped;
  std::array<int, 2> count = {0, 0};
  for (std::size_t k = 1; k + 1 < triad.readings.size(); ++k) {
    const int sign = side(triad, k, j);
    if (sign == 0) continue;
    clipped.push_back(k);
    ++count[sign > 0 ? 0 : 1];
  }
  errors.samples = std::min({errors.samples, count[0], count[1]});
  if (std::min(count[0], count[1]) < 10) return;
  Eigen::MatrixX4d known(clipped.size(), 4);
  Eigen::VectorXd read(clipped.size());
  for (std::size_t i = 0; i < clipped.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    const Vector3d& y = triad.readings[clipped[i]];
    known.row(row) << y[first], y[second], side(triad, clipped[i], j), 1.0;
    read[row] = y[j];
  }
  const Eigen::Vector4d fitted = known.colPivHouseholderQr().solve(read);
  const double own = triad.axes(j, j);
  const Eigen::Vector4d drawn(-(triad.axes(j, first) + believed_tilt) / own, -triad.axes(j, second) / own,
                              triad.rail / own, -triad.offset[j] / own);
  const Eigen::Vector4d off = (fitted - drawn).cwiseAbs();
  errors.slope = larger(errors.slope, larger(off[0], off[1]));
  errors.distance_share = larger(errors.distance_share, larger(off[2], off[3]) / triad.rail);
}

}  // namespace

std::vector<CertificateEntry> certify_tilted_rail(const CertificateInput& input, const TiltedRailSetup& setup) {
  const sim::SensorSpec sensor = tilted(load_data_sheet(input.data, "mti30"), setup);
  const double gyro_rail = sensor.values.at("gyro_rail_rad_s"), accel_rail = sensor.values.at("accel_rail_m_s2");
  const sim::Truth motion = beyond_every_rail(gyro_rail, accel_rail);
  constexpr int kMany = 1 << 30;
  PlaneErrors gyro{0.0, 0.0, kMany}, accel{0.0, 0.0, kMany};
  for (int device = 1; device <= setup.devices; ++device) {
    sim::ImuRecord record;
    sim::ImuTruth truth;
    sim::simulate_imu(motion, sensor, Eigen::Isometry3d::Identity(), kStandardGravity_m_s2,
                      static_cast<std::uint64_t>(device), record, truth);
    const SensedTriad rates{record.gyro_rad_s, truth.gyro_unclipped_rad_s, matrix(truth.gyro_elements),
                            truth.gyro_element_offset_rad_s, gyro_rail};
    const SensedTriad forces{record.accel_m_s2, truth.accel_unclipped_m_s2, matrix(truth.accel_elements),
                             truth.accel_element_offset_m_s2, accel_rail};
    for (int j = 0; j < 3; ++j) {
      fit_element(rates, j, setup.believed_tilt, gyro);
      fit_element(forces, j, setup.believed_tilt, accel);
    }
  }
  std::vector<CertificateEntry> entries;
  for (const auto& [subject, errors] : {std::pair{"mti30 gyro", gyro}, std::pair{"mti30 accel", accel}}) {
    const bool enough = errors.samples >= 10 && errors.samples < kMany;
    const std::string note = enough ? "" : "an element that is clipped in fewer than 10 whole samples of a sign";
    const double none = std::nan("");
    // an exact law; measured 1e-15: rounding
    entries.push_back(
        {"tilted_rail_slope", subject,
         "clipped readings of drawn devices lie on the planes of their elements: largest error of a slope", "1",
         enough ? errors.slope : none, 0.0, 1e-9, note});
    entries.push_back({"tilted_rail_distance", subject, "the same of the planes' distances and offsets, over the rail",
                       "1", enough ? errors.distance_share : none, 0.0, 1e-9, note});
  }
  return entries;
}

}  // namespace tumble::scenarios
