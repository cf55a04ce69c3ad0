// SPDX-License-Identifier: BSD-3-Clause
// Finished lidar points a second (poses and errors included), beside the engine's own rays in the same run, on a height
// field of 400 x 400 cells with 80 primitives and a cage of 12 struts.
#include <benchmark/benchmark.h>

#include <Eigen/Geometry>
#include <cmath>
#include <vector>

#include "sim/lidar/lidar_simulation.hpp"
#include "tests/sim/lidar/test_worlds.hpp"

namespace {

using namespace tumble::sim;  // NOLINT: a program of its own
using Eigen::Vector3d;

engine::World caged_world() {
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

void simulate(benchmark::State& state, const char* kind, double cage) {
  const engine::World world = caged_world();
  SensorSpec sensor = testing::lidar_of(kind);
  sensor.values.set("sees_own_cage", cage);
  // long enough that building the hierarchy (0.1 s) is a small share of it
  const Motion motion = tumbling(10.0);
  std::size_t points = 0, firings = 0;
  for (auto _ : state) {
    LidarRecord record;
    LidarTruth truth;
    simulate_lidar(world, sensor, Eigen::Isometry3d::Identity(), {500000, motion.p_WB_m, motion.q_WB}, 1, 1, record,
                   truth);
    points += record.range_m.size();
    firings += record.sweep_start_ns.size() * (sensor.kind == "spinning_lidar" ? 32000 : 30000);
  }
  state.counters["points"] = benchmark::Counter(static_cast<double>(points), benchmark::Counter::kIsRate);
  state.counters["firings"] = benchmark::Counter(static_cast<double>(firings), benchmark::Counter::kIsRate);
}

void engine_rays(benchmark::State& state) {
  const engine::World world = caged_world();
  const engine::DataPtr data(mj_makeData(world.model.get()));
  mj_forward(world.model.get(), data.get());
  Stream chance(1, "bench.rays");
  for (auto _ : state) {
    const double origin[3] = {0.0, 0.0, 2.5};
    const double azimuth = chance.uniform(0, 6.28), elevation = chance.uniform(-0.26, 0.26);
    const double direction[3] = {std::cos(azimuth) * std::cos(elevation), std::sin(azimuth) * std::cos(elevation),
                                 std::sin(elevation)};
    int geom;
    benchmark::DoNotOptimize(
        mj_ray(world.model.get(), data.get(), origin, direction, nullptr, 1, world.robot_body, &geom, nullptr));
  }
  state.counters["firings"] = benchmark::Counter(static_cast<double>(state.iterations()), benchmark::Counter::kIsRate);
}

BENCHMARK_CAPTURE(simulate, rs16, "spinning_lidar", 1.0)->Unit(benchmark::kMillisecond)->Iterations(1);
BENCHMARK_CAPTURE(simulate, rs16_without_cage, "spinning_lidar", 0.0)->Unit(benchmark::kMillisecond)->Iterations(1);
BENCHMARK_CAPTURE(simulate, mid100, "rosette_lidar", 0.0)->Unit(benchmark::kMillisecond)->Iterations(1);
BENCHMARK(engine_rays)->Unit(benchmark::kMicrosecond)->Iterations(2000);

}  // namespace
