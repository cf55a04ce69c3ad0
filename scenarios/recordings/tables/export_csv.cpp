// SPDX-License-Identifier: BSD-3-Clause
#include <string>
#include <vector>

#include "scenarios/recordings/export.hpp"
#include "scenarios/recordings/export_names.hpp"
#include "scenarios/recordings/number_text.hpp"
#include "scenarios/recordings/replace_file.hpp"
#include "scenarios/text.hpp"

namespace tumble::scenarios {

namespace {

/// In sensor_msgs/Imu, the value -1 as first element of the orientation covariance means that the attitude is unknown.
constexpr const char* kNoAttitude = "0,0,0,1,[-1 0 0 0 0 0 0 0 0]";

template <class Vector>
void append_all(std::string& text, const Vector& vector) {
  for (const double x : vector) append_number(text += ',', x);
}

std::string covariance_text(double density_sqrt_hz, std::int64_t period_ns) {
  const double variance = density_sqrt_hz * density_sqrt_hz / (static_cast<double>(period_ns) * 1e-9);
  std::string text = ",[";
  for (int i = 0; i < 9; ++i) {
    if (i > 0) text += ' ';
    append_number(text, i % 4 == 0 ? variance : 0.0);
  }
  return text + "]";
}

void append_stamp(std::string& text, std::int64_t stamp_ns) {
  append_number(text, stamp_ns / kSecond_ns);
  append_number(text += ',', stamp_ns % kSecond_ns);
}

std::string imu_text(const sim::ImuRecord& imu, const std::string& frame, std::int64_t origin_ns) {
  const std::string gyro_covariance = covariance_text(imu.gyro_noise_rad_s_sqrt_hz, imu.period_ns);
  const std::string accel_covariance = covariance_text(imu.accel_noise_m_s2_sqrt_hz, imu.period_ns);
  std::string text =
      "stamp_s,stamp_ns,frame_id,qx,qy,qz,qw,orientation_covariance,wx_rad_s,wy_rad_s,wz_rad_s,angular_velocity_"
      "covariance,"
      "fx_m_s2,fy_m_s2,fz_m_s2,linear_acceleration_covariance\n";
  for (std::size_t i = 0; i < imu.time_ns.size(); ++i) {
    append_stamp(text, origin_ns + imu.time_ns[i]);
    text += "," + frame + "," + kNoAttitude;
    append_all(text, imu.gyro_rad_s[i]);
    text += gyro_covariance;
    append_all(text, imu.accel_m_s2[i]);
    text += accel_covariance + "\n";
  }
  return text;
}

std::string series_text(const sim::SeriesRecord& series, const std::string& frame, std::int64_t origin_ns) {
  std::string text = "stamp_s,stamp_ns,frame_id";
  for (const sim::Quantity& quantity : series.quantities) text += "," + quantity.name;
  text += '\n';
  for (std::size_t i = 0; i < series.time_ns.size(); ++i) {
    append_stamp(text, origin_ns + series.time_ns[i]);
    text += "," + frame;
    for (const sim::Quantity& quantity : series.quantities) append_number(text += ',', quantity.values[i]);
    text += '\n';
  }
  return text;
}

std::string truth_text(const sim::Truth& truth, std::int64_t origin_ns) {
  std::string text =
      "time_ns,x_W_m,y_W_m,z_W_m,qx,qy,qz,qw,vx_W_m_s,vy_W_m_s,vz_W_m_s,wx_B_rad_s,wy_B_rad_s,wz_B_rad_s,"
      "fx_B_m_s2,fy_B_m_s2,fz_B_m_s2,label\n";
  for (std::size_t i = 0; i < truth.p_WB_m.size(); ++i) {
    append_number(text, origin_ns + static_cast<std::int64_t>(i) * truth.period_ns);
    append_all(text, truth.p_WB_m[i]);
    append_all(text, truth.q_WB[i].coeffs());
    append_all(text, truth.v_WB_m_s[i]);
    append_all(text, truth.w_WB_B_rad_s[i]);
    if (truth.f_B_m_s2.empty())
      text += ",,,";  // unknown values of a reference are empty
    else
      append_all(text, truth.f_B_m_s2[i]);
    text += ',';
    if (!truth.label.empty()) append_number(text, static_cast<int>(truth.label[i]));
    text += '\n';
  }
  return text;
}

}  // namespace

void export_csv(const sim::Sensors& sensors, const sim::Truth* truth, const std::filesystem::path& folder,
                std::int64_t origin_ns) {
  const ExportNames names = export_names(sensors);
  OutputFolder output(folder);
  for (std::size_t i = 0; i < sensors.imus.size(); ++i) {
    const std::string& stem = names.imus.names[i];
    replace_file(folder / (stem + ".csv"), imu_text(sensors.imus[i], stem, origin_ns));
  }
  for (std::size_t i = 0; i < sensors.series.size(); ++i) {
    const std::string& stem = names.series.names[i];
    replace_file(folder / (stem + ".csv"), series_text(sensors.series[i], stem, origin_ns));
  }
  if (truth != nullptr) replace_file(folder / "truth.csv", truth_text(*truth, origin_ns));
  output.keep();
}

}  // namespace tumble::scenarios
