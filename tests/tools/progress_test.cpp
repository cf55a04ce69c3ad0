// SPDX-License-Identifier: BSD-3-Clause
#include "tools/tumble/progress.hpp"

#include "tests/testing.hpp"

namespace tumble::tools {
namespace {

using scenarios::SweepProgress;

SweepProgress progress(std::uint64_t done, std::uint64_t total, double elapsed_s, double left_s) {
  SweepProgress p;
  p.draws_done = done;
  p.draws_total = total;
  p.outcomes = 4 * done;
  p.failures[scenarios::OutcomeStatus::failed] = 1;
  p.elapsed_s = elapsed_s;
  p.left_s = left_s;
  return p;
}

TEST(DurationText, UsesTwoUnitsAtMost) {
  EXPECT_EQ(duration_text(0.4), "0 s");
  EXPECT_EQ(duration_text(59.4), "59 s");
  EXPECT_EQ(duration_text(59.6), "1 min 00 s");  // rounded before it is split, so it is never "60 s"
  EXPECT_EQ(duration_text(185.0), "3 min 05 s");
  EXPECT_EQ(duration_text(3599.7), "1 h 00 min");
  EXPECT_EQ(duration_text(3720.0), "1 h 02 min");
  EXPECT_EQ(duration_text(-1.0), "?");
  EXPECT_EQ(duration_text(std::numeric_limits<double>::infinity()), "?");
  EXPECT_EQ(duration_text(std::numeric_limits<double>::quiet_NaN()), "?");
}

TEST(ProgressLine, ShowsShareCountsAndTimeLeft) {
  EXPECT_EQ(progress_line(progress(4, 10, 40.0, 60.0), 10),
            "[####------]  4/10 simulated runs  40 %  16 method runs, 1 not ok (1 failed)  0 simulations rejected  "
            "left 1 min 00 s");
  EXPECT_EQ(progress_line(progress(0, 10, 3.0, 0.0), 0),
            "0/10 simulated runs  0 %  0 method runs, 1 not ok (1 failed)  0 simulations rejected  left ?");
  EXPECT_EQ(progress_line(progress(10, 10, 90.0, 0.0), 4),
            "[####]  10/10 simulated runs  100 %  40 method runs, 1 not ok (1 failed)  0 simulations rejected  in 1 "
            "min 30 s");
}

TEST(ProgressLine, NamesEachWayToFailAndWhatIsKept) {
  SweepProgress p = progress(4, 10, 40.0, 60.0);
  p.failures = {{scenarios::OutcomeStatus::timeout, 1}, {scenarios::OutcomeStatus::diverged, 2}};
  p.kept = 3;
  p.to_keep = 8;
  EXPECT_EQ(progress_line(p, 0),
            "4/10 simulated runs  40 %  16 method runs, 3 not ok (2 diverged, 1 timeout)  0 simulations rejected  kept "
            "3/8  left 1 min 00 s");
  p.failures.clear();
  p.to_keep = 0;
  EXPECT_EQ(progress_line(p, 0),
            "4/10 simulated runs  40 %  16 method runs, 0 not ok  0 simulations rejected  left 1 min 00 s");
}

TEST(ProgressLine, OfNothingToDoIsComplete) {
  EXPECT_EQ(progress_line(progress(0, 0, 0.0, 0.0), 4),
            "[####]  0/0 simulated runs  100 %  0 method runs, 1 not ok (1 failed)  0 simulations rejected  in 0 s");
}

TEST(ProgressLine, OfAnEstimatorShowsSweepsPerSecond) {
  EXPECT_EQ(progress_line(RegistrationProgress{40, 100, 0.5}, 10), "[####------]  40/100 lidar sweeps  80 sweeps/s");
  EXPECT_EQ(progress_line(RegistrationProgress{0, 0, 0.0}, 4), "[####]  0/0 lidar sweeps  0 sweeps/s");
}

TEST(ProgressDisplay, OffATerminalWritesALineEveryTenSeconds) {
  std::vector<std::string> written;
  ProgressDisplay display([&](std::string_view text) { written.emplace_back(text); }, false);
  for (const double elapsed_s : {1.0, 9.9, 10.0, 15.0, 21.0}) display.show(progress(1, 10, elapsed_s, 5.0));
  EXPECT_EQ(written.size(), 2u) << "one line at 10 s and one at 21 s";
  display.finish(progress(10, 10, 22.0, 0.0));
  ASSERT_EQ(written.size(), 3u);
  for (const std::string& line : written) {
    EXPECT_EQ(line.back(), '\n') << line;
    EXPECT_EQ(line.find('\r'), std::string::npos) << line;
    EXPECT_EQ(line.find('\x1b'), std::string::npos) << line;
  }
}

TEST(ProgressDisplay, OnATerminalWritesOverOneLine) {
  std::vector<std::string> written;
  ProgressDisplay display([&](std::string_view text) { written.emplace_back(text); }, true);
  display.show(progress(1, 10, 1.0, 9.0));
  display.show(progress(2, 10, 1.1, 9.0));
  display.finish(progress(10, 10, 22.0, 0.0));
  ASSERT_EQ(written.size(), 3u);
  for (const std::string& text : written) EXPECT_EQ(text.front(), '\r');
  EXPECT_EQ(written[1].find('\n'), std::string::npos);
  EXPECT_EQ(written[2].back(), '\n');
}

}  // namespace
}  // namespace tumble::tools
