// SPDX-License-Identifier: BSD-3-Clause
#include "sweeps.hpp"

#include <nanobind/ndarray.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>

namespace tumble::evalio_bindings {

namespace {

constexpr std::int64_t kSecond = 1'000'000'000;
constexpr std::int64_t kLongest = 4 * kSecond;  ///< limit of a 32-bit offset in nanoseconds

bool is_return(const evalio::Point& point) {
  const bool finite = std::isfinite(point.x) && std::isfinite(point.y) && std::isfinite(point.z);
  return finite && (point.x != 0.0 || point.y != 0.0 || point.z != 0.0);
}

void require_within_sweep(std::int64_t offset_ns) {
  if (offset_ns >= 0 && offset_ns <= kLongest) return;
  throw std::invalid_argument("the time of a return after the sweep's stamp is " + std::to_string(offset_ns) +
                              " ns; it must be within [0, " + std::to_string(kLongest) + "]");
}

void append(std::vector<double>& to, const Eigen::Vector3d& value) {
  to.insert(to.end(), value.data(), value.data() + 3);
}

}  // namespace

Sweep sweep_of(const evalio::LidarMeasurement& given, std::int64_t length_ns) {
  std::vector<const evalio::Point*> returns;
  returns.reserve(given.points.size());
  for (const evalio::Point& point : given.points) {
    if (!is_return(point)) continue;
    require_within_sweep(point.t.nsec);
    returns.push_back(&point);
  }
  // evalio expects the points in order of rows
  std::stable_sort(returns.begin(), returns.end(),
                   [](const evalio::Point* a, const evalio::Point* b) { return a->t.nsec < b->t.nsec; });
  Sweep out;
  out.start_ns = nanoseconds_of(given.stamp);
  out.last_ns = out.start_ns + (returns.empty() ? 0 : returns.back()->t.nsec);
  out.end_ns = std::max(out.start_ns + length_ns, out.last_ns);
  out.position_L_m.reserve(3 * returns.size());
  for (const evalio::Point* point : returns) {
    for (const double coordinate : {point->x, point->y, point->z})
      out.position_L_m.push_back(static_cast<float>(coordinate));
    out.offset_ns.push_back(static_cast<std::uint32_t>(point->t.nsec));
    out.ring.push_back(point->row);
    out.intensity.push_back(static_cast<float>(point->intensity));
  }
  return out;
}

void Samples::push(const evalio::ImuMeasurement& given) {
  time_ns.push_back(nanoseconds_of(given.stamp));
  append(gyro_I_rad_s, given.gyro);
  append(accel_I_m_s2, given.accel);
}

Samples Samples::from(std::size_t first) const {
  const auto k = static_cast<std::ptrdiff_t>(first);
  return {{time_ns.begin() + k, time_ns.end()},
          {gyro_I_rad_s.begin() + 3 * k, gyro_I_rad_s.end()},
          {accel_I_m_s2.begin() + 3 * k, accel_I_m_s2.end()}};
}

evalio::SE3 pose_of(const double* position, const double* quaternion) {
  const evalio::SO3 rotation{.qx = quaternion[0], .qy = quaternion[1], .qz = quaternion[2], .qw = quaternion[3]};
  return evalio::SE3(rotation, Eigen::Vector3d(position[0], position[1], position[2]));
}

// evalio's from_nsec uses a double, which cannot represent nanoseconds since 1970
evalio::Stamp stamp_of(std::int64_t time_ns) {
  return {.sec = static_cast<std::uint32_t>(time_ns / kSecond), .nsec = static_cast<std::uint32_t>(time_ns % kSecond)};
}

std::int64_t nanoseconds_of(const evalio::Stamp& stamp) {
  return static_cast<std::int64_t>(stamp.sec) * kSecond + static_cast<std::int64_t>(stamp.nsec);
}

template <class Scalar>
nb::object array_of(std::vector<Scalar> numbers, std::size_t columns) {
  auto kept = std::make_unique<std::vector<Scalar>>(std::move(numbers));
  Scalar* const data = kept->data();
  const std::size_t shape[] = {kept->size() / columns, columns};
  const std::size_t axes = columns == 1 ? 1 : 2;
  const nb::capsule owner(kept.release(), [](void* at) noexcept { delete static_cast<std::vector<Scalar>*>(at); });
  return nb::cast(nb::ndarray<nb::numpy, Scalar>(data, axes, shape, owner));
}

template nb::object array_of(std::vector<std::int64_t>, std::size_t);
template nb::object array_of(std::vector<std::uint32_t>, std::size_t);
template nb::object array_of(std::vector<std::uint16_t>, std::size_t);
template nb::object array_of(std::vector<float>, std::size_t);
template nb::object array_of(std::vector<double>, std::size_t);

}  // namespace tumble::evalio_bindings
