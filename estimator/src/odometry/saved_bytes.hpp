// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <type_traits>
#include <vector>

#include "tumble/angular_velocity/detail/clipping_finder.hpp"
#include "tumble/common/parameters.hpp"
#include "tumble/common/status.hpp"
#include "tumble/common/types.hpp"

/// saved_bytes.hpp writes and reads saved runs and saved maps. All numbers are little-endian.
///
/// | bytes | |
/// | --- | --- |
/// | 0 | "tumblest" |
/// | 8 | version of the format, 4 bytes |
/// | 12 | SavedStateKind, 4 bytes |
/// | 16 | layout of this kind, 8 bytes |
/// | 24 | number of bytes from 40 on |
/// | 32 | checksum of all other bytes |
/// | 40 | contents |
///
/// If the contents of a SavedStateKind change, the layout number of this kind in saved_bytes.cpp must change.

namespace tumble::odometry {

enum class SavedStateKind : std::uint32_t { tumbling = 1, rolling = 2, map = 9 };
inline constexpr std::size_t kSavedHeader = 40;
inline constexpr double kPositionMax_m = 1e6, kVarianceMax = 1e12;

/// SavedStateReader reads the numbers in the order in which SavedStateWriter has appended the numbers.
class SavedStateWriter {
 public:
  template <class T>
  void operator()(const char* name, const T& value, double /*low*/ = 0.0, double /*high*/ = 0.0) {
    if constexpr (std::is_arithmetic_v<T>) {
      std::array<std::byte, sizeof(T)> bytes = std::bit_cast<std::array<std::byte, sizeof(T)>>(value);
      if constexpr (std::endian::native == std::endian::big) std::reverse(bytes.begin(), bytes.end());
      bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
    } else if constexpr (std::same_as<T, Eigen::Isometry3d>) {
      (*this)(name, value.matrix());
    } else {
      for (const auto& number : value.reshaped()) (*this)(name, number);
    }
  }
  template <class T>
  bool presence_flag(const char* name, const std::optional<T>& value) {
    (*this)(name, value.has_value());
    return value.has_value();
  }
  void append_bytes(std::span<const std::byte> bytes) { bytes_.insert(bytes_.end(), bytes.begin(), bytes.end()); }
  void reserve(std::size_t bytes) { bytes_.reserve(kSavedHeader + bytes); }
  std::vector<std::byte> finish(SavedStateKind kind) &&;

 private:
  std::vector<std::byte> bytes_ = std::vector<std::byte>(kSavedHeader);
};

/// SavedStateReader reads numbers from untrusted bytes, without allocating memory. After the first error,
/// SavedStateReader stops reading, and all values are invalid. The errors are `insufficient_data` (the bytes end within
/// `field`), `non_finite` and `out_of_range`.
class SavedStateReader {
 public:
  SavedStateReader(SavedStateKind kind, std::span<const std::byte> bytes);

  /// Reports an error unless all numbers of the matrix are between `low` and `high`.
  template <class T>
  void operator()(const char* name, T& value, double low = -kUnbounded, double high = kUnbounded) {
    if constexpr (std::is_arithmetic_v<T>) {
      read(name, value, low, high);
    } else if constexpr (std::same_as<T, Eigen::Isometry3d>) {
      (*this)(name, value.matrix(), low, high);
      value.makeAffine();
    } else {
      for (auto& number : value.reshaped()) read(name, number, low, high);
    }
  }
  template <class T>
  bool presence_flag(const char* name, std::optional<T>& value) {
    value.reset();
    bool there = false;
    (*this)(name, there);
    if (there && status_.ok()) value.emplace();
    return value.has_value();
  }
  void require_condition(const char* name, bool holds, double value, double bound) {
    if (status_.ok() && !holds) status_ = {ErrorCode::out_of_range, name, value, bound};
  }
  /// Reports an error unless `P` is symmetric and positive semidefinite.
  void require_covariance(const char* name, const Eigen::Ref<const Eigen::MatrixXd>& P);
  /// Reports an error if a parameter of the saved run differs from the parameter of the object that loads the run.
  template <class Matrix>
  void require_equal(const char* name, const Matrix& saved, const Matrix& given) {
    for (Eigen::Index k = 0; k < saved.size(); ++k) require_condition(name, saved(k) == given(k), saved(k), given(k));
  }
  std::span<const std::byte> remaining_bytes() const { return remaining_bytes_; }
  const Status& status() const { return status_; }

 private:
  template <class N>
  void read(const char* name, N& value, double low, double high) {
    if (!status_.ok()) return;
    if (remaining_bytes_.size() < sizeof(N)) {
      status_ = {ErrorCode::insufficient_data, name, double(remaining_bytes_.size()), double(sizeof(N))};
      return;
    }
    std::array<std::byte, sizeof(N)> bytes;
    std::copy_n(remaining_bytes_.begin(), sizeof(N), bytes.begin());
    remaining_bytes_ = remaining_bytes_.subspan(sizeof(N));
    if constexpr (std::endian::native == std::endian::big) std::reverse(bytes.begin(), bytes.end());
    if constexpr (std::same_as<N, bool>) {
      require_condition(name, bytes[0] <= std::byte{1}, double(std::to_integer<int>(bytes[0])), 1.0);
      value = bytes[0] == std::byte{1};
    } else {
      value = std::bit_cast<N>(bytes);
      const auto number = static_cast<double>(value);
      if (!std::isfinite(number)) status_ = {ErrorCode::non_finite, name, number, high};
      require_condition(name, number >= low && number <= high, number, number > high ? high : low);
    }
  }

  std::span<const std::byte> remaining_bytes_;
  Status status_;
};

template <class Visit, class Pose>
void visit_pose(Visit& visit, Pose& pose) {
  visit("pose.time_ns", pose.time_ns);
  visit("pose.p_WA_m", pose.position_W_m, -kPositionMax_m, kPositionMax_m);
  visit("pose.q_WA", pose.orientation_W.coeffs(), -1.0, 1.0);
  visit("pose.covariance", pose.covariance, -kVarianceMax, kVarianceMax);
}
void check_pose(SavedStateReader& in, const PoseState& pose);

void write_saturation_levels(const SaturationLevels& rails, SavedStateWriter& out);
void read_saturation_levels(SavedStateReader& in, SaturationLevels& rails);

void start_from_saturation_levels(const SaturationLevels& rails, SaturationLimitDetector::Params& detector,
                                  SaturationPlaneFinder::Params& gyro, SaturationPlaneFinder::Params& accel);

}  // namespace tumble::odometry
