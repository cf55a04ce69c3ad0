// SPDX-License-Identifier: BSD-3-Clause
#include "feed.hpp"

#include <nanobind/ndarray.h>
#include <nanobind/stl/string.h>

#include <algorithm>
#include <cstddef>
#include <stdexcept>
#include <utility>

namespace tumble::evalio_bindings {

namespace {

constexpr std::size_t kSamplesMax = 256;  ///< samples that are buffered until a sweep needs them
/// kSweepsMax is the number of sweeps that may wait for samples: ten seconds of most lidars. Without this limit, data
/// without an IMU would fill the memory.
constexpr std::size_t kSweepsMax = 100;

std::string seconds(std::int64_t time_ns) {
  return std::to_string(1e-9 * static_cast<double>(time_ns)) + " s";
}

template <class Scalar, nb::ssize_t... Shape>
using Shown = nb::ndarray<const Scalar, nb::shape<Shape...>, nb::c_contig, nb::device::cpu>;

/// Returns an attribute of `of` as a contiguous array of this type.
template <class Scalar, nb::ssize_t... Shape>
Shown<Scalar, Shape...> rows(nb::handle of, const char* name, const char* type) {
  const nb::object array = nb::module_::import_("numpy").attr("ascontiguousarray")(of.attr(name), type);
  return nb::cast<Shown<Scalar, Shape...>>(array);
}

bool is_tumble_error(nb::python_error& error) {
  return error.matches(nb::module_::import_("tumble.errors").attr("TumbleError"));
}

void warn(const std::string& text) {
  nb::module_::import_("warnings").attr("warn")("skipped: " + text);
}

}  // namespace

void Feed::begin(nb::object odometry, std::int64_t sweep_length_ns) {
  if (sweep_length_ns <= 0) {
    throw std::invalid_argument("the length of a sweep is " + std::to_string(sweep_length_ns) +
                                " ns; it must be above 0");
  }
  odometry_ = std::move(odometry);
  sweep_length_ns_ = sweep_length_ns;
  samples_ = {};
  last_sample_ns_.reset();
  waiting_.clear();
}

void Feed::finish() {
  add_samples();
  waiting_.clear();  // no samples cover these sweeps
  odometry().attr("finish")();
  save_final_poses();
  save_poses(odometry().attr("window_trajectory")());
}

void Feed::add_imu(evalio::ImuMeasurement given) {
  odometry();
  samples_.push(given);
  const std::int64_t now_ns = samples_.time_ns.back();
  last_sample_ns_ = now_ns;
  const bool covers = !waiting_.empty() && waiting_.front().end_ns <= now_ns;
  if (!covers && samples_.time_ns.size() < kSamplesMax) return;
  add_samples();
  for (; !waiting_.empty() && waiting_.front().end_ns <= now_ns; waiting_.pop_front())
    add_sweep(std::move(waiting_.front()));
  save_final_poses();
}

void Feed::add_lidar(evalio::LidarMeasurement given) {
  odometry();
  require_room();
  try {
    Sweep sweep = sweep_of(given, sweep_length_ns_);
    // if stamps jitter, a sweep ends when the next one starts
    if (!waiting_.empty() && sweep.start_ns < waiting_.back().end_ns)
      waiting_.back().end_ns = std::max(sweep.start_ns, waiting_.back().last_ns);
    waiting_.push_back(std::move(sweep));
  } catch (const std::invalid_argument& error) {
    warn(error.what());
    return;
  }
  save(given.stamp, "sweep", given.points);
}

void Feed::require_room() const {
  if (waiting_.size() < kSweepsMax) return;
  const std::string last =
      last_sample_ns_ ? "the newest IMU sample is at " + seconds(*last_sample_ns_) : "no IMU sample has arrived";
  throw std::runtime_error(std::to_string(waiting_.size()) + " sweeps wait for IMU samples (from " +
                           seconds(waiting_.front().start_ns) + " to " + seconds(waiting_.back().end_ns) +
                           "); the number must be less than " + std::to_string(kSweepsMax) + ": " + last +
                           "; check that the data set has an IMU whose clock agrees with the lidar");
}

const evalio::Map<> Feed::map() {
  std::vector<evalio::Point> points;
  if (odometry_.is_valid()) {
    const nb::object given = odometry_.attr("map")();
    const auto position = rows<double, -1, 3>(given, "position", "float64");
    points.resize(position.shape(0));
    const double* at = position.data();
    for (evalio::Point& point : points) {
      point.x = *at++;
      point.y = *at++;
      point.z = *at++;
    }
  }
  return {{"map", std::move(points)}};
}

nb::handle Feed::odometry() const {
  if (!odometry_.is_valid()) throw std::runtime_error("the pipeline is not initialized; call initialize() first");
  return odometry_;
}

/// Skips a rejected sample and adds the samples after it again.
void Feed::add_samples() {
  Samples samples = std::exchange(samples_, {});
  while (!samples.time_ns.empty()) {
    try {
      odometry().attr("add_imu")(array_of(samples.time_ns), array_of(samples.gyro_I_rad_s, 3),
                                 array_of(samples.accel_I_m_s2, 3));
      return;
    } catch (nb::python_error& error) {
      if (!is_tumble_error(error) || error.value().attr("index").is_none()) throw;
      const auto rejected = nb::cast<std::size_t>(error.value().attr("index"));
      warn(nb::cast<std::string>(nb::str(error.value())));
      samples = samples.from(rejected + 1);
    }
  }
}

void Feed::add_sweep(Sweep sweep) {
  try {
    odometry().attr("add_sweep")(sweep.start_ns, sweep.end_ns, array_of(std::move(sweep.position_L_m), 3),
                                 array_of(std::move(sweep.offset_ns)), array_of(std::move(sweep.ring)),
                                 array_of(std::move(sweep.intensity)));
  } catch (nb::python_error& error) {
    if (!is_tumble_error(error)) throw;
    warn(nb::cast<std::string>(nb::str(error.value())));
  }
}

void Feed::save_final_poses() {
  for (const nb::handle sweep : odometry().attr("take_all")())
    save_poses(sweep.attr("result").attr("final_poses_of_earlier_sweep"));
}

void Feed::save_poses(nb::handle poses) {
  const auto time_ns = rows<std::int64_t, -1>(poses, "time_ns", "int64");
  const auto position = rows<double, -1, 3>(poses, "position", "float64");
  const auto quaternion = rows<double, -1, 4>(poses, "quaternion", "float64");
  for (std::size_t k = 0; k < time_ns.shape(0); ++k)
    save(stamp_of(time_ns.data()[k]), pose_of(position.data() + 3 * k, quaternion.data() + 4 * k));
}

}  // namespace tumble::evalio_bindings
