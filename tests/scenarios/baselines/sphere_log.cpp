// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/baselines/sphere_log.hpp"

#include "tests/testing.hpp"

namespace tumble::testing {

namespace {

constexpr double kOneG_m_s2 = 9.80665;

std::vector<std::string> split(const std::string& line) {
  std::vector<std::string> cells;
  std::stringstream stream(line);
  for (std::string cell; std::getline(stream, cell, ',');) cells.push_back(cell);
  return cells;
}

std::size_t column(const std::vector<std::string>& names, const std::string& name) {
  const auto found = std::find(names.begin(), names.end(), "/orientation/" + name);
  if (found == names.end()) throw std::runtime_error("no column " + name);
  return static_cast<std::size_t>(found - names.begin());
}

/// Parses a stamp such as "1617333602.223639727" without the rounding of a double.
TimeNs parse_stamp(const std::string& text) {
  const std::size_t point = text.find('.');
  if (point == std::string::npos || text.size() != point + 10) throw std::runtime_error("stamp " + text);
  return std::stoll(text.substr(0, point)) * 1'000'000'000 + std::stoll(text.substr(point + 1));
}

}  // namespace

SphereLog read_sphere_log(const std::string& path) {
  std::ifstream file(path);
  std::string line;
  if (!std::getline(file, line)) throw std::runtime_error("cannot read " + path);
  const std::vector<std::string> names = split(line);
  const std::size_t stamp = column(names, "header/stamp");
  const std::size_t w[3] = {column(names, "angular_velocity/x"), column(names, "angular_velocity/y"),
                            column(names, "angular_velocity/z")};
  const std::size_t f[3] = {column(names, "linear_acceleration/x"), column(names, "linear_acceleration/y"),
                            column(names, "linear_acceleration/z")};
  const std::size_t q[4] = {column(names, "orientation/w"), column(names, "orientation/x"),
                            column(names, "orientation/y"), column(names, "orientation/z")};
  SphereLog log;
  TimeNs start_ns = 0;
  while (std::getline(file, line)) {
    const std::vector<std::string> cells = split(line);
    if (cells.size() != names.size()) throw std::runtime_error("short line in " + path);
    const auto number = [&cells](std::size_t k) { return std::stod(cells[k]); };
    if (log.samples.empty()) start_ns = parse_stamp(cells[stamp]);
    ImuSample sample;
    sample.time_ns = parse_stamp(cells[stamp]) - start_ns;
    sample.angular_velocity_rad_s = {number(w[0]), number(w[1]), number(w[2])};
    sample.specific_force_m_s2 = kOneG_m_s2 * Vector3d(number(f[0]), number(f[1]), number(f[2]));
    log.samples.push_back(sample);
    log.q_WI.push_back(Quaterniond(number(q[0]), number(q[1]), number(q[2]), number(q[3])).normalized());
  }
  return log;
}

}  // namespace tumble::testing
