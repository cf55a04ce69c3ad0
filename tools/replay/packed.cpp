// SPDX-License-Identifier: BSD-3-Clause
#include "tools/replay/page.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <nlohmann/json.hpp>

#include "tools/pictures/map_pictures.hpp"

namespace tumble::tools {

namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;
using nlohmann::json;

constexpr double kWhole = 32767.0;
constexpr std::int16_t kNoNumber = -32768;
constexpr int kErrorSteps = 254;
constexpr std::uint8_t kNoError = 255;
constexpr int kColourLevels = 64;

class Arrays {
 public:
  template <typename Number>
  void add(const std::string& name, const char* type, const std::vector<Number>& numbers) {
    while (bytes_.size() % 4 != 0) bytes_.push_back(0);
    list_[name] = {{"type", type}, {"offset", bytes_.size()}, {"length", numbers.size()}};
    const std::size_t at = bytes_.size();
    bytes_.resize(at + sizeof(Number) * numbers.size());
    if (!numbers.empty()) std::memcpy(bytes_.data() + at, numbers.data(), sizeof(Number) * numbers.size());
  }
  void add(const std::string& name, const std::vector<std::int16_t>& numbers) { add(name, "int16", numbers); }
  void add(const std::string& name, const std::vector<std::uint16_t>& numbers) { add(name, "uint16", numbers); }
  void add(const std::string& name, const std::vector<std::uint32_t>& numbers) { add(name, "uint32", numbers); }
  void add(const std::string& name, const std::vector<std::uint8_t>& numbers) { add(name, "uint8", numbers); }
  void add(const std::string& name, const std::vector<float>& numbers) { add(name, "float32", numbers); }

  const json& list() const { return list_; }
  std::vector<std::uint8_t> take() { return std::move(bytes_); }

