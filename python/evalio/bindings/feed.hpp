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

/// Feed is an evalio pipeline for an estimator of the package tumble that has add_imu, add_sweep, take_all and map
/// (TumblingOdometry). A derived Python class passes the estimator to `begin` in `initialize()`.
///
/// evalio passes on a sweep at the time of its first return. Each sweep waits in Feed until IMU samples cover it, as on
/// a robot. The saved poses are the final (smoothed) poses of each sweep, about 0.3 s after its end. evalio has no call
/// at the end of a run, so the poses of the last half second are saved only if the caller calls `finish`. Feed skips
/// data that the estimator rejects (TumbleError), with a Python warning. A hundred waiting sweeps are an error: the
/// data have no IMU, or its clock differs.
class Feed : public evalio::Pipeline {
 public:
  /// `sweep_length_ns` is the time from the first return to the end of the sweep.
  void begin(nb::object odometry, std::int64_t sweep_length_ns);
  /// Ends the estimation and saves the remaining poses. A sweep that the IMU did not cover has no pose.
  void finish();

  void add_imu(evalio::ImuMeasurement given) override;
  void add_lidar(evalio::LidarMeasurement given) override;
  /// Returns the map as one cloud named "map".
  const evalio::Map<> map() override;

  // a derived Python class implements these members
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
  void add_samples();
  void add_sweep(Sweep sweep);
  void save_final_poses();
  void save_poses(nb::handle poses);

  nb::object odometry_;
  std::int64_t sweep_length_ns_ = 0;
  Samples samples_;  ///< not added to the estimator yet
  std::optional<std::int64_t> last_sample_ns_;
  std::deque<Sweep> waiting_;  ///< sweeps that IMU samples do not cover yet
};

}  // namespace tumble::evalio_bindings
