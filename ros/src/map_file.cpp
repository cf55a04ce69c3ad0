// SPDX-License-Identifier: BSD-3-Clause
#include "tumble_ros/map_file.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>

#include "tumble/odometry/tumbling_odometry.hpp"
#include "tumble_ros/point_fields.hpp"

namespace tumble::ros {

namespace {

constexpr float kSigma_m = 0.02f;  // standard deviation of a point without the field sigma
constexpr std::size_t kFieldsMax = 256;

/// Names of the PLY types in the order of the numbers of sensor_msgs/PointField.
constexpr std::array<std::array<std::string_view, 2>, 8> kPlyTypes = {{{"char", "int8"},
                                                                       {"uchar", "uint8"},
                                                                       {"short", "int16"},
                                                                       {"ushort", "uint16"},
                                                                       {"int", "int32"},
                                                                       {"uint", "uint32"},
                                                                       {"float", "float32"},
                                                                       {"double", "float64"}}};

/// `part` names the count of valid parts, which is 0 and must be 1.
Status unsupported(const char* part) {
  return {ErrorCode::out_of_range, part, 0.0, 1.0};
}

class Words {
 public:
  explicit Words(std::string_view text) : rest_(text) {}
  /// Returns the next word, or an empty text at the end.
  std::string_view next() {
    const std::size_t begin = std::min(rest_.find_first_not_of(" \t\r\n"), rest_.size());
    const std::size_t end = std::min(rest_.find_first_of(" \t\r\n", begin), rest_.size());
    const std::string_view word = rest_.substr(begin, end - begin);
    rest_.remove_prefix(end);
    return word;
  }
  template <class Number>
  bool read(Number& number) {
    const std::string_view word = next();
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
    return error == std::errc() && end == word.data() + word.size();
  }

 private:
  std::string_view rest_;
};

struct CloudHeader {
  std::vector<PointField> fields;
  std::uint32_t points = 0, point_step = 0, columns = 0;
  bool ascii = false;
  std::size_t bytes = 0;  ///< length of the header

  void add(std::string_view name, std::uint8_t datatype, std::uint32_t count) {
    fields.push_back({std::string(name), ascii ? columns : point_step, datatype, count});
    columns += count;
    point_step += count * kDatatypeBytes[datatype];
  }
};

/// Returns the next line without its end, and removes the line from `text`. Returns an empty text without a line end.
std::string_view take_line(std::string_view& text) {
  const std::size_t end = text.find('\n');
  if (end == std::string_view::npos) return {};
  const std::string_view line = text.substr(0, end + 1);
  text.remove_prefix(end + 1);
  return line;
}

Status parse_ply(std::string_view file, CloudHeader& out) {
  std::string_view rest = file;
  bool in_vertices = false, has_vertices = false;
  for (std::string_view line = take_line(rest); !line.empty(); line = take_line(rest)) {
    Words words(line);
    const std::string_view key = words.next();
    if (key == "end_header") {
      out.bytes = file.size() - rest.size();
      return has_vertices ? Status{} : unsupported("number of vertex elements in the PLY header");
    }
    if (key == "format") {
      const std::string_view format = words.next();
      out.ascii = format == "ascii";
      if (!out.ascii && format != "binary_little_endian")
        return unsupported("number of known formats in the PLY header (ascii or binary_little_endian)");
    } else if (key == "element") {
      in_vertices = !has_vertices && words.next() == "vertex" && words.read(out.points);
      if (!in_vertices && !has_vertices) return unsupported("number of vertex elements at the start of the PLY file");
      has_vertices = true;
    } else if (key == "property" && in_vertices) {
      const std::string_view type = words.next();
      const auto known = std::find_if(kPlyTypes.begin(), kPlyTypes.end(),
                                      [&](const auto& names) { return names[0] == type || names[1] == type; });
      if (known == kPlyTypes.end() || out.fields.size() == kFieldsMax)
        return unsupported("number of known types of a vertex property in the PLY header");
      out.add(words.next(), static_cast<std::uint8_t>(known - kPlyTypes.begin() + 1), 1);
    }
  }
  return {ErrorCode::insufficient_data, "bytes of the PLY header", double(file.size()), double(file.size() + 1)};
}

std::uint8_t pcd_datatype(char type, std::uint32_t size) {
  if (type == 'F') return size == 4 ? 7 : size == 8 ? 8 : 0;
  const std::uint8_t sign = type == 'U' ? 1 : 0;
  if (type != 'U' && type != 'I') return 0;
  return size == 1 ? 1 + sign : size == 2 ? 3 + sign : size == 4 ? 5 + sign : 0;
}

Status parse_pcd(std::string_view file, CloudHeader& out) {
  std::string_view rest = file, names, sizes, types, counts;
  for (std::string_view line = take_line(rest); !line.empty(); line = take_line(rest)) {
    Words words(line);
    const std::string_view key = words.next(), values = line.substr(std::min(line.size(), line.find(key) + key.size()));
    if (key == "FIELDS" || key == "COLUMNS") names = values;
    if (key == "SIZE") sizes = values;
    if (key == "TYPE") types = values;
    if (key == "COUNT") counts = values;
    if (key == "POINTS" && !words.read(out.points))
      return unsupported("number of valid entries POINTS in the PCD header");
    if (key != "DATA") continue;
    const std::string_view data = words.next();
    out.ascii = data == "ascii";
    if (!out.ascii && data != "binary")
      return unsupported("number of known encodings DATA in the PCD header (ascii or binary)");
    out.bytes = file.size() - rest.size();
    Words name(names), size(sizes), type(types), count(counts);
    for (std::string_view each = name.next(); !each.empty(); each = name.next()) {
      std::uint32_t bytes = 0, numbers = 1;
      const bool read = size.read(bytes) && (counts.empty() || count.read(numbers));
      const std::string_view letter = type.next();
      const std::uint8_t datatype = letter.size() == 1 ? pcd_datatype(letter[0], bytes) : 0;
      if (!read || datatype == 0 || numbers == 0 || numbers > kFieldsMax || out.fields.size() == kFieldsMax)
        return unsupported("number of known types (SIZE, TYPE, COUNT) of a field in the PCD header");
      out.add(each, datatype, numbers);
    }
    return {};
  }
  return {ErrorCode::insufficient_data, "bytes of the PCD header", double(file.size()), double(file.size() + 1)};
}

using Triple = std::array<const PointField*, 3>;

struct MapFields {
  explicit MapFields(const std::vector<PointField>& fields) : fields_(fields) {
    position = find({"x", "y", "z"});
    normal = find({"nx", "ny", "nz"});
    if (!normal[0]) normal = find({"normal_x", "normal_y", "normal_z"});
    sigma = find("sigma");
  }
  Triple position, normal;  ///< three fields, or null
  const PointField* sigma = nullptr;

