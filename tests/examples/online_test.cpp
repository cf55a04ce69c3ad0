// SPDX-License-Identifier: BSD-3-Clause
#include "examples/online/online.hpp"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "estimator/rolling/rolling_truth.hpp"
#include "tests/allocation_counter.hpp"

namespace tumble {
namespace {

const Eigen::Vector3d kLeverArm(0.02, -0.01, 0.03);

/// Returns the sphere along an L of 2 m with a phase of slip, measured by ideal sensors.
const testing::RollingTruth& truth() {
  static const testing::RollingTruth out =
      testing::roll({.velocity_m_s = testing::l_shape,
                     .contact_velocity_m_s = [](double t) -> Eigen::Vector3d {
                       return {-testing::minimum_jerk_speed(t, 2.8, 0.8, 0.25), 0.0, 0.0};
                     },
                     .lever_arm_m = kLeverArm});
  return out;
}

std::vector<std::string> lines() {
  std::vector<std::string> out;
  char text[256];
  for (const ImuSample& s : truth().samples) {
    const Eigen::Vector3d &w = s.angular_velocity_rad_s, &f = s.specific_force_m_s2;
    std::snprintf(text, sizeof text, "%lld %.17g %.17g %.17g %.17g %.17g %.17g", static_cast<long long>(s.time_ns),
                  w.x(), w.y(), w.z(), f.x(), f.y(), f.z());
    out.emplace_back(text);
  }
  return out;
}

RollingParams params() {
  RollingParams out;
  out.radius_m = testing::kRadius_m;
  out.lever_arm_m = kLeverArm;
  return out;
}

struct Pose {
  long long time_ns = 0;
  Eigen::Vector3d p_m = Eigen::Vector3d::Zero();
};

Pose parse(std::string_view text) {
  Pose pose;
  std::istringstream stream{std::string(text)};
  stream >> pose.time_ns >> pose.p_m.x() >> pose.p_m.y() >> pose.p_m.z();
  EXPECT_FALSE(stream.fail()) << text;
  return pose;
}

TEST(Online, SaysWhatTheFilterSaysAndAllocatesNothing) {
  const std::vector<std::string> in = lines();
  const RollingFilter filter(params());
  const auto state = std::make_unique<RollingFilter::State>();
  online::Online program(params());
  std::string last;
  last.reserve(online::Online::kLineMax);
  (void)program.take(in[0]);
  ASSERT_TRUE(program.ok());
  const std::size_t before = test::allocations.count;
  const std::size_t held = mallinfo2().uordblks;
  for (std::size_t k = 1; k < in.size(); ++k) {
    const std::string_view answer = program.take(in[k]);
    ASSERT_TRUE(program.ok()) << k << ": " << answer;
    last.assign(answer);
  }
  EXPECT_EQ(test::allocations.count, before);
  EXPECT_EQ(mallinfo2().uordblks, held);
  for (const ImuSample& sample : truth().samples) ASSERT_TRUE(filter.step(sample, *state).ok());
  const Pose pose = parse(last);
  EXPECT_EQ(pose.time_ns, truth().samples.back().time_ns);
  EXPECT_LT((pose.p_m - state->sphere_centre_W_m).norm(), 2e-6);  // the text has six digits
  EXPECT_LT((pose.p_m - truth().p_WG_m.back()).norm(), 0.01);     // 0.5 % of the path; ideal sensors
  EXPECT_EQ(program.samples(), in.size());
}

TEST(Online, NamesWhatItCannotUseAndGoesOn) {
  const std::vector<std::string> in = lines();
  online::Online program(params());
  ASSERT_TRUE((program.take(in[0]), program.ok()));
  EXPECT_EQ(program.take("x 0 0 0 0 0 9.8"), "time_ns: not a whole number");
  EXPECT_FALSE(program.ok());
  EXPECT_EQ(program.take("4000000 0 0 0 0 0"), "specific force: three numbers needed");
  EXPECT_EQ(program.take("4000000 0 0 0 0 0 9.8 1"), "more than seven numbers");
  EXPECT_EQ(program.take("4000000 0 0 0 0 0 9.8x"), "specific force: three numbers needed");
  EXPECT_NE(program.take("4000000 nan 0 0 0 0 9.8").find("non_finite"), std::string_view::npos);
  EXPECT_NE(program.take("0 0 0 0 0 0 9.8").find("time_order"), std::string_view::npos);
  EXPECT_FALSE(program.ok());
  EXPECT_EQ(program.take("# a comment"), "");
  EXPECT_TRUE(program.ok());
  EXPECT_EQ(program.samples(), 1u);
  const std::string_view answer = program.take(in[1]);
  EXPECT_TRUE(program.ok()) << answer;
  EXPECT_EQ(parse(answer).time_ns, truth().samples[1].time_ns);
}

TEST(Online, RefusesBadParams) {
  RollingParams bad;
  bad.radius_m = -1.0;
  EXPECT_THROW(online::Online{bad}, InvalidParams);
}

/// Runs the program with `arguments` on a file of `text`; returns its exit status, with its output in `out`.
int run(const std::string& arguments, const std::string& text, std::string& out) {
  const std::filesystem::path file =
      std::filesystem::path(::testing::TempDir()) / ("online_" + std::to_string(::getpid()) + ".txt");
  std::ofstream(file) << text;
  const std::string command = std::string(TUMBLE_ONLINE) + " " + arguments + " < " + file.string() + " 2>&1";
  FILE* pipe = popen(command.c_str(), "r");
  if (pipe == nullptr) return -1;
  out.clear();
  char buffer[4096];
  while (std::size_t count = std::fread(buffer, 1, sizeof buffer, pipe)) out.append(buffer, count);
  const int status = pclose(pipe);
  std::filesystem::remove(file);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

TEST(OnlineProgram, WritesAPoseForEachLine) {
  std::string in, out;
  const std::vector<std::string> all = lines();
  for (std::size_t k = 0; k < 300; ++k) in += all[k] + "\n";
  ASSERT_EQ(run("0.145 0.02 -0.01 0.03", in, out), 0) << out;
  EXPECT_EQ(std::count(out.begin(), out.end(), '\n'), 300);
  EXPECT_EQ(parse(out.substr(out.rfind('\n', out.size() - 2) + 1)).time_ns, truth().samples[299].time_ns);
}

TEST(OnlineProgram, ExitStatus) {
  std::string out;
  EXPECT_EQ(run("0.145", "", out), 1);
  EXPECT_EQ(run("0.145", "nonsense\n", out), 1);
  EXPECT_NE(out.find("line 1: time_ns"), std::string::npos) << out;
  EXPECT_EQ(run("", "", out), 2);
  EXPECT_EQ(run("-1", "", out), 2);
  EXPECT_NE(out.find("radius_m"), std::string::npos) << out;
  EXPECT_EQ(run("0.145 1", "", out), 2);
}

}  // namespace
}  // namespace tumble
