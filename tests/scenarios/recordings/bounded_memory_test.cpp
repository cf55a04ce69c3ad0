// SPDX-License-Identifier: BSD-3-Clause
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "scenarios/recordings/bags/bag.hpp"
#include "scenarios/recordings/bags/bag_messages.hpp"
#include "scenarios/recordings/bags/bag_storage.hpp"
#include "scenarios/recordings/bags/sweep_messages.hpp"
#include "scenarios/recordings/dialects/export_for.hpp"
#include "scenarios/recordings/export.hpp"
#include "scenarios/recordings/fixture_recording.hpp"
#include "scenarios/scoring/estimate_in_bag.hpp"

namespace tumble::scenarios {
namespace {

constexpr int kShort = 40, kLong = 160;  // sweeps
constexpr int kPoints = 20000;           // of a sweep: 26 bytes each in a record
/// kMore_mib is the least size in a record of the 120 sweeps that the long bag has more.
constexpr double kMore_mib = 120.0 * kPoints * 26.0 / (1 << 20);
/// An import of the long bag may take more memory than one of the short bag by a tenth of kMore_mib. Samples and
/// indices take some 100 bytes for each of the 1400 additional messages; the rest depends on how the allocator keeps
/// pages.
constexpr double kGrowth_mib = kMore_mib / 10.0;

struct Kind {
  const char *name, *format;
  std::unique_ptr<BagWriter> (*writer)(const fs::path&);
  Imported (*read)(const fs::path&, const BagReading&);
};

/// Writes a bag of a lidar and an IMU, sweep by sweep.
void write_bag(BagWriter& bag, int sweeps) {
  constexpr std::int64_t kOrigin_ns = 1'700'000'000'000'000'000, kPeriod_ns = 100'000'000, kImu_ns = 10'000'000;
  fixture::Numbers numbers;
  sim::Recording recording;
  fixture::add_lidar(numbers, recording, "lidar", 1, kPoints);
  sim::ImuRecord imu = fixture::imu_record(numbers, "imu", 1);
  imu.accel_m_s2 = {Vector3d(0.0, 0.0, 9.8)};
  for (int k = 0; k < sweeps; ++k) {
    const std::int64_t start_ns = kOrigin_ns + k * kPeriod_ns;
    for (int i = 1; i <= 10; ++i) {
      const std::int64_t time_ns = start_ns + i * kImu_ns;
      bag.write("/imu", time_ns, imu_message(imu, 0, header_of(time_ns, "imu")));
    }
    bag.write(
        "/points", start_ns + kPeriod_ns,
        sweep_message(recording.sensors.lidars[0], 0, own_sweep_layout(), start_ns, header_of(start_ns, "lidar")));
  }
  bag.finish();
}

/// Returns the largest resident set [MiB] of a separate process that does the work.
double peak_mib(const std::function<void()>& work) {
  const pid_t child = fork();
  if (child == 0) {
    try {
      work();
      _exit(0);
    } catch (const std::exception& error) {
      static_cast<void>(!write(STDERR_FILENO, error.what(), std::strlen(error.what())));
      _exit(1);
    }
  }
  int status = 0;
  rusage usage{};
  EXPECT_EQ(wait4(child, &status, 0, &usage), child);
  EXPECT_EQ(status, 0);
  return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

class BoundedMemory : public test::TemporaryFolder, public testing::WithParamInterface<Kind> {
 protected:
  fs::path bag(int sweeps) const { return folder_ / ("bag" + std::to_string(sweeps)); }
  fs::path recording(int sweeps) const { return folder_ / (std::to_string(sweeps) + ".h5"); }
  double import_mib(int sweeps, bool aside) {
    return peak_mib([&] {
      BagReading reading;
      if (aside) reading.sweeps.scratch = folder_;
      const Imported read = GetParam().read(bag(sweeps), reading);
      const fs::path out = folder_ / "out.h5";
      if (aside)
        write_recording(out, read.info, read.sensors, read.points, nullptr);
      else
        write_recording(out, read.info, read.sensors, nullptr);
    });
  }
  void expect_bounded_import() {
    for (const int sweeps : {kShort, kLong}) write_bag(*GetParam().writer(bag(sweeps)), sweeps);
    EXPECT_LT(import_mib(kLong, true) - import_mib(kShort, true), kGrowth_mib);
    // with the points in the record, the measure must detect the growth
    EXPECT_GT(import_mib(kLong, false) - import_mib(kShort, false), kMore_mib);
  }
  void expect_bounded_export() {
    for (const int sweeps : {kShort, kLong}) {
      write_bag(*GetParam().writer(bag(sweeps)), sweeps);
      ASSERT_GT(import_mib(sweeps, true), 0.0);
      fs::rename(folder_ / "out.h5", recording(sweeps));
    }
    const auto export_mib = [&](int sweeps) {
      const fs::path out = folder_ / "out";
      fs::remove_all(out);
      return peak_mib([&] { export_recording(recording(sweeps), GetParam().format, out); });
    };
    EXPECT_LT(export_mib(kLong) - export_mib(kShort), kGrowth_mib);
    // with the points in the record, the measure must detect the growth
    const auto whole_mib = [&](int sweeps) { return peak_mib([&] { read_sensors(recording(sweeps)); }); };
    EXPECT_GT(whole_mib(kLong) - whole_mib(kShort), kMore_mib / 2.0);
  }
};

TEST_P(BoundedMemory, AnImportDoesNotGrowWithTheBag) {
  expect_bounded_import();
}
TEST_P(BoundedMemory, AnExportDoesNotGrowWithTheRecording) {
  expect_bounded_export();
}

class BoundedMemorySoak : public BoundedMemory {};

TEST_P(BoundedMemorySoak, AnImportDoesNotGrowWithTheBag) {
  expect_bounded_import();
}
TEST_P(BoundedMemorySoak, AnExportDoesNotGrowWithTheRecording) {
  expect_bounded_export();
}

/// Writes a recording with the truth of its body, an IMU and the end of each ray, and the same poses as an estimate.
void write_truthful(const fs::path& folder, int sweeps) {
  constexpr int kStates = 200, kSamples = 40;  // for the 0.1 s of a sweep
  fixture::Numbers numbers;
  sim::Recording recording;
  sim::Truth& truth = recording.truth;
  recording.sensors.robot = "rig";
  recording.sensors.imus.push_back(fixture::imu_record(numbers, "imu", kSamples * sweeps));
  truth.imus.push_back(fixture::imu_truth(numbers, "imu", kSamples * sweeps));
  fixture::add_lidar(numbers, recording, "lidar", sweeps, kPoints);
  truth.surfaces = {"terrain", "rock"};
  for (int i = 0; i < kStates * sweeps; ++i) {
    truth.p_WB_m.push_back(numbers.vector());
    truth.q_WB.push_back(numbers.quaternion());
    for (auto* rows : {&truth.v_WB_m_s, &truth.w_WB_B_rad_s, &truth.f_B_m_s2}) rows->push_back(numbers.vector());
    truth.label.push_back(sim::ContactLabel::air);
  }
  write_recording(folder / (std::to_string(sweeps) + ".h5"), fixture::info(), recording.sensors, &truth);
  std::ofstream poses(folder / (std::to_string(sweeps) + ".tum"));
  for (int i = 0; i < 10 * sweeps; ++i) poses << 0.01 * i << " 1 2 3 0 0 0 1\n";
}

class BoundedExport : public test::TemporaryFolder {
 protected:
  BoundedExport() {
    for (const int sweeps : {kShort, kLong}) peak_mib([&] { write_truthful(folder_, sweeps); });
  }
  fs::path file(int sweeps, const char* ending) const { return folder_ / (std::to_string(sweeps) + ending); }
  /// Returns how much more memory the long recording takes than the short one.
  template <class Work>
  double growth_mib(Work&& work) {
    return peak_mib([&] { work(kLong); }) - peak_mib([&] { work(kShort); });
  }
};

TEST_F(BoundedExport, DoesNotGrowWithTruthAndEstimates) {
  for (const char* format : {"rosbag1", "rosbag2", "mcap"}) {
    const double growth = growth_mib([&](int sweeps) {
      const fs::path estimate[] = {file(sweeps, ".tum")};
      const ExportChoices beside{true, own_sweep_layout(), [&](const sim::Sensors& sensors, BagWriting& writing) {
                                   add_estimates(estimate, sensors, writing);
                                 }};
      export_recording(file(sweeps, ".h5"), format, folder_ / (format + std::to_string(sweeps)), beside);
    });
    EXPECT_LT(growth, kGrowth_mib) << format;
  }
  EXPECT_GT(growth_mib([&](int sweeps) { read_truth(file(sweeps, ".h5")); }), kGrowth_mib)
      << "the measure sees what grows";
}

TEST_F(BoundedExport, DoesNotGrowForAPeer) {
  for (const char* peer : {"kiss-icp", "point-lio"}) {
    const double growth = growth_mib(
        [&](int sweeps) { export_for(file(sweeps, ".h5"), peer, folder_ / (peer + std::to_string(sweeps)), true); });
    EXPECT_LT(growth, kGrowth_mib) << peer;
  }
}

const auto kKindName = [](const auto& kind) { return std::string(kind.param.name); };
INSTANTIATE_TEST_SUITE_P(Kinds, BoundedMemory, testing::Values(Kind{"Mcap", "mcap", make_mcap_writer, import_mcap}),
                         kKindName);
INSTANTIATE_TEST_SUITE_P(Kinds, BoundedMemorySoak,
                         testing::Values(Kind{"Ros1", "rosbag1", make_ros1_writer, import_ros1_bag},
                                         Kind{"Ros2", "rosbag2", make_ros2_writer, import_ros2_bag}),
                         kKindName);

}  // namespace
}  // namespace tumble::scenarios