 private:
  const PointField* find(std::string_view name) const {
    const auto found = std::find_if(fields_.begin(), fields_.end(),
                                    [&](const PointField& field) { return field.name == name && is_number(field); });
    return found == fields_.end() ? nullptr : &*found;
  }
  Triple find(const std::array<std::string_view, 3>& names) const {
    const Triple found = {find(names[0]), find(names[1]), find(names[2])};
    return found[0] && found[1] && found[2] ? found : Triple{};
  }
  const std::vector<PointField>& fields_;
};

/// `value` returns the number of a field of the current point.
template <class Value>
void add_point(const MapFields& fields, const Value& value, std::vector<MapPoint>& points) {
  const auto vector = [&](const Triple& of) {
    return Eigen::Vector3d(value(*of[0]), value(*of[1]), value(*of[2])).template cast<float>().eval();
  };
  MapPoint point;
  point.position_W_m = vector(fields.position);
  point.sigma_m = fields.sigma ? static_cast<float>(value(*fields.sigma)) : kSigma_m;
  if (fields.normal[0]) point.normal_W = vector(fields.normal);
  if (!point.position_W_m.allFinite()) return;
  if (!point.normal_W.allFinite()) point.normal_W.setZero();
  points.push_back(point);
}

Status read_text(std::string_view text, const CloudHeader& header, const MapFields& fields,
                 std::vector<MapPoint>& points) {
  Words words(text);
  std::vector<double> row(header.columns);
  for (std::uint32_t k = 0; k < header.points; ++k) {
    for (double& number : row) {
      if (!words.read(number)) return {ErrorCode::insufficient_data, "points", double(k), double(header.points)};
    }
    add_point(
        fields, [&](const PointField& field) { return row[field.offset]; }, points);
  }
  return {};
}

Status read_binary(std::string_view bytes, const CloudHeader& header, const MapFields& fields,
                   std::vector<MapPoint>& points) {
  const auto* const data = reinterpret_cast<const std::uint8_t*>(bytes.data());
  const std::size_t complete = bytes.size() / header.point_step;
  if (complete < header.points)
    return {ErrorCode::insufficient_data, "points", double(complete), double(header.points)};
  for (std::size_t k = 0; k < header.points; ++k) {
    add_point(
        fields, [&](const PointField& field) { return number_at(data + k * header.point_step, field); }, points);
  }
  return {};
}

}  // namespace

Status read_map(std::span<const std::byte> file, std::vector<MapPoint>& points) {
  const std::string_view text(reinterpret_cast<const char*>(file.data()), file.size());
  const bool is_ply = text.starts_with("ply\n") || text.starts_with("ply\r\n");
  if (!is_ply && !text.starts_with("# .PCD") && !text.starts_with("VERSION")) return tumble::load_map(file, points);
  CloudHeader header;
  if (const Status status = is_ply ? parse_ply(text, header) : parse_pcd(text, header); !status.ok()) return status;
  const MapFields fields(header.fields);
  if (!fields.position[0]) return {ErrorCode::insufficient_data, "fields x, y and z of the map file", 0.0, 3.0};
  std::vector<MapPoint> read;
  const std::string_view data = text.substr(header.bytes);
  const Status status = header.ascii ? read_text(data, header, fields, read) : read_binary(data, header, fields, read);
  if (!status.ok()) return status;
  if (!fields.normal[0]) {
    std::vector<Eigen::Vector3f> positions;
    for (const MapPoint& point : read) positions.push_back(point.position_W_m);
    read = to_map_points(positions);
  }
  points = std::move(read);
  return {};
}

std::string ply_of(std::span<const MapPoint> map) {
  std::string out = "ply\nformat binary_little_endian 1.0\nelement vertex " + std::to_string(map.size()) + "\n";
  for (const char* name : {"x", "y", "z", "nx", "ny", "nz", "sigma"})
    out += std::string("property float ") + name + "\n";
  out += "end_header\n";
  for (const MapPoint& point : map) {
    const Eigen::Vector3f &p = point.position_W_m, &n = point.normal_W;
    const std::array<float, 7> row = {p.x(), p.y(), p.z(), n.x(), n.y(), n.z(), point.sigma_m};
    out.append(reinterpret_cast<const char*>(row.data()), sizeof(row));
  }
  return out;
}

}  // namespace tumble::ros
