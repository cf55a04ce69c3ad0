// SPDX-License-Identifier: BSD-3-Clause
// Runs TumblingOdometry on a ROS bag: example_bag BAG (a ROS 1 file, the folder of a ROS 2 bag, or an MCAP file) prints
// a pose for each sweep. The readers are those of the harness; sensors and mounting are those of
// examples/odometry/tumbling.cpp. Exit status 2 means invalid input.
#include <cstdio>
#include <exception>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <tumble/mapping/lidar_inertial_odometry.hpp>
#include <tumble/tumble.hpp>

#include "examples/odometry/driver.hpp"
#include "examples/odometry/rig.hpp"
#include "scenarios/methods/bridge.hpp"
#include "scenarios/recordings/bags/bag.hpp"

namespace {

void run(const tumble::sim::Sensors& sensors) {
  namespace bridge = tumble::scenarios::bridge;
  std::vector<tumble::ImuSample> samples;
  if (const auto status = bridge::primary_imu_samples(sensors, samples); !status.ok()) {
    throw std::runtime_error(status.message());
  }
  tumble::TumblingOdometry odometry(rig());
  const auto report = [](const tumble::Status& status) {
    if (!status.ok()) std::fprintf(stderr, "%s\n", status.message().c_str());
  };
  std::size_t next = 0;
  const std::size_t sweeps = sensors.lidars.empty() ? 0 : bridge::sweep_count(sensors.lidars.front());
  std::optional<bridge::Sweep> sweep;
  for (const tumble::ImuSample& sample : samples) {
    report(odometry.add_imu(sample));
    while (sweep || next < sweeps) {
      if (!sweep) sweep = bridge::sweep(sensors.lidars.front(), next++);
      if (sweep->end_ns > sample.time_ns) break;
      report(odometry.add_sweep(sweep->start_ns, sweep->end_ns, sweep->points));
      sweep.reset();
    }
    while (const auto done = odometry.take()) driver::print(*done);
  }
  odometry.finish();
  while (const auto done = odometry.take()) driver::print(*done);
  std::fprintf(stderr, "a map of %zu points, a saved run of %zu bytes\n", odometry.mapper().map().size(),
               odometry.save().size());
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 2) {
    std::fputs("use: example_bag BAG\n", stderr);
    return 2;
  }
  try {
    const std::filesystem::path bag = arguments[1];
    const auto read =
        bag.extension() == ".bag" ? tumble::scenarios::import_ros1_bag : tumble::scenarios::import_ros2_bag;
    tumble::scenarios::BagReading reading;
    reading.imu_topics = {"/imu"};
    run(read(bag, reading).sensors);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "example_bag: %s\n", error.what());
    return 2;
  }
}
