// SPDX-License-Identifier: BSD-3-Clause
// rail_detection [--no-flags] FILE...
//
// The program runs ClippingFinder on the first IMU's gyro and accelerometer of simulated recordings (.h5). It prints
// the number of elements that lost more than 1 % of the stated range to saturation, how many of them ClippingFinder
// reports as saturated, and how many of all reported elements lost anything. It also prints what ClippingFinder reports
// for the unsaturated readings of the same motion. The program is no test.
#include <Eigen/Dense>
#include <cstdio>
#include <exception>
#include <string>
#include <vector>

#include "scenarios/methods/bridge.hpp"
#include "scenarios/methods/rate_baselines.hpp"
#include "scenarios/recordings/recording_file.hpp"
#include "tumble/angular_velocity/detail/clipping_finder.hpp"

namespace {

using namespace tumble;

struct Count {
  std::size_t deep = 0, found = 0, called = 0, right = 0, false_alarms = 0;
};

// A loss of at most kNothing (fraction of the range) counts as rounding and quantisation; a loss beyond kDeep counts as
// deep.
constexpr double kNothing = 2e-5, kDeep = 0.01;

Eigen::Matrix3d rows_of(const std::vector<Eigen::Vector3d>& elements) {
  Eigen::Matrix3d rows = Eigen::Matrix3d::Identity();
  for (std::size_t j = 0; j < elements.size(); ++j) rows.row(static_cast<Eigen::Index>(j)) = elements[j];
  return rows;
}

void count(const Eigen::Matrix3d& rows, const Eigen::Vector3d& lost, double range, unsigned called, Count& out) {
  const Eigen::Vector3d deficit = (rows * lost).cwiseAbs() / range;
  for (int j = 0; j < 3; ++j) {
    const bool call = (called >> j & 1u) != 0;
    out.deep += deficit[j] > kDeep;
    out.found += call && deficit[j] > kDeep;
    out.called += call;
    out.right += call && deficit[j] > kNothing;
  }
}

void print(const char* triad, const Count& c, const SaturationPlanes& planes, const std::string& file) {
  std::printf("%-5s %5zu %5zu  %5zu %5zu  %5zu  planes", triad, c.deep, c.found, c.called, c.right, c.false_alarms);
  for (const auto& plane : planes.sensing_axis) {
    if (plane) {
      std::printf(" %.3f(%d+%d)", plane->saturation_limit_rad_s, plane->samples[0], plane->samples[1]);
    } else {
      std::printf(" -");
    }
  }
  std::printf("  %s\n", file.c_str());
}

void judge(const std::string& file, bool flags) {
  sim::Sensors sensors = scenarios::read_sensors(file);
  const sim::ImuTruth truth = scenarios::read_truth(file).imus.at(0);
  sim::ImuRecord& imu = sensors.imus.at(0);
  if (!flags) imu.clip_flags.assign(imu.time_ns.size(), 0);
  ClippingFinder::Params params;
  params.axis_limit_params = scenarios::stated_rails(imu);
  const ClippingFinder finder(params);
  std::vector<ImuSample> samples;
  if (!scenarios::bridge::imu_samples(imu, samples).ok()) return;
  const ClippingFinder::ClippingSearchResult found = finder.find(samples);
  std::vector<ImuSample> free = samples;
  Count gyro, accel;
  const Eigen::Matrix3d gyro_rows = rows_of(truth.gyro_elements), accel_rows = rows_of(truth.accel_elements);
  for (std::size_t k = 0; k < samples.size(); ++k) {
    count(gyro_rows, truth.gyro_unclipped_rad_s[k] - samples[k].angular_velocity_rad_s, imu.stated_gyro_range_rad_s,
          found.clipping_per_sample[k].gyro, gyro);
    count(accel_rows, truth.accel_unclipped_m_s2[k] - samples[k].specific_force_m_s2, imu.stated_accel_range_m_s2,
          found.clipping_per_sample[k].accel, accel);
    free[k].device_clip_flags = 0;
    free[k].angular_velocity_rad_s = truth.gyro_unclipped_rad_s[k];
    free[k].specific_force_m_s2 = truth.accel_unclipped_m_s2[k];
  }
  params.axis_limit_params.stated_gyro_range_rad_s = params.axis_limit_params.stated_accel_range_m_s2 = std::nullopt;
  const ClippingFinder::ClippingSearchResult none = ClippingFinder(params).find(free);
  for (const Clipping& clipping : none.clipping_per_sample) {
    gyro.false_alarms += clipping.gyro != 0;
    accel.false_alarms += clipping.accel != 0;
  }
  print("gyro", gyro, found.saturation_levels.gyro_planes, file);
  print("accel", accel, found.saturation_levels.accel_saturation_planes, file);
}

}  // namespace

int main(int argc, char** argv) {
  bool flags = true;
  std::printf("triad  deep found called right  alarms on the unclipped twin\n");
  try {
    for (int i = 1; i < argc; ++i) {
      const std::string word = argv[i];
      if (word == "--no-flags") {
        flags = false;
      } else {
        judge(word, flags);
      }
    }
  } catch (const std::exception& error) {
    std::fprintf(stderr, "rail_detection: %s\n", error.what());
    return 2;
  }
  return 0;
}
