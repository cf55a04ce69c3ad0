// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <hdf5.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>

namespace tumble::scenarios::hdf5 {

class Handle {
 public:
  using Close = herr_t (*)(hid_t);
  Handle() = default;
  Handle(hid_t id, Close close) : id_(id), close_(close) {}
  Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, -1)), close_(other.close_) {}
  Handle& operator=(Handle&& other) noexcept;
  ~Handle();
  bool valid() const { return id_ >= 0; }
  hid_t get() const { return id_; }

 private:
  hid_t id_ = -1;
  Close close_ = nullptr;
};

class Silence {
 public:
  Silence();
  ~Silence();
  Silence(const Silence&) = delete;
  Silence& operator=(const Silence&) = delete;

 private:
  H5E_auto2_t function_ = nullptr;
  void* data_ = nullptr;
};

enum class Scalar : std::uint8_t { float64, float32, int64, int32, uint64, uint32, uint16, uint8 };

template <class Row>
struct RowLayout;
template <Scalar kScalarOfRow, std::size_t kColumns>
struct Layout {
  static constexpr Scalar scalar = kScalarOfRow;
  static constexpr std::size_t columns = kColumns;
};
template <>
struct RowLayout<double> : Layout<Scalar::float64, 1> {};
template <>
struct RowLayout<float> : Layout<Scalar::float32, 1> {};
template <>
struct RowLayout<std::int64_t> : Layout<Scalar::int64, 1> {};
template <>
struct RowLayout<std::int32_t> : Layout<Scalar::int32, 1> {};
template <>
struct RowLayout<std::uint64_t> : Layout<Scalar::uint64, 1> {};
template <>
struct RowLayout<std::uint32_t> : Layout<Scalar::uint32, 1> {};
template <>
struct RowLayout<std::uint16_t> : Layout<Scalar::uint16, 1> {};
template <>
struct RowLayout<std::uint8_t> : Layout<Scalar::uint8, 1> {};
template <>
struct RowLayout<Eigen::Vector3d> : Layout<Scalar::float64, 3> {};
template <>
struct RowLayout<Eigen::Vector3f> : Layout<Scalar::float32, 3> {};
template <>
struct RowLayout<Eigen::Vector4d> : Layout<Scalar::float64, 4> {};
template <>
struct RowLayout<Eigen::Quaterniond> : Layout<Scalar::float64, 4> {};
static_assert(sizeof(Eigen::Vector3d) == 24 && sizeof(Eigen::Vector3f) == 12 && sizeof(Eigen::Quaterniond) == 32);

inline constexpr std::size_t kChunkBytes = std::size_t{1} << 20;
constexpr std::size_t rows_in_chunk(std::size_t row_bytes) {
  return std::max<std::size_t>(kChunkBytes / row_bytes, 1);
}

hid_t memory_type(Scalar scalar);

std::string last_error();

}  // namespace tumble::scenarios::hdf5
