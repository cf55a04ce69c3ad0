// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/recordings/export_names.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

namespace tumble::scenarios {

namespace {

const std::set<std::string>& own_names() {
  static const std::set<std::string> names = {"body", "clock", "tf", "tf_static", "truth", "world"};
  return names;
}

const std::set<std::string>& frames_of_no_sensor() {
  static const std::set<std::string> names = {"base_link", "map", "odom"};
  return names;
}

struct Claim {
  std::string sensor, name;
  bool own;  ///< false: generated name
  std::string given = {};
};

template <class Record>
void add_claims(const std::vector<Record>& records, const std::string& kind, const std::string& word,
                std::vector<Claim>& claims) {
  const auto plain = [](unsigned char c) { return std::isalnum(c) != 0 || c == '_' || c == '-'; };
  for (std::size_t index = 0; index < records.size(); ++index) {
    const std::string &name = records[index].name, number = std::to_string(index);
    const bool own = !name.empty() && std::all_of(name.begin(), name.end(), plain);
    claims.push_back({word + " " + number, own ? name : kind + "_" + number, own});
  }
}

std::string why_another(const Claim& claim) {
  const bool sensors = !own_names().contains(claim.name) && !frames_of_no_sensor().contains(claim.name);
  return fmt::format("name conflict in the export: '{}' is {}, so the sensor {} is exported as '{}'", claim.name,
                     sensors ? "the name of another sensor" : "reserved for another topic or frame", claim.sensor,
                     claim.given);
}

template <class Recorded>
ExportNames names_of(const Recorded& recorded) {
  std::vector<Claim> claims;
  add_claims(recorded.imus, "imu", "IMU", claims);
  add_claims(recorded.lidars, "lidar", "lidar", claims);
  add_claims(recorded.series, "series", "series", claims);
  std::set<std::string> taken = own_names();
  taken.insert(frames_of_no_sensor().begin(), frames_of_no_sensor().end());
  for (const bool own : {true, false}) {
    for (Claim& claim : claims)
      if (claim.own == own && taken.insert(claim.name).second) claim.given = claim.name;
  }
  ExportNames out;
  out.taken = own_names();
  for (std::size_t index = 0; index < claims.size(); ++index) {
    Claim& claim = claims[index];
    const bool after_imus = index >= recorded.imus.size();
    const bool after_lidars = index >= recorded.imus.size() + recorded.lidars.size();
    GivenNames& of_kind = after_lidars ? out.series : after_imus ? out.lidars : out.imus;
    if (claim.given.empty()) {
      claim.given = free_name(claim.name, taken);
      of_kind.notes.push_back(why_another(claim));
    }
    of_kind.names.push_back(claim.given);
    out.taken.insert(claim.given);
  }
  return out;
}

}  // namespace

ExportNames export_names(const sim::Sensors& sensors) {
  return names_of(sensors);
}

ExportNames export_names(const sim::Truth& truth) {
  return names_of(truth);
}

std::string free_name(const std::string& name, std::set<std::string>& taken) {
  std::string free = name;
  for (int number = 2; !taken.insert(free).second; ++number) free = name + "_" + std::to_string(number);
  return free;
}

}  // namespace tumble::scenarios
