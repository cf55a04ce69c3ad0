// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/recordings/hdf5_group.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>

#include "scenarios/recordings/hdf5_file.hpp"

namespace tumble::scenarios::hdf5 {

namespace {

/// The compression method deflate reduces data by at most a factor of 1032. A dataset with a higher ratio is
/// incomplete, and HDF5 would return zeros for the missing part.
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
    fail(name, fmt::format("the dataset must have the shape N{} (N: any number of rows)",
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

namespace {

/// Maximum length of a text [bytes]. A damaged file may contain a text length that is so large that reading the text
/// would exhaust the memory.
constexpr std::size_t kLongestText = std::size_t{16} << 20;

/// The HDF5 library rejects text types of length 0.
Handle text_type(std::size_t length) {
  Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_size(type.get(), std::max<std::size_t>(length, 1));
  H5Tset_strpad(type.get(), H5T_STR_NULLPAD);
  H5Tset_cset(type.get(), H5T_CSET_UTF8);
  return type;
}

std::string until_zero(const char* text, std::size_t length) {
  return {text, std::find(text, text + length, '\0')};
}

bool is_signed(const Handle& type) {
  return H5Tget_sign(type.get()) == H5T_SGN_2;
}

}  // namespace

void Group::write_attribute(const std::string& name, const std::string& value) const {
  const Handle type = text_type(value.size());
  const Handle space(H5Screate(H5S_SCALAR), H5Sclose);
  const Handle attribute(H5Acreate2(group_.get(), name.c_str(), type.get(), space.get(), H5P_DEFAULT, H5P_DEFAULT),
                         H5Aclose);
  if (!attribute.valid() || H5Awrite(attribute.get(), type.get(), value.c_str()) < 0)
    fail(name, "cannot be written" + last_error());
}

void Group::write_attribute(const std::string& name, double value) const {
  write_number(name, Scalar::float64, &value);
}
void Group::write_attribute(const std::string& name, std::int64_t value) const {
  write_number(name, Scalar::int64, &value);
}
void Group::write_attribute(const std::string& name, std::uint64_t value) const {
  write_number(name, Scalar::uint64, &value);
}

void Group::write_number(const std::string& name, Scalar scalar, const void* value) const {
  const hid_t type = memory_type(scalar);
  const Handle space(H5Screate(H5S_SCALAR), H5Sclose);
  const Handle attribute(H5Acreate2(group_.get(), name.c_str(), type, space.get(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  if (!attribute.valid() || H5Awrite(attribute.get(), type, value) < 0) fail(name, "cannot be written" + last_error());
}

Handle Group::open_attribute(const std::string& name) const {
  if (!has_attribute(name)) fail(name, "attribute is missing");
  Handle attribute(H5Aopen(group_.get(), name.c_str(), H5P_DEFAULT), H5Aclose);
  if (!attribute.valid()) fail(name, fmt::format("the attribute cannot be read{}", last_error()));
  const Handle space(H5Aget_space(attribute.get()), H5Sclose);
  if (H5Sget_simple_extent_npoints(space.get()) != 1) fail(name, "the attribute must have a single value");
  return attribute;
}

std::string Group::text_attribute(const std::string& name) const {
  const Handle attribute = open_attribute(name);
  const Handle type(H5Aget_type(attribute.get()), H5Tclose);
  if (H5Tget_class(type.get()) != H5T_STRING) fail(name, "the attribute must be text");
  if (H5Tis_variable_str(type.get()) > 0) {  // h5py writes texts of variable length
    char* text = nullptr;
    if (H5Aread(attribute.get(), type.get(), &text) < 0 || text == nullptr)
      fail(name, fmt::format("the attribute cannot be read{}", last_error()));
    std::string out(text);
    H5free_memory(text);
    return out;
  }
  std::string text(H5Tget_size(type.get()), '\0');
  if (text.size() > kLongestText) fail(name, "the text of this HDF5 attribute is longer than the maximum of 16 MiB");
  if (H5Aread(attribute.get(), type.get(), text.data()) < 0)
    fail(name, fmt::format("the attribute cannot be read{}", last_error()));
  return until_zero(text.data(), text.size());
}

double Group::double_attribute(const std::string& name) const {
  const Handle attribute = open_attribute(name);
  const Handle type(H5Aget_type(attribute.get()), H5Tclose);
  const H5T_class_t kind = H5Tget_class(type.get());
  if (kind != H5T_FLOAT && kind != H5T_INTEGER) fail(name, "the attribute must be a number");
  double value = 0.0;
  if (H5Aread(attribute.get(), H5T_NATIVE_DOUBLE, &value) < 0)
    fail(name, fmt::format("the attribute cannot be read{}", last_error()));
  return value;
}

std::int64_t Group::int_attribute(const std::string& name) const {
  const Handle attribute = open_attribute(name);
  const Handle type(H5Aget_type(attribute.get()), H5Tclose);
  if (H5Tget_class(type.get()) != H5T_INTEGER) fail(name, "the attribute must be an integer");
  std::int64_t value = 0;
  if (H5Aread(attribute.get(), H5T_NATIVE_INT64, &value) < 0)
    fail(name, fmt::format("the attribute cannot be read{}", last_error()));
  // If a stored integer exceeds the range of int64, the HDF5 library returns the largest int64.
  if (!is_signed(type) && value == std::numeric_limits<std::int64_t>::max())
    fail(name, "the attribute is too large for a signed 64-bit integer");
  return value;
}

std::uint64_t Group::uint_attribute(const std::string& name) const {
  const Handle attribute = open_attribute(name);
  const Handle type(H5Aget_type(attribute.get()), H5Tclose);
  if (H5Tget_class(type.get()) != H5T_INTEGER) fail(name, "the attribute must be an integer");
  if (is_signed(type)) {
    const std::int64_t value = int_attribute(name);
    if (value < 0) fail(name, "the HDF5 attribute is negative, but must be at least 0");
    return static_cast<std::uint64_t>(value);
  }
  std::uint64_t value = 0;
  if (H5Aread(attribute.get(), H5T_NATIVE_UINT64, &value) < 0)
    fail(name, fmt::format("the attribute cannot be read{}", last_error()));
  return value;
}

void Group::write_texts(const std::string& name, const std::vector<std::string>& texts) const {
  std::size_t longest = 1;
  for (const std::string& text : texts) longest = std::max(longest, text.size());
  std::vector<char> block(longest * std::max<std::size_t>(texts.size(), 1), '\0');
  for (std::size_t i = 0; i < texts.size(); ++i)
    std::copy(texts[i].begin(), texts[i].end(), block.begin() + static_cast<std::ptrdiff_t>(i * longest));
  const Handle type = text_type(longest);
  const hsize_t count = texts.size();
  const Handle space(H5Screate_simple(1, &count, nullptr), H5Sclose);
  const Handle creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  H5Pset_obj_track_times(creation.get(), false);
  const Handle dataset(
      H5Dcreate2(group_.get(), name.c_str(), type.get(), space.get(), H5P_DEFAULT, creation.get(), H5P_DEFAULT),
      H5Dclose);
  if (!dataset.valid() || H5Dwrite(dataset.get(), type.get(), H5S_ALL, H5S_ALL, H5P_DEFAULT, block.data()) < 0) {
    fail(name, "cannot be written" + last_error());
  }
}

std::vector<std::string> Group::read_texts(const std::string& name) const {
  const Handle dataset = open_dataset(name);
  const Handle type(H5Dget_type(dataset.get()), H5Tclose);
  const Handle space(H5Dget_space(dataset.get()), H5Sclose);
  if (H5Tget_class(type.get()) != H5T_STRING) fail(name, "must hold text");
  if (H5Sget_simple_extent_ndims(space.get()) != 1) fail(name, "must have one dimension");
  hsize_t count = 0;
  H5Sget_simple_extent_dims(space.get(), &count, nullptr);
  std::vector<std::string> texts;
  if (H5Tis_variable_str(type.get()) > 0) {
    if (count > kLongestText / sizeof(char*))
      fail(name, "the HDF5 dataset of texts has more than 2 million rows, which is the maximum");
    std::vector<char*> rows(count, nullptr);
    if (count > 0 && H5Dread(dataset.get(), type.get(), H5S_ALL, H5S_ALL, H5P_DEFAULT, rows.data()) < 0) {
      fail(name, "cannot be read" + last_error());
    }
    for (const char* row : rows) texts.emplace_back(row == nullptr ? "" : row);
    H5Dvlen_reclaim(type.get(), space.get(), H5P_DEFAULT, rows.data());
    return texts;
  }
  const std::size_t length = H5Tget_size(type.get());
  if (length == 0 || count > kLongestText / length)
    fail(name, "the texts of this HDF5 dataset are longer than the maximum of 16 MiB");
  std::vector<char> block(length * count);
  if (count > 0 && H5Dread(dataset.get(), type.get(), H5S_ALL, H5S_ALL, H5P_DEFAULT, block.data()) < 0) {
    fail(name, "cannot be read" + last_error());
  }
  for (std::size_t i = 0; i < count; ++i) texts.push_back(until_zero(block.data() + i * length, length));
  return texts;
}

}  // namespace tumble::scenarios::hdf5
