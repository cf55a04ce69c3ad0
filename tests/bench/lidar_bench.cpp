// SPDX-License-Identifier: BSD-3-Clause
// Simulated lidar points per second on one core, compared with the physics engine's own rays in the same run. The world
// is a height field of 400 x 400 cells with 40 rocks, 40 trunks and a cage of 12 struts.
//   engine    mj_ray and mj_multiRay on a sample of the rays of cast/rs16_*
//   build     builds the copy of the world for ray casting, once per recording
//   cast      casts sweeps: each firing from its own pose, with errors, intensity, surface id and exact hit
//   simulate  the whole function simulate_lidar: build, cast and writing a recording of 10 s to memory
// `returns` counts the points in the recording, `firings` the emitted beams. On the open hill, half of the beams hit
// nothing. In the hall (the same ground with a roof and walls), nearly all beams return. Rates refer to processor time.
#include <benchmark/benchmark.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <vector>

#include "sim/lidar/lidar_simulation.hpp"
#include "sim/lidar/sweep_caster.hpp"
#include "tests/sim/lidar/test_worlds.hpp"

namespace {

using namespace tumble::sim;  // NOLINT: a program of its own
using Eigen::Vector3d;

enum class Site { hill, hall };

/// Ground with a relief of some decimetres; the hill falls towards +x at 25 degrees.
double ground_m(Site site, double x_m, double y_m) {
  const double relief_m = 1.0 + 0.4 * std::sin(0.7 * x_m) * std::cos(0.5 * y_m) + 0.1 * std::sin(4.0 * x_m + 3.0 * y_m);
  return site == Site::hill ? relief_m + 0.466 * (20.0 - x_m) : relief_m;
}

engine::World caged_world(Site site) {
  constexpr int kCells = 400;
  constexpr double kHalf_m = 20.0, kHeight_m = 25.0;
  Stream chance(4, "bench.world");
  const auto text = [](double number) { return " " + std::to_string(number); };
  const auto number = [&](double low, double high) { return text(chance.uniform(low, high)); };
  std::string mjcf =
      "<mujoco><asset><hfield name='relief' nrow='401' ncol='401' size='20 20 25 0.5'/></asset><worldbody>"
      "<geom type='hfield' hfield='relief'/>";
  for (int i = 0; i < 40; ++i) {
    const double x = chance.uniform(-18, 18), y = chance.uniform(-18, 18);
    mjcf += "<geom type='ellipsoid' pos='" + text(x) + text(y) + text(ground_m(site, x, y)) + "' size='" +
            number(0.2, 0.6) + number(0.2, 0.6) + number(0.2, 0.6) + "'/>";
    const double tree_x = chance.uniform(-18, 18), tree_y = chance.uniform(-18, 18);
    mjcf += "<geom type='cylinder' pos='" + text(tree_x) + text(tree_y) + text(ground_m(site, tree_x, tree_y) + 2.0) +
            "' size='" + number(0.1, 0.25) + " 2.5'/>";
  }
  if (site == Site::hall) {
    mjcf +=
        "<geom type='box' pos='20.5 0 3' size='0.5 21 4'/><geom type='box' pos='-20.5 0 3' size='0.5 21 4'/>"
        "<geom type='box' pos='0 20.5 3' size='21 0.5 4'/><geom type='box' pos='0 -20.5 3' size='21 0.5 4'/>"
        "<geom type='box' pos='0 0 6.5' size='21 21 0.5'/>";
  }
  mjcf += "<body name='robot' pos='0 0 9'><freejoint/>";
  for (int i = 0; i < 12; ++i) {
    const double sign_a = i & 1 ? 1 : -1, sign_b = i & 2 ? 1 : -1;
    const auto corner = [&](double along) {
      Vector3d p;
      p[i / 4] = along;
      p[(i / 4 + 1) % 3] = sign_a;
      p[(i / 4 + 2) % 3] = sign_b;
      p = p.cwiseProduct(Vector3d(0.27, 0.23, 0.21));
      return " " + std::to_string(p.x()) + " " + std::to_string(p.y()) + " " + std::to_string(p.z());
    };
    mjcf += "<geom type='capsule' size='0.02' fromto='" + corner(-1) + corner(1) + "' mass='0.2'/>";
  }
  engine::World world = testing::world_of(mjcf + "</body></worldbody></mujoco>");
  for (int row = 0; row <= kCells; ++row) {
    for (int column = 0; column <= kCells; ++column) {
      const double x = kHalf_m * (2.0 * column / kCells - 1.0), y = kHalf_m * (2.0 * row / kCells - 1.0);
      world.model->hfield_data[row * (kCells + 1) + column] = static_cast<float>(ground_m(site, x, y) / kHeight_m);
    }
  }
  return world;
}

struct Motion {
  std::vector<Vector3d> p_WB_m;
  std::vector<Eigen::Quaterniond> q_WB;
};

/// Moves ten metres down the hill, 1.5 m above the ground, and rotates at 12 rad/s.
Motion tumbling(Site site, double duration_s) {
  Motion motion;
  for (int i = 0; i <= static_cast<int>(duration_s * 2000); ++i) {
    const double t = i / 2000.0;
    const double x = -5.0 + t, y = 0.3 * t;
    motion.p_WB_m.emplace_back(x, y, ground_m(site, x, y) + 1.5);
    motion.q_WB.emplace_back(Eigen::AngleAxisd(12.0 * t, Vector3d(0.2, 1.0, 0.1).normalized()));
  }
  return motion;
}

struct Setup {
  engine::World world;
  SensorSpec sensor;
  Motion motion;
  MotionTrack track() const { return {500000, motion.p_WB_m, motion.q_WB}; }
};

Setup setup(const char* kind, Site site, double sees_cage) {
  Setup out{caged_world(site), testing::lidar_of(kind), tumbling(site, 10.0)};
  out.sensor.values.set("sees_own_cage", sees_cage);
  return out;
}

void count(benchmark::State& state, std::size_t returns, std::size_t firings) {
  state.counters["returns"] = benchmark::Counter(static_cast<double>(returns), benchmark::Counter::kIsRate);
  state.counters["firings"] = benchmark::Counter(static_cast<double>(firings), benchmark::Counter::kIsRate);
  state.counters["share"] = static_cast<double>(returns) / static_cast<double>(std::max<std::size_t>(firings, 1));
}

void build(benchmark::State& state) {
  const Setup s = setup("spinning_lidar", Site::hill, 1.0);
  for (auto _ : state) {
    const SweepCaster caster(s.world, s.sensor, Eigen::Isometry3d::Identity(), s.track(), 1);
    benchmark::DoNotOptimize(&caster);
  }
}

void cast(benchmark::State& state, const char* kind, Site site, double sees_cage) {
  const Setup s = setup(kind, site, sees_cage);
  const SweepCaster caster(s.world, s.sensor, Eigen::Isometry3d::Identity(), s.track(), 1);
  SweepPoints points;
  points.make_room(caster.firings(0));
  std::size_t returns = 0, firings = 0;
  for (auto _ : state) {
    for (std::int64_t sweep = 0; sweep < 100; ++sweep) {
      caster.cast_sweep(sweep, points);
      returns += points.count;
      firings += caster.firings(sweep);
    }
  }
  count(state, returns, firings);
}

void simulate(benchmark::State& state, const char* kind, Site site, double sees_cage) {
  const Setup s = setup(kind, site, sees_cage);
  std::size_t returns = 0, firings = 0;
  for (auto _ : state) {
    LidarRecord record;
    LidarTruth truth;
    simulate_lidar(s.world, s.sensor, Eigen::Isometry3d::Identity(), s.track(), 1, 1, record, truth);
    returns += record.range_m.size();
    firings += record.sweep_start_ns.size() * (s.sensor.kind == "spinning_lidar" ? 32000 : 30000);
  }
  count(state, returns, firings);
}

struct Beam {
  double origin_m[3], direction[3];
};

/// Returns a column of the rays that cast() casts, from each of its sweeps in turn.
std::vector<Beam> beams_of(const Setup& s) {
  const SpinningPattern pattern(s.sensor.values);
  TrackCursor track(s.track(), Eigen::Isometry3d::Identity());
  FiringBlock block;
  BlockPoses poses;
  RayPacket rays;
  std::vector<Beam> beams;
  for (std::int64_t sweep = 0; sweep < 100; ++sweep) {
    pattern.fire(sweep, pattern.first_slot(sweep) + 19 * sweep, 1, block);
    poses.follow(pattern, block, track);
    for (int c = 0; c < pattern.channels(); ++c) {
      poses.aim(pattern, block, block.channel[c], c, rays);
      beams.push_back({{rays.origin_x[0], rays.origin_y[0], rays.origin_z[0]},
                       {rays.direction_x[0], rays.direction_y[0], rays.direction_z[0]}});
    }
  }
  return beams;
}

void engine_mj_ray(benchmark::State& state, Site site) {
  const Setup s = setup("spinning_lidar", site, 1.0);
  const engine::World& world = s.world;
  const engine::DataPtr data(mj_makeData(world.model.get()));
  mj_forward(world.model.get(), data.get());
  const std::vector<Beam> beams = beams_of(s);
  for (auto _ : state) {
    for (const Beam& beam : beams) {
      int geom;
      benchmark::DoNotOptimize(mj_ray(world.model.get(), data.get(), beam.origin_m, beam.direction, nullptr, 1,
                                      world.robot_body, &geom, nullptr));
    }
  }
  state.counters["firings"] =
      benchmark::Counter(static_cast<double>(state.iterations() * beams.size()), benchmark::Counter::kIsRate);
}

/// Casts the same rays with mj_multiRay, whose rays have a common origin: one column per call.
void engine_mj_multi_ray(benchmark::State& state, Site site) {
  constexpr std::size_t kColumn = 16;
  const Setup s = setup("spinning_lidar", site, 1.0);
  const engine::World& world = s.world;
  const engine::DataPtr data(mj_makeData(world.model.get()));
  mj_forward(world.model.get(), data.get());
  const std::vector<Beam> beams = beams_of(s);
  std::vector<double> directions;
  for (const Beam& beam : beams) directions.insert(directions.end(), beam.direction, beam.direction + 3);
  for (auto _ : state) {
    for (std::size_t i = 0; i < beams.size(); i += kColumn) {
      int geom[kColumn];
      double range[kColumn];
      mj_multiRay(world.model.get(), data.get(), beams[i].origin_m, directions.data() + 3 * i, nullptr, 1,
                  world.robot_body, geom, range, nullptr, kColumn, mjMAXVAL);
    }
  }
  state.counters["firings"] =
      benchmark::Counter(static_cast<double>(state.iterations() * beams.size()), benchmark::Counter::kIsRate);
}

BENCHMARK(build)->Unit(benchmark::kMillisecond)->Iterations(3);
BENCHMARK_CAPTURE(cast, rs16_hall, "spinning_lidar", Site::hall, 1.0)->Unit(benchmark::kMillisecond)->Iterations(2);
BENCHMARK_CAPTURE(cast, rs16_hill, "spinning_lidar", Site::hill, 1.0)->Unit(benchmark::kMillisecond)->Iterations(2);
BENCHMARK_CAPTURE(cast, mid100_hall, "rosette_lidar", Site::hall, 0.0)->Unit(benchmark::kMillisecond)->Iterations(2);
BENCHMARK_CAPTURE(cast, mid100_hill, "rosette_lidar", Site::hill, 0.0)->Unit(benchmark::kMillisecond)->Iterations(2);
BENCHMARK_CAPTURE(simulate, rs16_hall, "spinning_lidar", Site::hall, 1.0)->Unit(benchmark::kMillisecond)->Iterations(1);
BENCHMARK_CAPTURE(simulate, rs16_hill, "spinning_lidar", Site::hill, 1.0)->Unit(benchmark::kMillisecond)->Iterations(1);
BENCHMARK_CAPTURE(engine_mj_ray, rs16_hall, Site::hall)->Unit(benchmark::kMillisecond)->Iterations(2);
BENCHMARK_CAPTURE(engine_mj_ray, rs16_hill, Site::hill)->Unit(benchmark::kMillisecond)->Iterations(2);
BENCHMARK_CAPTURE(engine_mj_multi_ray, rs16_hall, Site::hall)->Unit(benchmark::kMillisecond)->Iterations(2);
BENCHMARK_CAPTURE(engine_mj_multi_ray, rs16_hill, Site::hill)->Unit(benchmark::kMillisecond)->Iterations(2);

}  // namespace
