// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/recordings/clouds/cloud_file.hpp"

#include <fmt/format.h>

#include <pcl/PCLPointCloud2.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstring>
#include <fstream>
#include <sstream>
#include <string_view>
#include <system_error>
#include <utility>

#include "scenarios/errors.hpp"
#include "scenarios/recordings/clouds/bin_layout.hpp"
#include "scenarios/recordings/clouds/pcl_reader.hpp"
#include "scenarios/recordings/clouds/vtk_file.hpp"
#include "scenarios/recordings/lower_extension.hpp"
#include "scenarios/regular_file.hpp"

namespace tumble::scenarios {

namespace {

template <class Number>
void take_column(const pcl::PCLPointCloud2& cloud, std::size_t offset, std::vector<double>& out) {
  const std::size_t points = out.size();
  for (std::size_t i = 0; i < points; ++i) {
    Number value;
    std::memcpy(&value, cloud.data.data() + i * cloud.point_step + offset, sizeof(value));
    out[i] = static_cast<double>(value);
  }
}

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
    if (field.count > 1 || field.name == "_" || !take_field(cloud, field, column)) continue;
    out.names.push_back(plain_name(field.name));
    out.columns.push_back(std::move(column));
  }
  return out;
}

bool is_number_of_pcl(std::string_view word) {
  if (word.starts_with('+')) word.remove_prefix(1);
  double value = 0.0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  return error != std::errc::invalid_argument && end == word.data() + word.size();
}

/// The words of text files are checked first, because PCL reads a malformed word such as "1.2x" as 1.2, 0 or NaN,
/// without an error.
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
      throw BadInput(path.string() + ":" + std::to_string(number) + ": the line has " + std::to_string(words) +
                     " numbers; it must have " + std::to_string(header.numbers));
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
        fmt::format("{}: the file cannot be read as {} after its header of {} bytes; it is damaged or truncated",
                    path.string(), format == PclFormat::ply ? "PLY" : "PCD", header.header_bytes));
  }
  Cloud out = to_columns(cloud, found);
  out.viewpoint = header.viewpoint;
  return out;
}

constexpr std::array<std::pair<const char*, std::uint8_t>, 10> kBinTypes = {{{"f4", pcl::PCLPointField::FLOAT32},
                                                                             {"f8", pcl::PCLPointField::FLOAT64},
                                                                             {"u1", pcl::PCLPointField::UINT8},
                                                                             {"u2", pcl::PCLPointField::UINT16},
                                                                             {"u4", pcl::PCLPointField::UINT32},
                                                                             {"u8", pcl::PCLPointField::UINT64},
                                                                             {"i1", pcl::PCLPointField::INT8},
                                                                             {"i2", pcl::PCLPointField::INT16},
                                                                             {"i4", pcl::PCLPointField::INT32},
                                                                             {"i8", pcl::PCLPointField::INT64}}};

void add_bin_column(const std::string& text, pcl::PCLPointCloud2& cloud) {
  const std::size_t colon = text.find(':');
  const std::string type = colon == std::string::npos ? "f4" : text.substr(colon + 1);
  const auto known = std::ranges::find_if(kBinTypes, [&](const auto& each) { return type == each.first; });
  if (known == kBinTypes.end())
    throw BadInput(
        fmt::format("columns of a .bin file: the type '{}' must be f4, f8, u1, u2, u4, u8, i1, i2, i4 or i8", type));
  pcl::PCLPointField field;
  field.name = text.substr(0, colon);
  field.offset = cloud.point_step;
  field.datatype = known->second;
  field.count = 1;
  const auto same = [&](const pcl::PCLPointField& other) { return other.name == field.name && field.name != "_"; };
  if (field.name.empty() || std::ranges::any_of(cloud.fields, same))
    throw BadInput(fmt::format("columns of a .bin file: the name '{}' is empty or occurs twice; names must be unique",
                               field.name));
  cloud.point_step += static_cast<std::uint32_t>(type.back() - '0');
  cloud.fields.push_back(field);
}

pcl::PCLPointCloud2 bin_fields(const std::string& columns) {
  pcl::PCLPointCloud2 cloud;
  std::istringstream stream(columns + ",");
  for (std::string column; std::getline(stream, column, ',');) add_bin_column(column, cloud);
  for (const char* needed : {"x", "y", "z"}) {
    if (std::ranges::none_of(cloud.fields, [&](const auto& field) { return field.name == needed; }))
      throw BadInput(fmt::format("columns of a .bin file: the list '{}' lacks the column {}", columns, needed));
  }
  return cloud;
}

constexpr const char* kColumnsHint =
    " (set --bin-columns to the columns in order, for example x,y,z,intensity,ring, or x:f8,y:f8,z:f8,intensity:f8 for "
    "doubles)";

Cloud read_bin(const std::filesystem::path& path, const std::string& columns) {
  pcl::PCLPointCloud2 cloud = bin_fields(columns.empty() ? "x,y,z,intensity" : columns);
  std::ifstream stream = open_regular_file(path);
  const std::uint64_t bytes = std::filesystem::file_size(path);
  if (bytes / cloud.point_step > kCloudPointsMax) {
    throw BadInput(fmt::format("{}: the file has {} points; at most {} can be read", path.string(),
                               bytes / cloud.point_step, kCloudPointsMax));
  }
  cloud.data.resize(bytes);
  stream.read(reinterpret_cast<char*>(cloud.data.data()), static_cast<std::streamsize>(bytes));
  if (static_cast<std::uint64_t>(stream.gcount()) != bytes) throw BadInput(path.string() + ": cannot be read");
  if (columns.empty()) {
    const std::string contradiction =
        contradiction_to_kitti({reinterpret_cast<const char*>(cloud.data.data()), cloud.data.size()});
    if (!contradiction.empty()) throw BadInput(path.string() + ": " + contradiction + kColumnsHint);
  }
  if (bytes % cloud.point_step != 0) {
    throw BadInput(
        fmt::format("{}: the file has {} bytes, but the size must be a multiple of {} ({}); the file may be truncated "
                    "or have other columns",
                    path.string(), bytes, cloud.point_step, columns));
  }
  return to_columns(cloud, bytes / cloud.point_step);
}

}  // namespace

const std::vector<double>* Cloud::find(const std::string& name) const {
  const auto found = std::find(names.begin(), names.end(), name);
  return found == names.end() ? nullptr : &columns[static_cast<std::size_t>(found - names.begin())];
}

Cloud read_cloud(const std::filesystem::path& path, const std::string& bin_columns) {
  const std::string ending = lower_extension(path);
  if (ending == ".ply") return read_points(path, read_ply_header(path), PclFormat::ply);
  if (ending == ".pcd") return read_points(path, read_pcd_header(path), PclFormat::pcd);
  if (ending == ".bin") return read_bin(path, bin_columns);
  if (ending == ".vtk") return read_vtk(path);
  throw BadInput(fmt::format("{}: the file name must end in .ply, .pcd, .vtk or .bin", path.string()));
}

}  // namespace tumble::scenarios
