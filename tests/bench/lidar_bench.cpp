// SPDX-License-Identifier: BSD-3-Clause
// Lidar points a second on one core, beside the engine's own rays in the same run, over a height field of 400 x 400
// cells with 40 rocks, 40 trunks and a cage of 12 struts.
//   build     the mirror of the world that rays are cast against, once a recording
//   cast      sweeps after that: each firing from its own pose, errors, intensity, surface id, exact hit
//   simulate  simulate_lidar as a whole: build, cast and a recording of 10 s written to memory
// `returns` counts finished points (what a recording holds), `firings` the beams sent out: on the open hill half of
// them go to the sky; in the hall (the same ground under a roof, within walls) nearly all return. Rates are of
// processor time.
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

engine::World caged_world(Site site) {
  constexpr int kCells = 400;
  Stream chance(4, "bench.world");
  const auto number = [&](double low, double high) { return " " + std::to_string(chance.uniform(low, high)); };
  std::string mjcf =
      "<mujoco><asset><hfield name='relief' nrow='401' ncol='401' size='20 20 2 0.5'/></asset><worldbody>"
      "<geom type='hfield' hfield='relief'/>";
  for (int i = 0; i < 40; ++i) {
    mjcf += "<geom type='ellipsoid' pos='" + number(-18, 18) + number(-18, 18) + " 1' size='" + number(0.2, 0.6) +
            number(0.2, 0.6) + number(0.2, 0.6) + "'/><geom type='cylinder' pos='" + number(-18, 18) + number(-18, 18) +
            " 3' size='" + number(0.1, 0.25) + " 2.5'/>";
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
      world.model->hfield_data[row * (kCells + 1) + column] = static_cast<float>(
          0.5 + 0.2 * std::sin(0.05 * row) * std::cos(0.07 * column) + 0.05 * std::sin(0.4 * row + 0.3 * column));
    }
  }
  return world;
}

struct Motion {
  std::vector<Vector3d> p_WB_m;
  std::vector<Eigen::Quaterniond> q_WB;
};

Motion tumbling(double duration_s) {
  Motion motion;
  for (int i = 0; i <= static_cast<int>(duration_s * 2000); ++i) {
    const double t = i / 2000.0;
    motion.p_WB_m.emplace_back(-4 + 2 * t, 0.5 * t, 2.5);
    motion.q_WB.emplace_back(Eigen::AngleAxisd(12.0 * t, Vector3d(0.2, 1.0, 0.1).normalized()));
  }
  return motion;
}

struct Setup {
  engine::World world;
  SensorSpec sensor;
  Motion motion = tumbling(10.0);
  MotionTrack track() const { return {500000, motion.p_WB_m, motion.q_WB}; }
};

Setup setup(const char* kind, Site site, double sees_cage) {
  Setup out{caged_world(site), testing::lidar_of(kind)};
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

/// A beam of the column from above the middle of the field, as the lidar sends it.
void aim(Stream& chance, double direction[3]) {
  const double azimuth = chance.uniform(0, 6.28), elevation = chance.uniform(-0.26, 0.26);
  direction[0] = std::cos(azimuth) * std::cos(elevation);
  direction[1] = std::sin(azimuth) * std::cos(elevation);
  direction[2] = std::sin(elevation);
}

constexpr double kOrigin[3] = {0.0, 0.0, 2.5};

void engine_mj_ray(benchmark::State& state) {
  const engine::World world = caged_world(Site::hill);
  const engine::DataPtr data(mj_makeData(world.model.get()));
  mj_forward(world.model.get(), data.get());
  Stream chance(1, "bench.rays");
  for (auto _ : state) {
    double direction[3];
    aim(chance, direction);
    int geom;
    benchmark::DoNotOptimize(
        mj_ray(world.model.get(), data.get(), kOrigin, direction, nullptr, 1, world.robot_body, &geom, nullptr));
  }
  state.counters["firings"] = benchmark::Counter(static_cast<double>(state.iterations()), benchmark::Counter::kIsRate);
}

void engine_mj_multi_ray(benchmark::State& state) {
  constexpr int kRays = 1000;
  const engine::World world = caged_world(Site::hill);
  const engine::DataPtr data(mj_makeData(world.model.get()));
  mj_forward(world.model.get(), data.get());
  Stream chance(1, "bench.rays");
  std::vector<double> direction(3 * kRays), range(kRays);
  std::vector<int> geom(kRays);
  for (int i = 0; i < kRays; ++i) aim(chance, direction.data() + 3 * i);
  for (auto _ : state) {
    mj_multiRay(world.model.get(), data.get(), kOrigin, direction.data(), nullptr, 1, world.robot_body, geom.data(),
                range.data(), nullptr, kRays, mjMAXVAL);
  }
  state.counters["firings"] =
      benchmark::Counter(static_cast<double>(state.iterations() * kRays), benchmark::Counter::kIsRate);
}

BENCHMARK(build)->Unit(benchmark::kMillisecond)->Iterations(3);
BENCHMARK_CAPTURE(cast, rs16_hall, "spinning_lidar", Site::hall, 1.0)->Unit(benchmark::kMillisecond)->Iterations(2);
BENCHMARK_CAPTURE(cast, rs16_hill, "spinning_lidar", Site::hill, 1.0)->Unit(benchmark::kMillisecond)->Iterations(2);
BENCHMARK_CAPTURE(cast, mid100_hall, "rosette_lidar", Site::hall, 0.0)->Unit(benchmark::kMillisecond)->Iterations(2);
BENCHMARK_CAPTURE(cast, mid100_hill, "rosette_lidar", Site::hill, 0.0)->Unit(benchmark::kMillisecond)->Iterations(2);
BENCHMARK_CAPTURE(simulate, rs16_hall, "spinning_lidar", Site::hall, 1.0)->Unit(benchmark::kMillisecond)->Iterations(1);
BENCHMARK_CAPTURE(simulate, rs16_hill, "spinning_lidar", Site::hill, 1.0)->Unit(benchmark::kMillisecond)->Iterations(1);
BENCHMARK(engine_mj_ray)->Unit(benchmark::kMicrosecond)->Iterations(2000);
BENCHMARK(engine_mj_multi_ray)->Unit(benchmark::kMillisecond)->Iterations(2);

}  // namespace
