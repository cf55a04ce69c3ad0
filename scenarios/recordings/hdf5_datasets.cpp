// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "scenarios/recordings/hdf5_file.hpp"

namespace tumble::scenarios::hdf5 {

namespace {

/// Deflate compresses by at most a factor of 1032; a dataset with a higher ratio is incomplete, and HDF5 would return
/// zeros for the missing part.
constexpr std::uint64_t kBestDeflation = 1100;

const char* name_of(Scalar scalar) {
  constexpr std::array<const char*, 8> kNames = {"float64", "float32", "int64",  "int32",
                                                 "uint64",  "uint32",  "uint16", "uint8"};
  return kNames[static_cast<std::size_t>(scalar)];
}

std::size_t size_of(Scalar scalar) {
  return H5Tget_size(memory_type(scalar));
}

bool matches(hid_t type, Scalar scalar) {
  const hid_t wanted = memory_type(scalar);
  const H5T_class_t kind = H5Tget_class(wanted);
  if (H5Tget_class(type) != kind || H5Tget_size(type) != H5Tget_size(wanted)) return false;
  return kind != H5T_INTEGER || H5Tget_sign(type) == H5Tget_sign(wanted);
}

Handle creation_properties(std::size_t rows, std::size_t columns, std::size_t row_bytes, bool compressed) {
  Handle properties(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  H5Pset_obj_track_times(properties.get(), false);
  if (!compressed || rows == 0) return properties;
  const std::array<hsize_t, 2> chunk = {std::min<hsize_t>(rows, rows_in_chunk(row_bytes)), columns};
  H5Pset_chunk(properties.get(), columns == 1 ? 1 : 2, chunk.data());
  H5Pset_shuffle(properties.get());
  H5Pset_deflate(properties.get(), 1);
  return properties;
}

Handle space_of(std::size_t rows, std::size_t columns) {
  const std::array<hsize_t, 2> extent = {rows, columns};
  return Handle(H5Screate_simple(columns == 1 ? 1 : 2, extent.data(), nullptr), H5Sclose);
}

Handle segment_of(const Handle& dataset, std::size_t first, std::size_t rows, std::size_t columns) {
  Handle space(H5Dget_space(dataset.get()), H5Sclose);
  const std::array<hsize_t, 2> start = {first, 0}, count = {rows, columns};
  H5Sselect_hyperslab(space.get(), H5S_SELECT_SET, start.data(), nullptr, count.data(), nullptr);
  return space;
}

}  // namespace

hid_t memory_type(Scalar scalar) {
  switch (scalar) {
    case Scalar::float64:
      return H5T_NATIVE_DOUBLE;
    case Scalar::float32:
      return H5T_NATIVE_FLOAT;
    case Scalar::int64:
      return H5T_NATIVE_INT64;
    case Scalar::int32:
      return H5T_NATIVE_INT32;
    case Scalar::uint64:
      return H5T_NATIVE_UINT64;
    case Scalar::uint32:
      return H5T_NATIVE_UINT32;
    case Scalar::uint16:
      return H5T_NATIVE_UINT16;
    case Scalar::uint8:
      return H5T_NATIVE_UINT8;
  }
  return -1;
}

Handle Group::create_rows(const std::string& name, std::size_t rows, std::size_t columns, Scalar scalar,
                          bool compressed) const {
  const Handle space = space_of(rows, columns);
  const Handle properties = creation_properties(rows, columns, columns * size_of(scalar), compressed);
  Handle dataset(H5Dcreate2(group_.get(), name.c_str(), memory_type(scalar), space.get(), H5P_DEFAULT, properties.get(),
                            H5P_DEFAULT),
                 H5Dclose);
  if (!dataset.valid()) fail(name, "cannot be created" + last_error());
  return dataset;
}

void Group::describe_rows(Handle dataset, const std::string& name, const std::string& unit,
                          const std::string& column_names) const {
  const Group object(std::move(dataset), file_, place_ + "/" + name);
  object.write_attribute("unit", unit);
  if (!column_names.empty()) object.write_attribute("columns", column_names);
}

void Group::write_rows(const std::string& name, const void* data, std::size_t rows, std::size_t columns, Scalar scalar,
                       const std::string& unit, const std::string& column_names, bool compressed) const {
  Handle dataset = create_rows(name, rows, columns, scalar, compressed);
  if (rows > 0 && H5Dwrite(dataset.get(), memory_type(scalar), H5S_ALL, H5S_ALL, H5P_DEFAULT, data) < 0) {
    fail(name, "cannot be written" + last_error());
  }
  describe_rows(std::move(dataset), name, unit, column_names);
}

void Group::write_segment(const Handle& dataset, const std::string& name, std::size_t first, const void* data,
                          std::size_t rows, std::size_t columns, Scalar scalar) const {
  const Handle memory = space_of(rows, columns), space = segment_of(dataset, first, rows, columns);
  if (H5Dwrite(dataset.get(), memory_type(scalar), memory.get(), space.get(), H5P_DEFAULT, data) < 0) {
    fail(name, "cannot be written" + last_error());
  }
}

void Group::read_segment(const Handle& dataset, const std::string& name, std::size_t first, void* data,
                         std::size_t rows, std::size_t columns, Scalar scalar) const {
  const Handle memory = space_of(rows, columns), space = segment_of(dataset, first, rows, columns);
  if (H5Dread(dataset.get(), memory_type(scalar), memory.get(), space.get(), H5P_DEFAULT, data) < 0) {
    fail(name, "cannot be read" + last_error());
  }
}

Handle Group::open_dataset(const std::string& name) const {
  if (!has(name)) fail(name, "dataset is missing");
  Handle dataset(H5Dopen2(group_.get(), name.c_str(), H5P_DEFAULT), H5Dclose);
  if (!dataset.valid()) fail(name, fmt::format("the dataset cannot be read{}", last_error()));
  return dataset;
}

std::size_t Group::count_rows(const Handle& dataset, const std::string& name, std::size_t columns,
                              Scalar scalar) const {
  const Handle type(H5Dget_type(dataset.get()), H5Tclose);
  if (!matches(type.get(), scalar)) fail(name, std::string("must hold ") + name_of(scalar));
  const Handle space(H5Dget_space(dataset.get()), H5Sclose);
  const int wanted = columns == 1 ? 1 : 2;
  std::array<hsize_t, 2> extent = {0, 1};
  const bool same_dimensions = H5Sget_simple_extent_ndims(space.get()) == wanted;
  if (same_dimensions) H5Sget_simple_extent_dims(space.get(), extent.data(), nullptr);
  if (!same_dimensions || extent[1] != columns) {
    fail(name, fmt::format("the dataset must have the shape N{}",
                           (columns == 1 ? std::string() : " x " + std::to_string(columns))));
  }
  const std::uint64_t row_bytes = columns * size_of(scalar);
  const std::uint64_t most_rows = H5Dget_storage_size(dataset.get()) * kBestDeflation / row_bytes;
  if (extent[0] > most_rows) {
    fail(name,
         fmt::format("the HDF5 dataset states {} rows, which is more than the file contains; the file may be truncated",
                     extent[0]));
  }
  return extent[0];
}

void Group::read_rows(const Handle& dataset, const std::string& name, void* data, std::size_t rows,
                      Scalar scalar) const {
  if (rows == 0) return;
  if (H5Dread(dataset.get(), memory_type(scalar), H5S_ALL, H5S_ALL, H5P_DEFAULT, data) < 0) {
    fail(name, "cannot be read" + last_error());
  }
}

}  // namespace tumble::scenarios::hdf5
