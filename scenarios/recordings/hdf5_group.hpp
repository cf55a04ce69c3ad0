// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <hdf5.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "scenarios/recordings/scratch_file.hpp"

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

/// Every error in Group throws BadInput with the file and the location in the file; the HDF5 library prints nothing.

class Group {
 public:
  Group() = default;
  Group(Handle group, std::string file, std::string place)
      : group_(std::move(group)), file_(std::move(file)), place_(std::move(place)) {}

  Group open(const std::string& name) const;
  Group create(const std::string& name) const;
  bool has(const std::string& name) const;
  std::size_t count() const;  ///< number of groups and datasets in this group
  bool has_attribute(const std::string& name) const;
  [[noreturn]] void fail(const std::string& name, const std::string& what) const;

  void write_attribute(const std::string& name, const std::string& value) const;
  void write_attribute(const std::string& name, double value) const;
  void write_attribute(const std::string& name, std::int64_t value) const;
  void write_attribute(const std::string& name, std::uint64_t value) const;
  std::string text_attribute(const std::string& name) const;
  double double_attribute(const std::string& name) const;
  std::int64_t int_attribute(const std::string& name) const;
  std::uint64_t uint_attribute(const std::string& name) const;

  template <class Row>
  void write(const std::string& name, const std::vector<Row>& rows, const std::string& unit, const std::string& columns,
             bool compressed) const {
    write_rows(name, rows.data(), rows.size(), RowLayout<Row>::columns, RowLayout<Row>::scalar, unit, columns,
               compressed);
  }
  template <class Row>
  void write(const std::string& name, const ColumnFile<Row>& rows, const std::string& unit, const std::string& columns,
             bool compressed) const {
    Handle dataset = create_rows(name, rows.size(), RowLayout<Row>::columns, RowLayout<Row>::scalar, compressed);
    rows.for_segments(rows_in_chunk(sizeof(Row)), [&](std::size_t first, std::span<const Row> segment) {
      write_segment(dataset, name, first, segment.data(), segment.size(), RowLayout<Row>::columns,
                    RowLayout<Row>::scalar);
    });
    describe_rows(std::move(dataset), name, unit, columns);
  }
  template <class Row>
  void read(const std::string& name, std::vector<Row>& rows) const {
    const Handle dataset = open_dataset(name);
    rows.resize(count_rows(dataset, name, RowLayout<Row>::columns, RowLayout<Row>::scalar));
    read_rows(dataset, name, rows.data(), rows.size(), RowLayout<Row>::scalar);
  }
  template <class Row>
  void read(const std::string& name, ColumnFile<Row>& rows) const {
    const Handle dataset = open_dataset(name);
    const std::size_t count = count_rows(dataset, name, RowLayout<Row>::columns, RowLayout<Row>::scalar);
    std::vector<Row> segment;
    for (std::size_t first = 0; first < count; first += segment.size()) {
      segment.resize(std::min(rows_in_chunk(sizeof(Row)), count - first));
      read_segment(dataset, name, first, segment.data(), segment.size(), RowLayout<Row>::columns,
                   RowLayout<Row>::scalar);
      rows.append(std::span(std::as_const(segment)));
    }
  }
  void write_texts(const std::string& name, const std::vector<std::string>& texts) const;
  std::vector<std::string> read_texts(const std::string& name) const;

 private:
  void write_rows(const std::string& name, const void* data, std::size_t rows, std::size_t columns, Scalar scalar,
                  const std::string& unit, const std::string& column_names, bool compressed) const;
  Handle create_rows(const std::string& name, std::size_t rows, std::size_t columns, Scalar scalar,
                     bool compressed) const;
  void describe_rows(Handle dataset, const std::string& name, const std::string& unit,
                     const std::string& column_names) const;
  void write_segment(const Handle& dataset, const std::string& name, std::size_t first, const void* data,
                     std::size_t rows, std::size_t columns, Scalar scalar) const;
  void read_segment(const Handle& dataset, const std::string& name, std::size_t first, void* data, std::size_t rows,
                    std::size_t columns, Scalar scalar) const;
  Handle open_dataset(const std::string& name) const;
  std::size_t count_rows(const Handle& dataset, const std::string& name, std::size_t columns, Scalar scalar) const;
  void read_rows(const Handle& dataset, const std::string& name, void* data, std::size_t rows, Scalar scalar) const;
  void write_number(const std::string& name, Scalar scalar, const void* value) const;
  Handle open_attribute(const std::string& name) const;

  Handle group_;
  std::string file_;
  std::string place_;
};

}  // namespace tumble::scenarios::hdf5
