// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/odometry/sensor_sheets.hpp"

#include <limits>

#include "tumble/angular_velocity/detail/rail_ratios.hpp"

namespace tumble {

double range_below_saturation(double stated_range) {
  return stated_range > 0.0 ? (1.0 - kNearRailRatio) * stated_range : std::numeric_limits<double>::infinity();
}

namespace sheets {

ImuDataSheet mti30() {
  return {.rate_hz = 100.0,
          .gyro_range_rad_s = 7.853981634,
          .accel_range_m_s2 = 196.133,
          .gyro_noise_rad_s_sqrt_hz = 5.23598776e-4,
          .accel_noise_m_s2_sqrt_hz = 5.88399e-4};
}

ImuDataSheet vn100() {
  return {.rate_hz = 100.0,
          .gyro_range_rad_s = 34.906585,
          .accel_range_m_s2 = 156.9064,
          .gyro_noise_rad_s_sqrt_hz = 6.108652e-5,
          .accel_noise_m_s2_sqrt_hz = 1.372931e-3};
}

ImuDataSheet phidget1044() {
  return {.rate_hz = 250.0,
          .gyro_range_rad_s = 34.906585,
          .accel_range_m_s2 = 78.4532,
          .gyro_noise_rad_s_sqrt_hz = 6.512629e-4,
          .accel_noise_m_s2_sqrt_hz = 1.736638e-3};
}

ImuDataSheet mpu6050() {
  return {.rate_hz = 100.0,
          .gyro_range_rad_s = 8.726646,
          .accel_range_m_s2 = 156.9064,
          .gyro_noise_rad_s_sqrt_hz = 8.726646e-05,
          .accel_noise_m_s2_sqrt_hz = 0.00392266};
}

ImuDataSheet bmi088() {
  return {.rate_hz = 200.0,
          .gyro_range_rad_s = 34.90658504,
          .accel_range_m_s2 = 235.3596,
          .gyro_noise_rad_s_sqrt_hz = 0.0002443461,
          .accel_noise_m_s2_sqrt_hz = 0.001716164};
}

ImuDataSheet icm20948() {
  return {.rate_hz = 200.0,
          .gyro_range_rad_s = 34.90658504,
          .accel_range_m_s2 = 156.9064,
          .gyro_noise_rad_s_sqrt_hz = 0.0002617994,
          .accel_noise_m_s2_sqrt_hz = 0.002255529};
}

ImuDataSheet icm42688() {
  return {.rate_hz = 200.0,
          .gyro_range_rad_s = 34.90658504,
          .accel_range_m_s2 = 156.9064,
          .gyro_noise_rad_s_sqrt_hz = 4.886922e-05,
          .accel_noise_m_s2_sqrt_hz = 0.0006864655};
}

ImuDataSheet mti3() {
  return {.rate_hz = 100.0,
          .gyro_range_rad_s = 34.90658504,
          .accel_range_m_s2 = 156.9064,
          .gyro_noise_rad_s_sqrt_hz = 0.000122173,
          .accel_noise_m_s2_sqrt_hz = 0.001176798};
}

ImuDataSheet lsm6dso() {
  return {.rate_hz = 200.0,
          .gyro_range_rad_s = 34.90658504,
          .accel_range_m_s2 = 156.9064,
          .gyro_noise_rad_s_sqrt_hz = 6.632251e-05,
          .accel_noise_m_s2_sqrt_hz = 0.001078731};
}

ImuDataSheet ouster_imu() {
  return {.rate_hz = 100.0,
          .gyro_range_rad_s = 4.36332313,
          .accel_range_m_s2 = 19.6133,
          .gyro_noise_rad_s_sqrt_hz = 0.0002617994,
          .accel_noise_m_s2_sqrt_hz = 0.002255529};
}

ImuDataSheet mid360_imu() {
  return {.rate_hz = 200.0,
          .gyro_range_rad_s = 34.90658504,
          .accel_range_m_s2 = 39.2266,
          .gyro_noise_rad_s_sqrt_hz = 7.853982e-05,
          .accel_noise_m_s2_sqrt_hz = 0.000980665};
}

ImuDataSheet icm20601() {
  return {.rate_hz = 100.0,
          .gyro_range_rad_s = 34.90658504,
          .accel_range_m_s2 = 313.8128,
          .gyro_noise_rad_s_sqrt_hz = 0.0001745329,
          .accel_noise_m_s2_sqrt_hz = 0.002941995};
}

ImuDataSheet icm20602() {
  return {.rate_hz = 200.0,
          .gyro_range_rad_s = 34.90658504,
          .accel_range_m_s2 = 156.9064,
          .gyro_noise_rad_s_sqrt_hz = 6.981317e-05,
          .accel_noise_m_s2_sqrt_hz = 0.000980665};
}

ImuDataSheet lsm6dsv320x() {
  return {.rate_hz = 250.0,
          .gyro_range_rad_s = 69.81317008,
          .accel_range_m_s2 = 156.9064,
          .gyro_noise_rad_s_sqrt_hz = 6.632251e-05,
          .accel_noise_m_s2_sqrt_hz = 0.000588399};
}

ImuDataSheet adis16405() {
  return {.rate_hz = 500.0,
          .gyro_range_rad_s = 5.235987756,
          .accel_range_m_s2 = 176.5197,
          .gyro_noise_rad_s_sqrt_hz = 0.0008726646,
          .accel_noise_m_s2_sqrt_hz = 0.003333333};
}

ImuDataSheet iim42653() {
  return {.rate_hz = 200.0,
          .gyro_range_rad_s = 69.81317008,
          .accel_range_m_s2 = 313.8128,
          .gyro_noise_rad_s_sqrt_hz = 8.726646e-05,
          .accel_noise_m_s2_sqrt_hz = 0.0006374322};
}

std::span<const std::pair<const char*, ImuDataSheet (*)()>> imus() {
  static constexpr std::pair<const char*, ImuDataSheet (*)()> kAll[] = {{"mti30", mti30},
                                                                        {"vn100", vn100},
                                                                        {"phidget1044", phidget1044},
                                                                        {"mpu6050", mpu6050},
                                                                        {"bmi088", bmi088},
                                                                        {"icm20948", icm20948},
                                                                        {"icm42688", icm42688},
                                                                        {"mti3", mti3},
                                                                        {"lsm6dso", lsm6dso},
                                                                        {"ouster_imu", ouster_imu},
                                                                        {"mid360_imu", mid360_imu},
                                                                        {"icm20601", icm20601},
                                                                        {"icm20602", icm20602},
                                                                        {"lsm6dsv320x", lsm6dsv320x},
                                                                        {"adis16405", adis16405},
                                                                        {"iim42653", iim42653}};
  return kAll;
}

LidarDataSheet rs16() {
  return {.range_min_m = 0.2, .range_max_m = 150.0};
}

LidarDataSheet mid40() {
  return {.range_min_m = 1.0, .range_max_m = 260.0};
}

LidarDataSheet mid100() {
  return {.range_min_m = 1.0, .range_max_m = 260.0};
}

LidarDataSheet vlp16() {
  return {.range_min_m = 0.4, .range_max_m = 100.0};
}

LidarDataSheet xt16() {
  return {.range_min_m = 0.05, .range_max_m = 120.0};
}

LidarDataSheet xt32() {
  return {.range_min_m = 0.05, .range_max_m = 120.0};
}

LidarDataSheet helios32() {
  return {.range_min_m = 0.2, .range_max_m = 150.0};
}

LidarDataSheet os0_64() {
  return {.range_min_m = 0.3, .range_max_m = 50.0};
}

LidarDataSheet os0_128() {
  return {.range_min_m = 0.3, .range_max_m = 50.0};
}

LidarDataSheet os1_64() {
  return {.range_min_m = 0.3, .range_max_m = 120.0};
}

LidarDataSheet os1_128() {
  return {.range_min_m = 0.3, .range_max_m = 120.0};
}

LidarDataSheet mid360() {
  return {.range_min_m = 0.1, .range_max_m = 70.0};
}

std::span<const std::pair<const char*, LidarDataSheet (*)()>> lidars() {
  static constexpr std::pair<const char*, LidarDataSheet (*)()> kAll[] = {
      {"rs16", rs16},       {"mid40", mid40},   {"mid100", mid100},     {"vlp16", vlp16},
      {"xt16", xt16},       {"xt32", xt32},     {"helios32", helios32}, {"os0_64", os0_64},
      {"os0_128", os0_128}, {"os1_64", os1_64}, {"os1_128", os1_128},   {"mid360", mid360}};
  return kAll;
}

}  // namespace sheets

}  // namespace tumble
