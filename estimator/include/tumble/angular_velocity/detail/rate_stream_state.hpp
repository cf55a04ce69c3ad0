// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "tumble/angular_velocity/detail/arrow_solver.hpp"
#include "tumble/angular_velocity/detail/device_doubt.hpp"
#include "tumble/angular_velocity/detail/flight_sense.hpp"
#include "tumble/angular_velocity/detail/frozen_axes.hpp"
#include "tumble/angular_velocity/detail/hold_watch.hpp"
#include "tumble/angular_velocity/detail/least_rails.hpp"
#include "tumble/angular_velocity/detail/rail_watch.hpp"
#include "tumble/angular_velocity/detail/rate_observation.hpp"
#include "tumble/angular_velocity/detail/stroke_sums.hpp"
#include "tumble/angular_velocity/rail_detector.hpp"
#include "tumble/angular_velocity/rate_state.hpp"
#include "tumble/angular_velocity/rest_detector.hpp"
#include "tumble/angular_velocity/rig_constants.hpp"
#include "tumble/angular_velocity/sensor_errors.hpp"
#include "tumble/common/time.hpp"

/// State of RateStream.
namespace tumble {

/// What the accelerometer read at the stamp of a sample.
struct RateStreamForce {
  Eigen::Vector3d force_m_s2 = Eigen::Vector3d::Zero();
  std::uint8_t device_clip_flags = 0;  ///< the accelerometer's bits
  std::uint8_t clipped = 0;            ///< axes at an upright rail, as Clipping::accel
  bool operator==(const RateStreamForce&) const = default;
};

/// A sample in the window.
struct RateStreamKnot {
  RateObservation observation;  ///< with the force of its own instant, where the accelerometer is late: `read`
  RateStreamForce read;
  Clipping by_upright_rails;  ///< what the device and upright rails say; the observation's knows planes too
  RateEstimate estimate;
  Eigen::Matrix3d covariance_rad2_s2 = Eigen::Matrix3d::Zero();
  /// By how much the size of each axis has grown in each of the two steps up to this sample, the lesser; 0 or more.
  Eigen::Vector3d approach_rad_s = Eigen::Vector3d::Zero();
  int age = 0;
  bool repeats = false;   ///< its gyro says the reading of the sample before again: HoldWatch
  HeldReading held;       ///< of its gyro; as if none was held at rest
  std::uint8_t near = 0;  ///< axes that may have met a rail in a part of the reading's window: rails.md (R76)
};

/// How much later than the gyro the accelerometer speaks: rate_stream.md (R107) to (R110).
struct RateStreamDelay {
  StrokeSums strokes;
  double in_use_s = 0.0;           ///< that readings are taken with; what is given of the device until one is found
  double told_s = 0.0;             ///< by strokes and by what the readings tell of the device, as asked last
  bool found = false;              ///< it is not what is given
  TriadDelay guess;                ///< by strokes alone, as they told it last
  std::optional<TimeNs> asked_ns;  ///< when strokes were
  bool operator==(const RateStreamDelay&) const = default;
};

/// What all that left the window tells of the device's errors, and how it moves with them: rate_stream.md (R101).
struct RateStreamDevice {
  struct Work {
    arrow::BorderErrors border, of_rig;
    SensorErrorEvidence told;
    DeviceDoubt::Work doubt;
  };
  arrow::ErrorMatrix prior = arrow::ErrorMatrix::Zero();     ///< what each adds to the gradient of the oldest sample
  arrow::BorderErrors corner = arrow::BorderErrors::Zero();  ///< of the rig
  SensorErrorEvidence evidence;
  DeviceDoubt::Open open;          ///< by the evidence, as asked last
  std::optional<TimeNs> asked_ns;  ///< when
  RateStreamDelay delay;
  std::vector<arrow::ErrorMatrix> moved;  ///< scratch space: d(sample) / d(errors)
  Work work;                              ///< scratch space
};

/// All that evolves; made by RateStream::start(). Copyable; RateStream::equal() compares.
struct RateStreamState {
  RailWatch::State rails;
  RestDetector::State rests;
  HoldWatch::State holds;
  FrozenAxes::State frozen;
  FlightSense::State sense;
  std::vector<RateStreamKnot> window;  ///< oldest first
  RigConstants rig;
  RigConstants::Matrix rig_covariance;
  // what is known of the oldest sample and of the rig from all that left the window, about a point
  arrow::Block prior;
  arrow::Corner prior_corner;
  /// One. Not inside of the state, which passes through threads of little stack.
  std::vector<RateStreamDevice> device = std::vector<RateStreamDevice>(1);
  std::array<Eigen::Vector3d, 2> extremes{Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};  ///< of readings so far
  LeastRails least;  ///< by the readings so far
  /// Of a run of readings at a possible rail that left in part: RateStreamKnot::approach_rad_s before it, and how many
  /// left.
  Eigen::Vector3d entry_rad_s = Eigen::Vector3d::Zero(), entry_samples = Eigen::Vector3d::Zero();
  std::optional<RateKnot> left;  ///< the sample that left last, and when it was read
  TimeNs left_ns = 0;
  RateKnot prior_knot;
  RigConstants prior_rig;
  std::size_t samples = 0;
  std::size_t waiting = 0;         ///< samples since the last step
  std::size_t learnt_from = 0;     ///< samples of flight that left the window and told of the rig
  std::size_t flight_run = 0;      ///< samples of flight in a row that left the window last
  std::size_t rig_resets = 0;      ///< times that what was learnt of the rig was dropped
  std::size_t failures = 0;        ///< steps whose system was not positive definite and was skipped
  std::vector<arrow::Block> work;  ///< scratch space, no part of the state proper
};

}  // namespace tumble
