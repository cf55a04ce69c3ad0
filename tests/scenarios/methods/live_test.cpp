// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/draw/scenario.hpp"
#include "scenarios/estimates/method.hpp"
#include "scenarios/methods/registry.hpp"
#include "scenarios/methods/synthetic_recording.hpp"
#include "scenarios/scoring/clipping.hpp"
#include "scenarios/sweep/evaluate.hpp"
#include "sim/random/stream.hpp"
#include "tests/scenarios/testing.hpp"

// A live method must report a state before it receives later readings. The reported state must be bitwise equal for any
// later readings, and without later readings.
namespace tumble::scenarios {
namespace {

struct Live {
  const char* method;
  double lag_s;  ///< age of the readings whose reported states are final
};

void PrintTo(const Live& live, std::ostream* out) {
  *out << live.method;
}

constexpr double kRateLagS = 0.2;   // AngularRateStream::Params::lag_s
constexpr double kSweepLagS = 0.4;  // the poses since the sweep's start are final 0.3 s after the sweep's end
constexpr double kRollLagS = 1.22;  // sum of lag_s (1 s), a block (0.2 s) and a node (0.02 s)

const std::vector<Live> kLive = {
    {"rate/raw", 0.0},
    {"rate/tumble_lag", kRateLagS},
    {"attitude/integrate", 0.0},
    {"attitude/madgwick", 0.0},
    {"attitude/complementary", 0.0},
    {"attitude/autogain", 0.0},
    {"attitude/vqf", 0.0},
    {"attitude/tumble_lag", kRateLagS},
    {"position/rolling", 0.0},
    {"position/autogain_fusion", 0.0},
    {"position/tumble_lag", kRollLagS},
    {"position/tumble_live", 0.0},
    {"slam/icp_raw", 0.0},
    {"slam/tumble_lag", kSweepLagS},
    {"slam/tumble_live", 0.0},
};

/// A Fault replaces the readings from sample `from` on by faulty readings.
using Fault = std::function<void(std::size_t from, sim::ImuRecord& imu)>;

/// Limits each axis to half of its largest reading.
void clip_at_half(std::size_t from, std::vector<Vector3d>& readings) {
  Vector3d rail = Eigen::Vector3d::Zero();
  for (std::size_t k = from; k < readings.size(); ++k) rail = rail.cwiseMax(0.5 * readings[k].cwiseAbs());
  for (std::size_t k = from; k < readings.size(); ++k) readings[k] = readings[k].cwiseMax(-rail).cwiseMin(rail);
}

const std::map<std::string, Fault>& faults() {
  static const std::map<std::string, Fault> all = {
      {"gyro_flipped",
       [](std::size_t from, sim::ImuRecord& imu) {
         for (std::size_t k = from; k < imu.time_ns.size(); ++k) imu.gyro_rad_s[k] *= -1.0;
       }},
      {"gyro_z_frozen",
       [](std::size_t from, sim::ImuRecord& imu) {
         for (std::size_t k = from; k < imu.time_ns.size(); ++k) imu.gyro_rad_s[k].z() = imu.gyro_rad_s[from].z();
       }},
      {"imu_frozen",
       [](std::size_t from, sim::ImuRecord& imu) {
         for (std::size_t k = from; k < imu.time_ns.size(); ++k) {
           imu.gyro_rad_s[k] = imu.gyro_rad_s[from];
           imu.accel_m_s2[k] = imu.accel_m_s2[from];
         }
       }},
      {"gyro_offset",
       [](std::size_t from, sim::ImuRecord& imu) {
         for (std::size_t k = from; k < imu.time_ns.size(); ++k) imu.gyro_rad_s[k] += Vector3d(1.0, -0.7, 0.5);
       }},
      {"first_saturation",
       [](std::size_t from, sim::ImuRecord& imu) {
         clip_at_half(from, imu.gyro_rad_s);
         clip_at_half(from, imu.accel_m_s2);
       }},
      {"one_wild_reading",
       [](std::size_t from, sim::ImuRecord& imu) {
         const std::size_t k = std::min(from + 20, imu.time_ns.size() - 1);
         imu.gyro_rad_s[k].y() = 1.5 * imu.stated_gyro_range_rad_s;
       }},
  };
  return all;
}

template <class Row>
void keep_first(std::size_t count, std::vector<Row>& rows) {
  if (rows.size() > count) rows.resize(count);
}

/// Keeps the readings that a robot has received up to a given time.
void truncate(std::int64_t end_ns, sim::Sensors& sensors) {
  for (sim::ImuRecord& imu : sensors.imus) {
    const auto end = std::upper_bound(imu.time_ns.begin(), imu.time_ns.end(), end_ns);
    const auto count = static_cast<std::size_t>(end - imu.time_ns.begin());
    keep_first(count, imu.time_ns), keep_first(count, imu.gyro_rad_s), keep_first(count, imu.accel_m_s2);
    keep_first(count, imu.clip_flags), keep_first(count, imu.magnetic_field_t);
  }
  for (sim::LidarRecord& lidar : sensors.lidars) {
    std::size_t sweeps = 0;
    while (sweeps < lidar.sweep_start_ns.size() && lidar.sweep_start_ns[sweeps] + lidar.sweep_period_ns <= end_ns)
      ++sweeps;
    const auto points = static_cast<std::size_t>(lidar.sweep_first[sweeps]);
    keep_first(sweeps, lidar.sweep_start_ns), keep_first(sweeps + 1, lidar.sweep_first);
    keep_first(points, lidar.position_L_m), keep_first(points, lidar.range_m), keep_first(points, lidar.intensity);
    keep_first(points, lidar.offset_ns), keep_first(points, lidar.ring);
  }
}

void apply(const Fault& fault, std::int64_t after_ns, sim::Sensors& sensors) {
  sim::ImuRecord& imu = sensors.imus.back().name == "imu_reference" ? sensors.imus.front() : sensors.imus.back();
  const auto from = std::upper_bound(imu.time_ns.begin(), imu.time_ns.end(), after_ns);
  fault(static_cast<std::size_t>(from - imu.time_ns.begin()), imu);
}

bool same(const AngularRateState& a, const AngularRateState& b) {
  return a.time_ns == b.time_ns && a.w_WI_I_rad_s == b.w_WI_I_rad_s && a.covariance_rad2_s2 == b.covariance_rad2_s2 &&
         a.clipped_axes == b.clipped_axes && a.source == b.source;
}

bool same(const AttitudeState& a, const AttitudeState& b) {
  return a.time_ns == b.time_ns && a.orientation_W.coeffs() == b.orientation_W.coeffs() &&
         a.covariance_rad2 == b.covariance_rad2;
}

bool same(const PoseState& a, const PoseState& b) {
  return a.time_ns == b.time_ns && a.position_W_m == b.position_W_m &&
         a.orientation_W.coeffs() == b.orientation_W.coeffs() && a.velocity_W_m_s == b.velocity_W_m_s &&
         a.covariance == b.covariance;
}

/// A Comparison contains the number of compared states, and the time of the first different state.
struct Comparison {
  std::size_t answers = 0;
  std::int64_t differs_ns = -1;
};

template <class State>
Comparison compare(const std::vector<State>& early, const std::vector<State>& whole, std::int64_t until_ns) {
  Comparison out;
  for (std::size_t k = 0; k < early.size() && early[k].time_ns <= until_ns; ++k) {
    ++out.answers;
    const bool equal = k < whole.size() && same(early[k], whole[k]);
    if (!equal && out.differs_ns < 0) out.differs_ns = early[k].time_ns;
  }
  return out;
}

Comparison compare(Kind kind, const Estimate& early, const Estimate& whole, std::int64_t until_ns) {
  if (kind == Kind::rate) return compare(early.rates, whole.rates, until_ns);
  if (kind == Kind::attitude) return compare(early.attitudes, whole.attitudes, until_ns);
  return compare(early.poses, whole.poses, until_ns);
}

sim::Sensors simulated(const char* scenario, std::uint64_t seed, sim::Truth& truth) {
  const DataRoot data{test::source_dir()};
  const SimulatedDraw draw = simulate_draw(data, load_scenario(data, scenario), seed, 1, Lidars::left_out);
  truth = draw.recording.truth;
  return draw.recording.sensors;
}

/// Returns the rig in its room. The readings have noise, because readings without noise would count as frozen.
sim::Recording noisy_rig() {
  testing::SyntheticMotion motion;
  motion.start_s = 0.9;
  motion.end_s = 3.9;
  motion.duration_s = 4.8;
  sim::Recording recording = testing::synthetic_rig(motion);
  sim::Stream noise(3, "noise");
  sim::ImuRecord& imu = recording.sensors.imus.front();
  for (std::size_t k = 0; k < imu.time_ns.size(); ++k) {
    for (int j = 0; j < 3; ++j) imu.gyro_rad_s[k][j] += 0.002 * (noise.uniform() - 0.5);
    for (int j = 0; j < 3; ++j) imu.accel_m_s2[k][j] += 0.02 * (noise.uniform() - 0.5);
  }
  return recording;
}

struct CutRecording {
  sim::Sensors sensors;
  std::vector<std::int64_t> cuts_ns;
};

constexpr std::int64_t kSecondNs = 1'000'000'000;

/// Returns a tumble, cut before its first saturation and after it.
const CutRecording& tumble_run() {
  static const CutRecording run = [] {
    sim::Truth truth;
    CutRecording out{simulated("hill", 62001, truth), {}};
    const ClippingTruth clipping(out.sensors, truth);
    std::size_t first = 0;
    while (first < clipping.size() && clipping.clipped_axes(first) == 0) ++first;
    const std::int64_t first_ns = out.sensors.imus.front().time_ns.at(first);
    out.cuts_ns = {first_ns - kSecondNs / 20, first_ns + kSecondNs, first_ns + 2 * kSecondNs};
    return out;
  }();
  return run;
}

const CutRecording& roll_run() {
  static const CutRecording run = [] {
    sim::Truth truth;
    CutRecording out{simulated("slip", 62001, truth), {}};
    const std::int64_t end_ns = out.sensors.imus.front().time_ns.back();
    out.cuts_ns = {end_ns * 2 / 5, end_ns * 3 / 5};
    return out;
  }();
  return run;
}

const CutRecording& mapped_run() {
  static const CutRecording run = {noisy_rig().sensors,
                                   {17 * kSecondNs / 10, 3 * kSecondNs}};  // the gyro saturates after 1.85 s
  return run;
}

const CutRecording& run_of(Kind kind) {
  if (kind == Kind::slam) return mapped_run();
  return kind == Kind::position ? roll_run() : tumble_run();
}

class LiveMeansLive : public ::testing::TestWithParam<Live> {
 protected:
  /// Compares the states before the cut with the states of runs with later readings.
  void expect_equal_before(std::size_t cut) {
    const std::int64_t cut_ns = run_.cuts_ns.at(cut);
    sim::Sensors received = run_.sensors;
    truncate(cut_ns, received);
    const Estimate early = method_.run(received, {}, {});
    ASSERT_TRUE(early.status.ok()) << early.status.message();
    const std::int64_t until_ns = cut_ns - static_cast<std::int64_t>(1e9 * GetParam().lag_s);
    if (!whole_) whole_ = method_.run(run_.sensors, {}, {});
    ASSERT_TRUE(whole_->status.ok()) << whole_->status.message();
    expect_equal(early, *whole_, until_ns, "none");
    for (const auto& [name, fault] : faults()) {
      // a SLAM method takes seconds per run, so it runs only with these faults
      if (method_.info.kind == Kind::slam && name != "imu_frozen" && name != "gyro_flipped") continue;
      sim::Sensors later = run_.sensors;
      apply(fault, cut_ns, later);
      const Estimate faulty = method_.run(later, {}, {});
      if (!faulty.status.ok()) continue;  // the harness rejects the recording
      expect_equal(early, faulty, until_ns, name);
    }
  }

