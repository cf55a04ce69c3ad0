// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/recordings/clouds/cloud_file.hpp"

#include <fmt/format.h>

#include <pcl/PCLPointCloud2.h>

#include <algorithm>
#include <charconv>
#include <cstring>
#include <fstream>
#include <string_view>
#include <system_error>

#include "scenarios/errors.hpp"
#include "scenarios/recordings/clouds/pcl_reader.hpp"
#include "scenarios/recordings/clouds/vtk_file.hpp"
#include "scenarios/regular_file.hpp"

namespace tumble::scenarios {

namespace {

/// KITTI's .bin: x y z intensity.
constexpr std::size_t kKittiColumns = 4;

template <class Number>
void take_column(const pcl::PCLPointCloud2& cloud, std::size_t offset, std::vector<double>& out) {
  const std::size_t points = out.size();
  for (std::size_t i = 0; i < points; ++i) {
    Number value;
    std::memcpy(&value, cloud.data.data() + i * cloud.point_step + offset, sizeof(value));
    out[i] = static_cast<double>(value);
  }
}

/// False for a type that is no number.
bool take_field(const pcl::PCLPointCloud2& cloud, const pcl::PCLPointField& field, std::vector<double>& out) {
  using Field = pcl::PCLPointField;
  switch (field.datatype) {
    case Field::INT8:
      return take_column<std::int8_t>(cloud, field.offset, out), true;
    case Field::UINT8:
      return take_column<std::uint8_t>(cloud, field.offset, out), true;
    case Field::INT16:
      return take_column<std::int16_t>(cloud, field.offset, out), true;
    case Field::UINT16:
      return take_column<std::uint16_t>(cloud, field.offset, out), true;
    case Field::INT32:
      return take_column<std::int32_t>(cloud, field.offset, out), true;
    case Field::UINT32:
      return take_column<std::uint32_t>(cloud, field.offset, out), true;
    case Field::INT64:
      return take_column<std::int64_t>(cloud, field.offset, out), true;
    case Field::UINT64:
      return take_column<std::uint64_t>(cloud, field.offset, out), true;
    case Field::FLOAT32:
      return take_column<float>(cloud, field.offset, out), true;
    case Field::FLOAT64:
      return take_column<double>(cloud, field.offset, out), true;
    default:
      return false;
  }
}

std::string plain_name(const std::string& name) {
  constexpr std::string_view kPrefix = "scalar_";
  return name.starts_with(kPrefix) ? name.substr(kPrefix.size()) : name;
}

Cloud to_columns(const pcl::PCLPointCloud2& cloud, std::size_t points) {
  Cloud out;
  out.points = points;
  for (const pcl::PCLPointField& field : cloud.fields) {
    std::vector<double> column(points);
    // several numbers in one field, and bytes without meaning ("_"), are nothing that a sweep knows
    if (field.count > 1 || field.name == "_" || !take_field(cloud, field, column)) continue;
    out.names.push_back(plain_name(field.name));
    out.columns.push_back(std::move(column));
  }
  return out;
}

/// Whether a word is a number and nothing else: "nan" and "inf" are, "0,5" and "x" are not.
bool is_number_of_pcl(std::string_view word) {
  if (word.starts_with('+')) word.remove_prefix(1);
  double value = 0.0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  return error != std::errc::invalid_argument && end == word.data() + word.size();
}

/// The library reads a word up to where it stops being a number, and 0 or NaN where it is none: the words of a file
/// written as text are held to be numbers, as many in a line as the header says.
void require_numbers(const std::filesystem::path& path, const CloudHeader& header) {
  std::ifstream stream(path, std::ios::binary);
  std::string text(static_cast<std::size_t>(header.header_bytes), '\0');
  stream.read(text.data(), static_cast<std::streamsize>(text.size()));
  auto number = std::count(text.begin(), text.end(), '\n');
  std::string line;
  for (std::uint64_t points = 0; points < header.points && std::getline(stream, line);) {
    ++number;
    std::uint64_t words = 0;
    for (std::size_t begin = 0; (begin = line.find_first_not_of(" \t\r", begin)) != std::string::npos;) {
      const std::size_t end = std::min(line.find_first_of(" \t\r", begin), line.size());
      if (!is_number_of_pcl(std::string_view(line).substr(begin, end - begin))) {
        throw BadInput(
            fmt::format("{}:{}: word {} is not a number (use a decimal point)", path.string(), number, words + 1));
      }
      ++words;
      begin = end;
    }
    if (words == 0) continue;
    if (words != header.numbers) {
      throw BadInput(path.string() + ":" + std::to_string(number) + ": " + std::to_string(words) +
                     " numbers, must be " + std::to_string(header.numbers));
    }
    ++points;
  }
}

Cloud read_points(const std::filesystem::path& path, const CloudHeader& header, PclFormat format) {
  if (header.points == 0) return {};
  if (header.ascii) require_numbers(path, header);
  pcl::PCLPointCloud2 cloud;
  const bool read = read_by_pcl(path, format, cloud);
  const std::size_t found = std::size_t{cloud.width} * cloud.height;
  if (!read || found != header.points || cloud.data.size() < found * cloud.point_step) {
    throw BadInput(
        fmt::format("{}: cannot be read as {} after its header of {} bytes: the file is damaged or truncated",
                    path.string(), format == PclFormat::ply ? "PLY" : "PCD", header.header_bytes));
  }
  Cloud out = to_columns(cloud, found);
  out.viewpoint = header.viewpoint;
  return out;
}

Cloud read_kitti(const std::filesystem::path& path) {
  std::ifstream stream = open_regular_file(path);
  const std::uint64_t bytes = std::filesystem::file_size(path);
  constexpr std::uint64_t kPointBytes = kKittiColumns * sizeof(float);
  if (bytes % kPointBytes != 0) {
    throw BadInput(fmt::format(
        "{}: has {} bytes; the size must be a multiple of 16 (float32 x y z intensity), so the file may be truncated",
        path.string(), bytes));
  }
  std::vector<float> numbers(bytes / sizeof(float));
  stream.read(reinterpret_cast<char*>(numbers.data()), static_cast<std::streamsize>(bytes));
  if (static_cast<std::uint64_t>(stream.gcount()) != bytes) throw BadInput(path.string() + ": cannot be read");
  Cloud out;
  out.points = bytes / kPointBytes;
  out.names = {"x", "y", "z", "intensity"};
  out.columns.assign(kKittiColumns, std::vector<double>(out.points));
  for (std::size_t i = 0; i < numbers.size(); ++i) out.columns[i % kKittiColumns][i / kKittiColumns] = numbers[i];
  return out;
}

}  // namespace

const std::vector<double>* Cloud::find(const std::string& name) const {
  const auto found = std::find(names.begin(), names.end(), name);
  return found == names.end() ? nullptr : &columns[static_cast<std::size_t>(found - names.begin())];
}

Cloud read_cloud(const std::filesystem::path& path) {
  const std::string ending = path.extension().string();
  if (ending == ".ply") return read_points(path, read_ply_header(path), PclFormat::ply);
  if (ending == ".pcd") return read_points(path, read_pcd_header(path), PclFormat::pcd);
  if (ending == ".bin") return read_kitti(path);
  if (ending == ".vtk") return read_vtk(path);
  throw BadInput(path.string() + ": the file name must end in .ply, .pcd, .vtk or .bin");
}

}  // namespace tumble::scenarios
