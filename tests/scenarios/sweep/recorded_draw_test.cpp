// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/sweep/recorded_draw.hpp"

#include "scenarios/recordings/recording_file.hpp"
#include "scenarios/sweep/results.hpp"
#include "scenarios/sweep/sweep.hpp"
#include "stand_ins/synthetic_repoimu.hpp"
#include "tests/scenarios/testing.hpp"

namespace tumble::scenarios {
namespace {

// RecordedSweep has recordings like the published ones, one with and one without a reference
class RecordedSweep : public test::TemporaryFolder {
 protected:
  void SetUp() override {
    write("scenarios/catalogue/hill.yaml", "");
    fs::create_directory_symlink(test::source_dir() / "models", folder_ / "models");
    write("scenarios/suites/real.yaml",
          "name: real\ndoc: Some words.\nrecordings: [wands/*.h5]\nmethods: [rate/raw, rate/interpolate, rate/oracle, "
          "attitude/vqf, slam/icp_raw]\ntimeout_s: 60\n");
    record("wand_a", 30.0, true);
    record("wand_b", 20.0, false);
  }

  void record(const std::string& name, double duration_s, bool with_reference) const {
    constexpr std::int64_t kPeriod_ns = 10'000'000;
    const fixture::WandAttitude attitude(duration_s);
    sim::Sensors sensors;
    sim::Truth truth;
    truth.imus.resize(1);
    sim::ImuRecord& imu = sensors.imus.emplace_back();
    imu.name = truth.imus[0].name = "imu";
    imu.period_ns = truth.period_ns = kPeriod_ns;
    for (std::int64_t time_ns = 0; time_ns < std::llround(1e9 * duration_s); time_ns += kPeriod_ns) {
      const double t = 1e-9 * static_cast<double>(time_ns);
      const Vector3d w = fixture::Wand::rate(t);
      imu.time_ns.push_back(time_ns);
      imu.gyro_rad_s.push_back(fixture::clipped({}, w));
      imu.accel_m_s2.push_back(attitude.at(t).conjugate() * Vector3d(0.0, 0.0, 9.80665));
      imu.clip_flags.push_back(0);
      truth.q_WB.push_back(attitude.at(t));
      truth.w_WB_B_rad_s.push_back(w);
      for (auto* unknown : {&truth.p_WB_m, &truth.v_WB_m_s})
        unknown->push_back(Eigen::Vector3d::Constant(std::nan("")));
      truth.imus[0].rate_rad_s.push_back(w);
    }
    fs::create_directories(folder_ / "data/wands");
    write_recording(folder_ / "data/wands" / (name + ".h5"), {}, sensors, with_reference ? &truth : nullptr);
  }

  Suite suite() const {
    Suite suite = load_suite(DataRoot{folder_}, "real");
    suite.recordings_folder = folder_ / "data";
    return suite;
  }

  std::map<std::string, std::string> digests(const fs::path& database) const {
    std::map<std::string, std::string> found;
    for (const Outcome& row : Results(database, Results::Mode::read_only).outcomes())
      found[row.scenario + to_string(row.kind) + row.method] = row.recording_digest + row.estimate_digest;
    return found;
  }

  std::string complaint(const Suite& suite, const fs::path& database) const {
    return test::complaint([&] { sweep(DataRoot{folder_}, suite, DatabaseOwner(database), {}); });
  }
};

TEST_F(RecordedSweep, EachRecordingIsADraw) {
  const auto path = folder_ / "a.db";
  const SweepProgress progress = sweep(DataRoot{folder_}, suite(), DatabaseOwner(path), {});
  EXPECT_EQ(progress.draws_total, 2u);
  EXPECT_EQ(progress.draws_done, 2u);
  const Results results(path, Results::Mode::read_only);
  const std::vector<Outcome> rows = results.outcomes();
  ASSERT_EQ(rows.size(), 6u) << "an oracle has no truth to ask, a map no lidar";
  for (const Outcome& row : rows) {
    EXPECT_EQ(row.status, OutcomeStatus::ok) << row.scenario << " " << row.method << ": " << row.message;
    EXPECT_EQ(row.seed, 1u);
    std::map<std::string, double> scores;
    for (const ScoreRow& score : results.scores()) {
      if (score.scenario == row.scenario && score.kind == to_string(row.kind) && score.method == row.method)
        scores[score.metric] = score.value;
    }
    EXPECT_EQ(scores.contains("rate_error_clipped_median_rad_s"), row.scenario == "wand_a" && row.kind == Kind::rate);
    EXPECT_EQ(scores.contains("inclination_rmse_rad"), row.scenario == "wand_a" && row.kind == Kind::attitude);
    if (row.method == "vqf" && row.scenario == "wand_a") {
      EXPECT_LT(scores.at("inclination_rmse_rad"), 0.6) << "rates clip, gravity stays";
    }
  }
  EXPECT_EQ(results.note("source"), kRecordingsSource);
  // a resumed sweep has no work left; two processes at once give the same bits
  EXPECT_EQ(sweep(DataRoot{folder_}, suite(), DatabaseOwner(path), {}).outcomes, 0u);
  SweepOptions two;
  two.jobs = 2;
  sweep(DataRoot{folder_}, suite(), DatabaseOwner(folder_ / "b.db"), two);
  EXPECT_EQ(digests(path), digests(folder_ / "b.db"));
}

TEST_F(RecordedSweep, ARecordingThatHasChangedIsRefused) {
  sweep(DataRoot{folder_}, suite(), DatabaseOwner(folder_ / "a.db"), {});
  record("wand_b", 21.0, false);
  EXPECT_THAT(complaint(suite(), folder_ / "a.db"), HasSubstr("choose another database"));
  EXPECT_EQ(complaint(suite(), folder_ / "c.db"), "");
  Suite elsewhere = suite();
  elsewhere.recordings_folder = folder_ / "nowhere";
  EXPECT_THAT(complaint(elsewhere, folder_ / "d.db"), HasSubstr("no recording matches 'wands/*.h5'"));
  fs::create_directories(folder_ / "data/other");
  fs::copy(folder_ / "data/wands/wand_a.h5", folder_ / "data/other/wand_a.h5");
  Suite twice = suite();
  twice.recordings = {"wands/*.h5", "other/*.h5"};
  EXPECT_THAT(complaint(twice, folder_ / "e.db"), HasSubstr("has the same name"));
  twice.recordings = {"wands/*.h5", "wands/wand_a.h5"};
  EXPECT_EQ(find_recordings(twice.recordings, twice.recordings_folder).size(), 2u) << "each file once";
}

TEST_F(RecordedSweep, SuitesOfRecordingsHaveNoScenarios) {
  const auto refusal = [&](const std::string& rest) {
    write("scenarios/suites/real.yaml", "name: real\ndoc: d\n" + rest);
    return test::complaint([&] { load_suite(DataRoot{folder_}, "real"); });
  };
  EXPECT_EQ(refusal("recordings: [a.h5]\n"), "");
  EXPECT_THAT(refusal("recordings: [a.h5]\nseeds: {first: 1, last: 2}\n"),
              HasSubstr("this key is not allowed in a suite of recordings; remove the key"));
  EXPECT_THAT(refusal("recordings: []\n"), HasSubstr("needs at least one recording"));
  EXPECT_THAT(refusal("seeds: {first: 1, last: 2}\n"), HasSubstr("scenarios"));
}

}  // namespace
}  // namespace tumble::scenarios