 private:
  json list_ = json::object();
  std::vector<std::uint8_t> bytes_;
};

std::int16_t whole(double value, double scale) {
  if (!std::isfinite(value)) return kNoNumber;
  return static_cast<std::int16_t>(std::lround(std::clamp(value / scale, -kWhole, kWhole)));
}

double scale_for(double largest) {
  return std::max(largest, 1e-6) / kWhole;
}

std::uint32_t microseconds(std::int64_t time_ns) {
  const std::int64_t rounded = (std::max<std::int64_t>(time_ns, 0) + 500) / 1000;
  return static_cast<std::uint32_t>(std::min<std::int64_t>(rounded, std::numeric_limits<std::uint32_t>::max()));
}

double seconds_of(std::int64_t time_ns) {
  return 1e-9 * static_cast<double>(time_ns);
}

json to_json(const Vector3d& v) {
  return {v.x(), v.y(), v.z()};
}

json to_json(const Eigen::Isometry3d& T) {
  json out = json::array();
  for (int k = 0; k < 16; ++k) out.push_back(T.matrix().data()[k]);  // column-major, as WebGL requires
  return out;
}

void append(const Vector3d& v, double scale, std::vector<std::int16_t>& out) {
  for (int axis = 0; axis < 3; ++axis) out.push_back(whole(v[axis], scale));
}

Vector3d origin_of(const Replay& replay) {
  for (const ReplayActor& actor : replay.actors) {
    for (const Vector3d& p : actor.track.p_WB_m) {
      if (p.allFinite()) return p.array().round();
    }
  }
  return Vector3d::Zero();
}

json pack_parts(const std::string& name, const std::vector<sim::MeshPart>& parts, const Vector3d& origin,
                Arrays& arrays) {
  double largest = 0.0;
  for (const sim::MeshPart& part : parts) {
    for (const Vector3f& vertex : part.vertices_m)
      largest = std::max(largest, (vertex.cast<double>() - origin).lpNorm<Eigen::Infinity>());
  }
  const double scale = scale_for(largest);
  std::vector<std::int16_t> vertices;
  std::vector<std::uint16_t> corners;
  json list = json::array();
  for (const sim::MeshPart& part : parts) {
    const bool field = part.rows > 1 && part.columns > 1;
    if (!field && part.vertices_m.size() > 65536) continue;  // corner indices have 16 bits
    for (const Vector3f& vertex : part.vertices_m) append(vertex.cast<double>() - origin, scale, vertices);
    for (const auto& triangle : part.triangles) {
      for (const std::uint32_t corner : triangle) corners.push_back(static_cast<std::uint16_t>(corner));
    }
    json one = {{"vertices", part.vertices_m.size()}, {"corners", 3 * part.triangles.size()}, {"rgba", json::array()}};
    for (const float channel : part.rgba) one["rgba"].push_back(std::round(1000.0 * channel) / 1000.0);
    if (field) {
      one["rows"] = part.rows;
      one["columns"] = part.columns;
    }
    list.push_back(std::move(one));
  }
  arrays.add(name + ".vertices", vertices);
  arrays.add(name + ".corners", corners);
  return {{"scale_m", scale}, {"parts", std::move(list)}};
}

void pack_track(const std::string& name, const ReplayTrack& track, const Vector3d& origin, Arrays& arrays) {
  std::vector<float> positions;
  std::vector<std::int16_t> attitudes;
  for (std::size_t k = 0; k < track.p_WB_m.size(); ++k) {
    for (int axis = 0; axis < 3; ++axis) positions.push_back(static_cast<float>(track.p_WB_m[k][axis] - origin[axis]));
    const Eigen::Vector4d xyzw = track.q_WB[k].coeffs();
    for (int i = 0; i < 4; ++i) attitudes.push_back(whole(xyzw[i], 1.0 / kWhole));
  }
  arrays.add(name + ".positions", positions);
  arrays.add(name + ".attitudes", attitudes);
}

json pack_actors(const Replay& replay, const Vector3d& origin, double rate_scale, Arrays& arrays) {
  json list = json::array();
  for (std::size_t i = 0; i < replay.actors.size(); ++i) {
    const ReplayActor& actor = replay.actors[i];
    const std::string name = "actor" + std::to_string(i);
    if (!actor.track.p_WB_m.empty()) pack_track(name, actor.track, origin, arrays);
    if (!actor.error_m.empty()) {
      std::vector<std::uint8_t> errors;
      for (const float error_m : actor.error_m) {
        const float share = std::clamp(error_m / kMapErrorMax_m, 0.0f, 1.0f);
        errors.push_back(std::isfinite(error_m) ? static_cast<std::uint8_t>(std::lround(kErrorSteps * share))
                                                : kNoError);
      }
      arrays.add(name + ".errors", errors);
    }
    if (!actor.rate_rad_s.empty()) {
      std::vector<std::int16_t> rates;
      for (const Vector3f& rate : actor.rate_rad_s) append(rate.cast<double>(), rate_scale, rates);
      arrays.add(name + ".rates", rates);
    }
    list.push_back({{"name", actor.name},
                    {"colour", actor.colour},
                    {"truth", actor.is_truth},
                    {"moves", !actor.track.p_WB_m.empty()},
                    {"errors", !actor.error_m.empty()},
                    {"rates", !actor.rate_rad_s.empty()},
                    {"mount", to_json(actor.T_BB_given)}});
  }
  return list;
}

json pack_points(const ReplayPoints& points, Arrays& arrays) {
  double largest = 0.0;
  for (const Vector3f& p : points.p_B_m) largest = std::max(largest, static_cast<double>(p.lpNorm<Eigen::Infinity>()));
  const double scale = scale_for(largest);
  std::vector<std::int16_t> positions;
  std::vector<std::uint32_t> times;
  for (const Vector3f& p : points.p_B_m) append(p.cast<double>(), scale, positions);
  for (const std::int64_t time_ns : points.time_ns) times.push_back(microseconds(time_ns));
  arrays.add("points.positions", positions);
  arrays.add("points.times", times);
  return {{"shown", points.p_B_m.size()}, {"of", points.of}, {"scale_m", scale}};
}

double rate_scale(const Replay& replay) {
  double largest = 0.0;
  const auto look = [&](const std::vector<Vector3f>& rates) {
    for (const Vector3f& rate : rates) {
      if (rate.allFinite()) largest = std::max(largest, static_cast<double>(rate.lpNorm<Eigen::Infinity>()));
    }
  };
  look(replay.strip.gyro_rad_s);
  for (const ReplayActor& actor : replay.actors) {
    if (actor.is_truth) look(actor.rate_rad_s);
  }
  return scale_for(2.0 * largest);
}

const char* name_of(sim::ContactLabel label) {
  switch (label) {
    case sim::ContactLabel::air:
      return "air";
    case sim::ContactLabel::grip:
      return "contact";
    case sim::ContactLabel::slip:
      return "slip";
    case sim::ContactLabel::slide:
      return "slide";
  }
  return "";
}

json pack_strip(const ReplayStrip& strip, double scale, Arrays& arrays) {
  std::vector<std::uint32_t> times;
  std::vector<std::int16_t> gyro;
  for (const std::int64_t time_ns : strip.time_ns) times.push_back(microseconds(time_ns));
  for (const Vector3f& rate : strip.gyro_rad_s) append(rate.cast<double>(), scale, gyro);
  arrays.add("strip.times", times);
  arrays.add("strip.gyro", gyro);
  arrays.add("strip.clipped", strip.clipped_axes);
  json contacts = json::array();
  for (const ContactSpan& span : strip.contacts)
    contacts.push_back({seconds_of(span.begin_ns), seconds_of(span.end_ns), name_of(span.label)});
  return {{"shown", strip.time_ns.size()},
          {"of", strip.of},
          {"scale_rad_s", scale},
          {"clipping", strip.clipping},
          {"contacts", std::move(contacts)},
          {"contacts_known", strip.contacts_known}};
}

json error_colours() {
  json out = json::array();
  for (int k = 0; k < kColourLevels; ++k) {
    const auto colour = error_colour(kMapErrorMax_m * static_cast<float>(k) / (kColourLevels - 1));
    out.push_back({colour[0], colour[1], colour[2]});
  }
  return out;
}

}  // namespace

