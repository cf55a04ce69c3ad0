// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "scenarios/recordings/hdf5_layout.hpp"
#include "scenarios/recordings/scratch_file.hpp"

/// Every error of Group is a BadInput with file and place; the HDF5 library prints nothing.
namespace tumble::scenarios::hdf5 {

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
