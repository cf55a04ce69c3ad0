// SPDX-License-Identifier: BSD-3-Clause
// verdicts SCENARIO FIRST LAST METHOD [HARM]...: runs a method of kind `slam` or `position` on draws as they are and on
// the same with wrong inputs (units, axes, signs, clocks, mountings, sensors that die, dust), and holds what it says of
// itself against what is true. Wrong: ends further off than five of its standard deviations (slam: pose NEES beyond
// 25). Told: the status, `localised`, or a key of its health that says so. Prints a line per run and the two rates of a
// classifier: wrong runs that say so, good ones that cry wolf. Not a test: a minute a draw for `slam`, seconds for
// `position`.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "scenarios/draw/scenario.hpp"
#include "scenarios/errors.hpp"
#include "scenarios/methods/method.hpp"
#include "scenarios/sweep/evaluate.hpp"
#include "sim/random/stream.hpp"
#include "sim/simulate.hpp"
#include "tests/tree.hpp"

namespace {

namespace scenarios = tumble::scenarios;
namespace sim = tumble::sim;

constexpr double kWrongDeviations = 5.0, kDegree = 57.29577951308232, kGravity = 9.80665;

using Harm = std::function<void(sim::Sensors&)>;

void each_reading(sim::Sensors& sensors, const std::function<void(Eigen::Vector3d&, Eigen::Vector3d&)>& change) {
  for (sim::ImuRecord& imu : sensors.imus) {
    for (std::size_t k = 0; k < imu.time_ns.size(); ++k) change(imu.gyro_rad_s[k], imu.accel_m_s2[k]);
  }
}

void shift_lidar(sim::Sensors& sensors, std::int64_t by_ns) {
  for (sim::LidarRecord& lidar : sensors.lidars) {
    for (std::int64_t& start_ns : lidar.sweep_start_ns) start_ns += by_ns;
  }
}

void freeze(std::vector<Eigen::Vector3d>& readings) {
  for (std::size_t k = readings.size() / 3; k < readings.size(); ++k) readings[k] = readings[readings.size() / 3];
}

void turn_lidar(sim::Sensors& sensors, double rad, double m) {
  for (sim::LidarRecord& lidar : sensors.lidars) {
    lidar.T_BL.translate(Eigen::Vector3d::Constant(m));
    for (int axis = 0; axis < 3; ++axis) {
      lidar.T_BL.rotate(Eigen::AngleAxisd(rad, Eigen::Vector3d::Unit(axis)));
    }
  }
}

/// Returns at random ranges along their beams, as dust, rain or grass make them.
void dust(sim::Sensors& sensors, double share) {
  sim::Stream stream(7, "dust");
  for (sim::LidarRecord& lidar : sensors.lidars) {
    for (std::size_t k = 0; k < lidar.range_m.size(); ++k) {
      if (stream.uniform() >= share) continue;
      const auto to_m = static_cast<float>(0.7 + 15.0 * stream.uniform());
      lidar.position_L_m[k] *= to_m / lidar.range_m[k];
      lidar.range_m[k] = to_m;
    }
  }
}

const std::map<std::string, Harm>& harms() {
  using Vector = Eigen::Vector3d;
  static const std::map<std::string, Harm> all = {
      {"none", [](sim::Sensors&) {}},
      {"accel_in_g", [](sim::Sensors& s) { each_reading(s, [](Vector&, Vector& f) { f /= kGravity; }); }},
      {"accel_flipped", [](sim::Sensors& s) { each_reading(s, [](Vector&, Vector& f) { f = -f; }); }},
      {"accel_x_y_swapped",
       [](sim::Sensors& s) { each_reading(s, [](Vector&, Vector& f) { std::swap(f.x(), f.y()); }); }},
      {"accel_z_flipped", [](sim::Sensors& s) { each_reading(s, [](Vector&, Vector& f) { f.z() = -f.z(); }); }},
      {"gyro_in_degrees", [](sim::Sensors& s) { each_reading(s, [](Vector& w, Vector&) { w *= kDegree; }); }},
      {"gyro_flipped", [](sim::Sensors& s) { each_reading(s, [](Vector& w, Vector&) { w = -w; }); }},
      {"gyro_x_y_swapped",
       [](sim::Sensors& s) { each_reading(s, [](Vector& w, Vector&) { std::swap(w.x(), w.y()); }); }},
      {"gyro_scale_5_percent", [](sim::Sensors& s) { each_reading(s, [](Vector& w, Vector&) { w *= 1.05; }); }},
      {"all_accels_frozen",
       [](sim::Sensors& s) {
         for (sim::ImuRecord& imu : s.imus) freeze(imu.accel_m_s2);
       }},
      {"all_gyros_frozen",
       [](sim::Sensors& s) {
         for (sim::ImuRecord& imu : s.imus) freeze(imu.gyro_rad_s);
       }},
      {"first_frozen", [](sim::Sensors& s) { freeze(s.imus.front().accel_m_s2), freeze(s.imus.front().gyro_rad_s); }},
      {"stamps_in_us",
       [](sim::Sensors& s) {
         for (sim::ImuRecord& imu : s.imus)
           for (std::int64_t& t : imu.time_ns) t /= 1000;
       }},
      {"lidar_20_ms", [](sim::Sensors& s) { shift_lidar(s, 20'000'000); }},
      {"lidar_100_ms", [](sim::Sensors& s) { shift_lidar(s, 100'000'000); }},
      {"mounting_2_deg", [](sim::Sensors& s) { turn_lidar(s, 0.03, 0.015); }},
      {"mounting_10_deg", [](sim::Sensors& s) { turn_lidar(s, 0.1, 0.05); }},
      {"mounting_90_deg",
       [](sim::Sensors& s) {
         for (sim::LidarRecord& l : s.lidars) l.T_BL.rotate(Eigen::AngleAxisd(1.5707963, Vector::UnitZ()));
       }},
      {"dust_5_percent", [](sim::Sensors& s) { dust(s, 0.05); }},
      {"radius_2_percent", [](sim::Sensors& s) { s.sphere_radius_m *= 1.02; }},
  };
  return all;
}

bool applies(const std::string& harm, const std::string& kind) {
  const bool of_lidar = harm.starts_with("lidar") || harm.starts_with("mounting") || harm.starts_with("dust");
  const bool of_sphere = harm == "first_frozen" || harm == "radius_2_percent";
  return kind == "slam" ? !of_sphere : !of_lidar;
}

double value_of(const std::vector<scenarios::Score>& scores, const std::string& metric) {
  const auto found =
      std::find_if(scores.begin(), scores.end(), [&](const auto& score) { return score.metric == metric; });
  return found == scores.end() ? std::nan("") : found->value;
}

bool told(const scenarios::Outcome& outcome, const scenarios::Estimate& estimate) {
  if (outcome.status != "ok") return true;
  const auto says = [&](const char* key, double otherwise) {
    const auto found = estimate.health.find(key);
    return found == estimate.health.end() ? otherwise : found->second;
  };
  return says("localised", 1.0) == 0.0 || says("imu_implausible", 0.0) != 0.0;
}

struct Tally {
  int wrong = 0, wrong_told = 0, good = 0, good_told = 0;
};

void judge(const scenarios::Method& method, const scenarios::SimulatedDraw& draw, const sim::Surface* surface,
           const std::string& harm, Tally& tally) {
  scenarios::SimulatedDraw given = draw;
  harms().at(harm)(given.recording.sensors);
  scenarios::Outcome outcome;
  const scenarios::Estimate estimate = scenarios::run_method(method, given, outcome);
  const bool says = told(outcome, estimate), answered = outcome.status == "ok";
  double error = std::nan(""), deviations = std::nan("");
  if (answered) {
    scenarios::assess(method, scenarios::scored_by(draw, given), surface, estimate, outcome);
    const double nees = value_of(outcome.scores, "pose_nees");
    const double sigma_m =
        estimate.poses.empty() ? 0.0 : std::sqrt(estimate.poses.back().covariance.topLeftCorner<3, 3>().trace());
    error = value_of(outcome.scores, "position_end_error_m");
    if (std::isnan(error)) error = value_of(outcome.scores, "ate_m");
    deviations = std::isnan(nees) ? error / sigma_m : std::sqrt(nees);
  }
  const bool wrong = !(deviations <= kWrongDeviations) && answered;
  if (wrong) {
    ++tally.wrong, tally.wrong_told += says;
  } else if (outcome.status == "ok" || harm == "none") {
    ++tally.good, tally.good_told += says;
  }
  const auto health = [&](const char* key) {
    const auto found = estimate.health.find(key);
    return found == estimate.health.end() ? std::nan("") : found->second;
  };
  std::printf(
      "%-10s %6llu %-22s %-9s error %9.4f deviations %8.2f %-5s %-5s surprise %7.3g innovation %7.3g %7.3g rig %7.3g "
      "held %5.2f%s\n",
      draw.scenario.c_str(), static_cast<unsigned long long>(draw.seed), harm.c_str(), outcome.status.c_str(), error,
      deviations, wrong ? "wrong" : "good", says ? "told" : "-", health("calibration_surprise"),
      health("innovation_median"), health("innovation_90"), health("rig_surprise"), health("held_share"),
      wrong && !says ? "  <- silently wrong"
                     : (!wrong && says && (outcome.status == "ok" || harm == "none") ? "  <- cries wolf" : ""));
  std::fflush(stdout);
}

int run(const std::string& name, std::uint64_t first, std::uint64_t last, const std::string& full_name,
        std::vector<std::string> chosen) {
  const scenarios::DataRoot data{tumble::test::source_dir()};
  const scenarios::Scenario scenario = scenarios::load_scenario(data, name);
  const scenarios::Method& method = *scenarios::find_methods(full_name).front();
  const std::string kind = full_name.substr(0, full_name.find('/'));
  if (chosen.empty()) {
    for (const auto& [harm, _] : harms()) chosen.push_back(harm);
  }
  Tally tally;
  for (std::uint64_t seed = first; seed <= last; ++seed) {
    scenarios::SimulatedDraw draw;
    try {
      draw = scenarios::simulate_draw(data, scenario, seed, 1,
                                      kind == "slam" ? scenarios::Lidars::simulated : scenarios::Lidars::left_out);
    } catch (const sim::SimulationFailure&) {
      continue;
    }
    for (const std::string& harm : chosen) {
      if (applies(harm, kind)) judge(method, draw, nullptr, harm, tally);
    }
  }
  std::printf("wrong by more than %g deviations: %d, of these told: %d; good: %d, of these crying wolf: %d\n",
              kWrongDeviations, tally.wrong, tally.wrong_told, tally.good, tally.good_told);
  return 0;
}

}  // namespace

int main(int count, char** words) {
  if (count < 5) {
    std::fprintf(stderr, "usage: verdicts SCENARIO FIRST LAST KIND/METHOD [HARM]...\nharms:");
    for (const auto& [harm, _] : harms()) std::fprintf(stderr, " %s", harm.c_str());
    std::fprintf(stderr, "\n");
    return 2;
  }
  try {
    return run(words[1], std::strtoull(words[2], nullptr, 10), std::strtoull(words[3], nullptr, 10), words[4],
               {words + 5, words + count});
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
  }
}