PackedReplay packed(const Replay& replay) {
  Arrays arrays;
  const Vector3d origin = origin_of(replay);
  const double rates = rate_scale(replay);
  json head = {{"format", "tumble replay"},
               {"version", 1},
               {"title", replay.title},
               {"facts", json::array()},
               {"end_s", seconds_of(replay.end_ns)},
               {"from_s", seconds_of(replay.from_ns)},
               {"to_s", seconds_of(replay.to_ns)},
               {"pose_step_s", seconds_of(replay.pose_step_ns)},
               {"origin_W_m", to_json(origin)},
               {"robot_radius_m", replay.robot_radius_m},
               {"error_max_m", kMapErrorMax_m},
               {"error_colours", error_colours()}};
  for (const auto& [name, value] : replay.facts) head["facts"].push_back({name, value});
  head["world"] = pack_parts("world", replay.world, origin, arrays);
  head["world"]["shown"] = replay.triangles.shown;
  head["world"]["of"] = replay.triangles.of;
  head["robot"] = pack_parts("robot", replay.robot, Vector3d::Zero(), arrays);
  head["actors"] = pack_actors(replay, origin, rates, arrays);
  head["points"] = pack_points(replay.points, arrays);
  head["strip"] = pack_strip(replay.strip, rates, arrays);
  head["arrays"] = arrays.list();
  return {head.dump(-1, ' ', false, json::error_handler_t::replace), arrays.take()};
}

}  // namespace tumble::tools
