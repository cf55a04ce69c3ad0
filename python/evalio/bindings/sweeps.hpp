// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <evalio/types.h>
#include <nanobind/nanobind.h>

#include <cstdint>
#include <vector>

/// sweeps.hpp converts evalio's measurements to the arrays that tumble's classes accept.
namespace tumble::evalio_bindings {

namespace nb = nanobind;

/// Sweep contains the returns of a sweep in order of time, stored by columns. The times are nanoseconds of evalio's
/// clock.
struct Sweep {
  std::int64_t start_ns = 0, end_ns = 0;
  std::int64_t last_ns = 0;         ///< of the latest return
  std::vector<float> position_L_m;  ///< x y z each
  std::vector<std::uint32_t> offset_ns;
  std::vector<std::uint16_t> ring;
  std::vector<float> intensity;
};

/// Converts a lidar sweep of evalio. The conversion skips cells without a return: all coordinates 0, or one not finite.
/// Throws std::invalid_argument, with value and bound, for a return before the start of the sweep or more than four
/// seconds after it.
Sweep sweep_of(const evalio::LidarMeasurement& given, std::int64_t length_ns);

/// Samples contains samples of an IMU, stored by columns.
struct Samples {
  std::vector<std::int64_t> time_ns;
  std::vector<double> gyro_I_rad_s, accel_I_m_s2;  ///< x y z each

  void push(const evalio::ImuMeasurement& given);
  /// Returns the samples from index `first` on.
  Samples from(std::size_t first) const;
};

/// Converts position (3) and quaternion (4: x y z w) to a pose of evalio.
evalio::SE3 pose_of(const double* position, const double* quaternion);
evalio::Stamp stamp_of(std::int64_t time_ns);
std::int64_t nanoseconds_of(const evalio::Stamp& stamp);

/// Moves numbers to a numpy array of rows x `columns`, or (rows,) for one column. The numpy array owns the numbers.
template <class Scalar>
nb::object array_of(std::vector<Scalar> numbers, std::size_t columns = 1);

}  // namespace tumble::evalio_bindings
