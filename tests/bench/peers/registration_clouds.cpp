// SPDX-License-Identifier: BSD-3-Clause
// Measures the registration alone, on clouds that are written for other programs: a map of the analytic room, and
// stationary sweeps from other poses.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "tests/estimator/mapping/synthetic_room.hpp"
#include "tumble/common/types.hpp"
#include "tumble/mapping/detail/registration.hpp"

namespace {

using tumble::LidarPoint;
using tumble::Registration;
using tumble::SweepPoint;

constexpr int kSweeps = 12, kRepeats = 5, kColumns = 1800;
constexpr double kVoxel_m = 0.25, kNoise_m = 0.02;

Eigen::Isometry3d place(int k) {
  Eigen::Isometry3d T(tumble::so3::exp(0.7 * k * Eigen::Vector3d(1.0, 0.5, 0.2)));
  T.translation() = Eigen::Vector3d(1.5 * (k % 3 - 1), 1.0 * (k / 3 % 3 - 1), 0.2 * (k % 4));
  return T;
}

std::vector<LidarPoint> still_sweep(const Eigen::Isometry3d& T, int number) {
  tumble::test::Motion still;
  still.rest_s = 1e9;
  return tumble::test::make_sweep(tumble::test::Room::box_with_pillars(), still, T, number, kNoise_m, kColumns);
}

void write_pose(std::ofstream& file, const Eigen::Isometry3d& T) {
  file << T.matrix() << '\n';
}

/// Returns the shortest of several registration times of one stationary sweep [ms], with the result in `found`.
double time_ms(Registration& registration, const Registration::Prior& prior, const std::vector<SweepPoint>& points,
               const tumble::VoxelMap& map, Registration::Result& found) {
  tumble::MotionSample still;
  still.time_ns = tumble::test::kSweep_ns;
  still.f_I_m_s2 = prior.mean.state.q_WI.conjugate() * Eigen::Vector3d(0.0, 0.0, 9.80665);
  double best = 1e9;
  for (int i = 0; i < kRepeats; ++i) {
    tumble::SweepTrajectory trajectory;
    const auto start = std::chrono::steady_clock::now();
    (void)registration.align(prior, {&still, 1}, tumble::test::kSweep_ns, points, map, trajectory, found);
    const auto end = std::chrono::steady_clock::now();
    best = std::min(best, std::chrono::duration<double, std::milli>(end - start).count());
  }
  return best;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: registration_clouds FOLDER\n");
    return 2;
  }
  const std::filesystem::path folder = argv[1];
  std::filesystem::create_directories(folder);
  tumble::VoxelMap map({0.5, 0.1});
  std::ofstream map_file(folder / "map.txt");
  for (int k = 0; k < 9; ++k) {
    for (const LidarPoint& point : still_sweep(place(k), k)) {
      const Eigen::Vector3f x = (place(k) * point.position_L_m.cast<double>()).cast<float>();
      if (map.insert(x, 0.02f, 0, static_cast<std::uint32_t>(16 * k + point.ring))) map_file << x.transpose() << '\n';
    }
  }
  Registration registration(Registration::Params{});
  std::vector<double> times, errors_m, errors_rad;
  for (int k = 0; k < kSweeps; ++k) {
    const Eigen::Isometry3d truth(Eigen::Translation3d(0.3 * (k % 4), -0.2 * (k % 3), 0.1) *
                                  tumble::so3::exp(0.37 * k * Eigen::Vector3d(0.3, -1.0, 0.5)));
    std::vector<SweepPoint> all, points;
    tumble::select_points(still_sweep(truth, 100 + k), {0.3, 100.0, Eigen::AlignedBox3d()},
                          Eigen::Isometry3d::Identity(), 0.0, all);
    std::vector<Eigen::Vector3f> positions;
    for (const SweepPoint& point : all) positions.push_back(point.x_I_m);
    tumble::SweepSampler sampler;
    std::vector<std::uint32_t> chosen;
    sampler.choose_points_per_voxel(positions, kVoxel_m, chosen);
    for (const std::uint32_t index : chosen) points.push_back(all[index]);

    tumble::MotionState believed;
    believed.p_WI_m = truth.translation() + Eigen::Vector3d(0.1, -0.08, 0.06);
    believed.q_WI = tumble::so3::exp({0.02, -0.015, 0.02}) * Eigen::Quaterniond(truth.linear());
    believed.covariance.diagonal() << Eigen::Vector3d::Constant(1.0), Eigen::Vector3d::Constant(0.1),
        Eigen::Vector3d::Constant(1e-8);
    const Registration::Prior prior(believed);
    Eigen::Isometry3d start = Eigen::Isometry3d::Identity();
    start.linear() = prior.mean.state.q_WI.toRotationMatrix();
    start.translation() = prior.mean.state.p_WI_m;
    char name[32];
    std::snprintf(name, sizeof(name), "sweep_%02d", k);
    std::ofstream cloud(folder / (std::string(name) + ".txt")), pose(folder / (std::string(name) + ".pose"));
    for (const SweepPoint& point : points) cloud << point.x_I_m.transpose() << '\n';
    write_pose(pose, start);
    write_pose(pose, truth);

    Registration::Result found;
    times.push_back(time_ms(registration, prior, points, map, found));
    errors_m.push_back((found.mean.state.p_WI_m - truth.translation()).norm());
    errors_rad.push_back(
        tumble::so3::logarithm(found.mean.state.q_WI * Eigen::Quaterniond(truth.linear()).conjugate()).norm());
  }
  std::sort(times.begin(), times.end());
  std::sort(errors_m.begin(), errors_m.end());
  std::sort(errors_rad.begin(), errors_rad.end());
  std::printf("tumble %d sweeps: median %.2f ms, worst %.2f ms, error median %.4f m %.5f rad, worst %.4f m\n", kSweeps,
              times[kSweeps / 2], times.back(), errors_m[kSweeps / 2], errors_rad[kSweeps / 2], errors_m.back());
  return 0;
}
