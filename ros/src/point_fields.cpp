// SPDX-License-Identifier: BSD-3-Clause
#include "tumble_ros/point_fields.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <string_view>

namespace tumble::ros {

namespace {

constexpr std::array<std::string_view, 8> kTimeNames = {"t",          "time",        "timestamp",   "timestamps",
                                                        "time_stamp", "offset_time", "time_offset", "offset"};
constexpr std::uint32_t kLivoxStep = 20;  // a point has 19 bytes, aligned to 4 bytes

template <class Number>
Number read(const std::uint8_t* at) {
  Number value;
  std::memcpy(&value, at, sizeof(value));
  return value;
}

bool is_time_name(std::string_view name) {
  std::string lower = lower_case(name);
  if (const TimeUnit* unit = stated_unit(name)) lower.resize(lower.size() - unit->suffix.size());
  return std::find(kTimeNames.begin(), kTimeNames.end(), lower) != kTimeNames.end();
}

}  // namespace

std::size_t PointCloudView::row_bytes() const {
  return std::max<std::uint64_t>(row_step, std::uint64_t{width} * point_step);
}

Status check_layout(const PointCloudView& cloud) {
  if (cloud.is_bigendian) return {ErrorCode::out_of_range, "is_bigendian", 1.0, 0.0};
  if (cloud.width == 0 || cloud.height == 0) return {ErrorCode::empty, "points", 0.0, 1.0};
  if (cloud.point_step == 0) return {ErrorCode::out_of_range, "point_step", 0.0, 1.0};
  if (cloud.row_bytes() > cloud.data.size() / cloud.height) {
    return {ErrorCode::out_of_range, "row_step", static_cast<double>(cloud.row_bytes()),
            static_cast<double>(cloud.data.size()) / cloud.height};
  }
  for (const PointField& field : cloud.fields) {
    if (is_number(field) && std::uint64_t{field.offset} + kDatatypeBytes[field.datatype] > cloud.point_step)
      return {ErrorCode::out_of_range, "field offset", double(field.offset), double(cloud.point_step)};
  }
  return {};
}

bool is_number(const PointField& field) {
  return field.datatype >= 1 && field.datatype <= 8 &&
         field.count <= 1;  // some drivers write a count of 0 for one number
}

double number_at(const std::uint8_t* point, const PointField& field) {
  const std::uint8_t* const at = point + field.offset;
  switch (field.datatype) {
    case 1:
      return read<std::int8_t>(at);
    case 2:
      return read<std::uint8_t>(at);
    case 3:
      return read<std::int16_t>(at);
    case 4:
      return read<std::uint16_t>(at);
    case 5:
      return read<std::int32_t>(at);
    case 6:
      return read<std::uint32_t>(at);
    case 7:
      return static_cast<double>(read<float>(at));
    default:
      return read<double>(at);
  }
}

std::string lower_case(std::string_view text) {
  std::string out(text);
  std::transform(out.begin(), out.end(), out.begin(), [](unsigned char c) { return std::tolower(c); });
  return out;
}

const TimeUnit* stated_unit(std::string_view name) {
  const std::string lower = lower_case(name);
  const auto* found = std::find_if(kTimeUnits.begin(), kTimeUnits.end(),
                                   [&](const TimeUnit& unit) { return lower.ends_with(unit.suffix); });
  return found == kTimeUnits.end() ? nullptr : found;
}

void TimeFieldChoice::offer(const std::string& name) {
  if (!is_time_name(name)) return;
  const bool states = stated_unit(name) != nullptr;
  if (field.empty() || (states && stated_unit(field) == nullptr)) {
    field = name;
    rival.clear();
  } else if (states == (stated_unit(field) != nullptr)) {
    rival = name;
  }
}

// In CDR, numbers are aligned to their size, relative to the end of the header of 4 bytes.
Status LivoxCloud::parse(std::span<const std::uint8_t> cdr) {
  constexpr std::size_t kHeader = 4, kLivoxPoint = 19;
  if (cdr.size() < kHeader)
    return {ErrorCode::insufficient_data, "bytes of CustomMsg", double(cdr.size()), double(kHeader)};
  if (cdr[1] != 1) return {ErrorCode::out_of_range, "is_bigendian", 1.0, 0.0};
  const std::span<const std::uint8_t> body = cdr.subspan(kHeader);
  std::size_t at = 0, end = 0;
  const auto next = [&](std::size_t size, std::size_t alignment) {
    at = (end + alignment - 1) / alignment * alignment;
    end = at + size;
    return end <= body.size();
  };
  const auto u32 = [&] { return next(4, 4) ? read<std::uint32_t>(body.data() + at) : 0u; };
  const auto seconds = static_cast<std::int32_t>(u32());
  const std::uint32_t nanoseconds = u32();
  const std::uint32_t length = u32();  // length of the text, with the zero at the end
  const bool has_frame = next(length, 1);
  const std::size_t frame_at = at;
  next(8, 8);  // timebase; the reader uses the header's stamp instead
  u32();       // point_num
  next(4, 1);  // lidar_id, rsvd
  const std::uint32_t count = u32();
  const bool fits = has_frame && end <= body.size() && (count == 0 || count <= (body.size() - end + 1) / kLivoxStep);
  if (!fits)
    return {ErrorCode::insufficient_data, "bytes of CustomMsg", double(body.size()), double(end + count * kLivoxPoint)};
  stamp_ns = TimeNs{seconds} * 1'000'000'000 + nanoseconds;
  frame_id.assign(reinterpret_cast<const char*>(body.data() + frame_at), length > 0 ? length - 1 : 0);
  points_ = count;
  data_.assign(body.begin() + std::ptrdiff_t(end),
               body.begin() + std::ptrdiff_t(std::min(body.size(), end + std::size_t{count} * kLivoxStep)));
  data_.resize(std::size_t{count} * kLivoxStep);  // the last point has no padding
  return check_layout(view());
}

PointCloudView LivoxCloud::view() const {
  static const std::array<PointField, 7> kFields = {{{"offset_time_ns", 0, 6},
                                                     {"x", 4, 7},
                                                     {"y", 8, 7},
                                                     {"z", 12, 7},
                                                     {"reflectivity", 16, 2},
                                                     {"tag", 17, 2},
                                                     {"line", 18, 2}}};
  return {stamp_ns, 1, points_, kFields, false, kLivoxStep, points_ * kLivoxStep, data_};
}

}  // namespace tumble::ros