  const Method& method_ = *find_methods(GetParam().method).at(0);
  const CutRecording& run_ = run_of(method_.info.kind);

 private:
  void expect_equal(const Estimate& early, const Estimate& whole, std::int64_t until_ns, const std::string& fault) {
    const Comparison compared = compare(method_.info.kind, early, whole, until_ns);
    EXPECT_GT(compared.answers, 50u);
    EXPECT_EQ(compared.differs_ns, -1) << fault << " until " << until_ns;
  }

  std::optional<Estimate> whole_;  ///< of the whole recording without a fault
};

TEST_P(LiveMeansLive, AnswersDoNotDependOnLaterReadings) {
  // methods of position and SLAM are slow, so they run only with the cut after the saturation
  const bool fast = method_.info.kind == Kind::rate || method_.info.kind == Kind::attitude;
  if (fast) expect_equal_before(0);
  expect_equal_before(1);
}

/// Every method with every cut. The tumble has a third cut, a second later in the motion.
class LiveMeansLiveSoak : public LiveMeansLive {};

TEST_P(LiveMeansLiveSoak, AnswersDoNotDependOnLaterReadings) {
  for (std::size_t cut = 0; cut < run_.cuts_ns.size(); ++cut) expect_equal_before(cut);
}

std::string test_name(const ::testing::TestParamInfo<Live>& param) {
  std::string name = param.param.method;
  std::replace(name.begin(), name.end(), '/', '_');
  return name;
}

/// Returns the methods without those that other authors published, which this project only compares with.
std::vector<Live> methods_of_this_project() {
  std::vector<Live> out;
  std::copy_if(kLive.begin(), kLive.end(), std::back_inserter(out),
               [](const Live& live) { return std::string(live.method).find("/tumble") != std::string::npos; });
  return out;
}
INSTANTIATE_TEST_SUITE_P(Registered, LiveMeansLive, ::testing::ValuesIn(methods_of_this_project()), test_name);
INSTANTIATE_TEST_SUITE_P(Registered, LiveMeansLiveSoak, ::testing::ValuesIn(kLive), test_name);

// The test checks that the comparison detects a method that uses the whole recording, and that health checks report the
// faults.
TEST(LiveMethods, SeesAMethodThatUsesTheWholeRecording) {
  const CutRecording& run = tumble_run();
  sim::Sensors received = run.sensors, later = run.sensors;
  truncate(run.cuts_ns[1], received);
  apply(faults().at("gyro_flipped"), run.cuts_ns[1], later);
  const auto rates = [](const char* method, const sim::Sensors& sensors) {
    return find_methods(method).at(0)->run(sensors, {}, {});
  };
  const std::int64_t until_ns = run.cuts_ns[1] - kSecondNs / 5;
  EXPECT_GE(compare(Kind::rate, rates("rate/tumble", received), rates("rate/tumble", later), until_ns).differs_ns, 0);
  EXPECT_TRUE(has_implausible_readings(rates("rate/tumble_lag", later)));
  EXPECT_FALSE(has_implausible_readings(rates("rate/tumble_lag", run.sensors)));
}

TEST(LiveMethods, CoversEveryMethodThatCallsItselfLive) {
  for (const Method& method : methods()) {
    if (!method.info.name.ends_with("_live") && !method.info.name.ends_with("_lag")) continue;
    EXPECT_TRUE(std::any_of(kLive.begin(), kLive.end(), [&](const Live& live) {
      return live.method == full_name(method.info);
    })) << full_name(method.info);
  }
}

}  // namespace
}  // namespace tumble::scenarios
