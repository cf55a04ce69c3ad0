// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>

#include "scenarios/errors.hpp"
#include "scenarios/recordings/hdf5_file.hpp"
#include "scenarios/recordings/import.hpp"
#include "scenarios/recordings/recording_check.hpp"

namespace tumble::scenarios {

namespace {

constexpr const char* kAttribution =
    "D. Laidig, M. Caruso, A. Cereatti, T. Seel: BROAD - A Benchmark for Robust Inertial Orientation Estimation, "
    "Data 2021, 6(7), 72; CC BY 4.0; trial ";

}  // namespace

Imported import_broad(const std::filesystem::path& path) {
  const hdf5::InputFile file(path);
  const hdf5::Group& root = file.root();
  const double rate_hz = root.double_attribute("sampling_rate");
  if (!(rate_hz > 0.0 && rate_hz <= 1e5)) root.fail("sampling_rate", "must be above 0 and at most 100000 Hz");
  sim::ImuRecord imu;
  imu.name = "imu";
  imu.period_ns = std::llround(1e9 / rate_hz);
  root.read("imu_gyr", imu.gyro_rad_s);
  root.read("imu_acc", imu.accel_m_s2);
  for (std::size_t k = 0; k < imu.gyro_rad_s.size(); ++k) {
    // from the rate itself: multiples of the rounded period would drift
    imu.time_ns.push_back(std::llround(static_cast<double>(k) * 1e9 / rate_hz));
  }
  imu.clip_flags.assign(imu.time_ns.size(), 0);
  Imported out;
  out.info.attribution = kAttribution + path.stem().string();
  out.sensors.imus.push_back(std::move(imu));
  const std::string problem = find_problem(out.sensors);
  if (!problem.empty()) throw BadInput(path.string() + ": " + problem);
  return out;
}

}  // namespace tumble::scenarios
