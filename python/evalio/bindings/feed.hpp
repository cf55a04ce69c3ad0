// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <evalio/pipeline.h>
#include <nanobind/nanobind.h>

#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "sweeps.hpp"

namespace tumble::evalio_bindings {

namespace nb = nanobind;

/// A pipeline of evalio over an estimator of the package tumble that has add_imu, add_sweep, take_all and map
/// (TumblingOdometry). Who derives from it in Python gives it one, in `initialize()`, by `begin`.
///
/// evalio hands out a sweep when its first return was fired; it waits here for the samples that cover it, as a robot
/// has it. Poses saved are each sweep's last word, some 0.3 s after its end. evalio has no call at the end of a run, so
/// that what is younger then stays unsaid (half a second), unless somebody calls `finish`. What the estimator refuses
/// (TumbleError) is left out with a warning of Python's, and the rest goes on. A hundred sweeps that wait are an error:
/// the data have no IMU, or one of another clock.
class Feed : public evalio::Pipeline {
 public:
  /// `sweep_length_ns`: from the first return's time to the end of the sweep.
  void begin(nb::object odometry, std::int64_t sweep_length_ns);
  /// At the end of a run: saves what has not been saved. A sweep that the IMU did not cover has no pose.
  void finish();

  void add_imu(evalio::ImuMeasurement given) override;
  void add_lidar(evalio::LidarMeasurement given) override;
  /// The map as one cloud, "map".
  const evalio::Map<> map() override;

  // of who derives from it
  void set_imu_params(evalio::ImuParams) override {}
  void set_lidar_params(evalio::LidarParams) override {}
  void set_imu_T_lidar(evalio::SE3) override {}
  std::map<std::string, evalio::Param> set_params(std::map<std::string, evalio::Param> params) override {
    return params;
  }
  void initialize() override {}

 private:
  nb::handle odometry() const;
  void require_room() const;
  void give_samples();
  void give_sweep(Sweep sweep);
  void save_words();
  void save_poses(nb::handle poses);

  nb::object odometry_;
  std::int64_t sweep_length_ns_ = 0;
  Samples samples_;  ///< not given yet
  std::optional<std::int64_t> last_sample_ns_;
  std::deque<Sweep> waiting_;  ///< for samples that cover them
};

}  // namespace tumble::evalio_bindings
