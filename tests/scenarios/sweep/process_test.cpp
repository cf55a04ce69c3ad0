// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/processes/process.hpp"
#include "scenarios/methods/registry.hpp"

#include <poll.h>
#include <signal.h>
#include <sys/resource.h>
#include <unistd.h>

#include <new>

#include "scenarios/methods/synthetic_recording.hpp"
#include "scenarios/sweep/draw_process.hpp"
#include "scenarios/sweep/message.hpp"
#include "tests/testing.hpp"

namespace tumble::scenarios {
namespace {

std::string read_all(Process& process) {
  std::string text;
  while (process.read_available(text)) {
    pollfd waiting{process.read_end(), POLLIN, 0};
    poll(&waiting, 1, 1000);
  }
  return text;
}

TEST(Process, HandsOverWhatTheChildWrites) {
  const std::string large(300000, 'x');  // larger than the buffer of a pipe
  Process process([&](int fd) { write_all(fd, large); }, false);
  EXPECT_EQ(read_all(process), large);
  EXPECT_TRUE(process.wait().normal);
}

TEST(Process, ReportsHowTheChildEnded) {
  Process throwing([](int) { throw std::runtime_error("no"); }, false);
  const Process::End thrown = throwing.wait();
  EXPECT_FALSE(thrown.normal);
  EXPECT_EQ(thrown.exit_code, 1);
  Process killed([](int) { raise(SIGKILL); }, false);
  const Process::End end = killed.wait();
  EXPECT_EQ(end.signal, SIGKILL);
  EXPECT_EQ(end.describe(), "ended by signal 9 (Killed)");
}

TEST(Process, ANewGroupDiesAsAWhole) {
  // the grandchild holds the pipe's write end: the pipe closes when the grandchild has ended
  Process process(
      [](int fd) {
        if (fork() == 0) {
          write_all(fd, "grandchild\n");
          while (true) pause();
        }
        while (true) pause();
      },
      true);
  std::string text;
  while (text.empty()) {
    pollfd waiting{process.read_end(), POLLIN, 0};
    poll(&waiting, 1, 1000);
    ASSERT_TRUE(process.read_available(text));
  }
  process.kill();
  EXPECT_EQ(process.wait().signal, SIGKILL);
  EXPECT_EQ(read_all(process), "");
}

TEST(Message, ComesBackToTheBit) {
  Outcome outcome;
  outcome.scenario = "hill";
  outcome.seed = std::numeric_limits<std::uint64_t>::max();
  outcome.kind = Kind::position;
  outcome.method = "rolling";
  outcome.status = OutcomeStatus::failed;
  outcome.message = "a \"quote\", a \xff byte";
  outcome.scores = {{"a", 0.1}, {"b", 1e-310}, {"c", std::numeric_limits<double>::quiet_NaN()}};
  std::string line = to_line({outcome, {}});
  ASSERT_EQ(line.back(), '\n');
  line.pop_back();
  EXPECT_EQ(line.find('\n'), std::string::npos);
  const auto message = from_line(line);
  ASSERT_TRUE(message && message->outcome);
  EXPECT_EQ(message->outcome->seed, outcome.seed);
  EXPECT_EQ(message->outcome->kind, Kind::position);
  ASSERT_EQ(message->outcome->scores.size(), 3u);
  EXPECT_EQ(message->outcome->scores[0].value, 0.1);
  EXPECT_EQ(message->outcome->scores[1].value, 1e-310);
  EXPECT_TRUE(std::isnan(message->outcome->scores[2].value));
  // a process died in the middle of its line
  EXPECT_FALSE(from_line(line.substr(0, line.size() / 2)).has_value());
  EXPECT_FALSE(from_line("").has_value());
}

// RunIsolated runs methods that misbehave in every possible way
class RunIsolated : public ::testing::Test {
 protected:
  static SimulatedDraw draw() {
    SimulatedDraw draw;
    draw.scenario = "synthetic";
    draw.seed = 3;
    draw.recording = testing::synthetic_sphere();
    draw.recording_digest = "abc";
    draw.simulate_cpu_s = 1.5;
    return draw;
  }

  static Outcome run(const std::function<Estimate(const sim::Sensors&)>& body, double timeout_s = 60.0) {
    Method method;
    method.info.name = "test";
    method.info.kind = Kind::rate;
    method.run = [body](const sim::Sensors& sensors, const sim::Values&, const OracleInput&) { return body(sensors); };
    return run_isolated(method, draw(), draw(), nullptr, timeout_s);
  }

  static double score_named(const Outcome& outcome, const std::string& name) {
    for (const Score& score : outcome.scores) {
      if (score.metric == name) return score.value;
    }
    ADD_FAILURE() << "no score " << name;
    return std::numeric_limits<double>::quiet_NaN();
  }
};

TEST_F(RunIsolated, AGoodMethodIsScoredWithItsCost) {
  const Outcome outcome = run_isolated(*find_methods("raw").front(), draw(), draw(), nullptr, 60.0);
  EXPECT_EQ(outcome.status, OutcomeStatus::ok) << outcome.message;
  EXPECT_EQ(outcome.scenario, "synthetic");
  EXPECT_EQ(outcome.seed, 3u);
  EXPECT_EQ(outcome.recording_digest, "abc");
  EXPECT_EQ(outcome.estimate_digest.size(), 32u);
  EXPECT_EQ(score_named(outcome, "simulate_cpu_s"), 1.5);
  EXPECT_GE(score_named(outcome, "estimate_cpu_s"), 0.0);
  EXPECT_EQ(score_named(outcome, "rate_error_free_median_rad_s"), 0.0);
}

TEST_F(RunIsolated, MemoryIsTheMethodsOwn) {
  const auto touch = [](std::size_t mib) {
    return [mib](const sim::Sensors&) {
      std::vector<char> block(mib << 20);
      for (std::size_t k = 0; k < block.size(); k += 512) block[k] = static_cast<char>(k >> 9);
      Estimate estimate;
      estimate.health["sum"] = block[12345 << 3];
      return estimate;
    };
  };
  EXPECT_NEAR(score_named(run(touch(64)), "estimate_peak_mib"), 64.0, 16.0);
  EXPECT_LT(score_named(run(touch(0)), "estimate_peak_mib"), 16.0);
}

TEST_F(RunIsolated, ACrashIsAnOutcome) {
  const Outcome outcome = run([](const sim::Sensors&) -> Estimate { std::abort(); });
  EXPECT_EQ(outcome.status, OutcomeStatus::crashed);
  EXPECT_EQ(outcome.message, "ended by signal 6 (Aborted)");
  EXPECT_EQ(outcome.method, "test");
  EXPECT_EQ(outcome.seed, 3u);
}

TEST_F(RunIsolated, AnExitInsideAMethodIsACrash) {
  EXPECT_EQ(run([](const sim::Sensors&) -> Estimate { _exit(0); }).status, OutcomeStatus::crashed);
}

// a fault of the machine is no verdict on the method
TEST_F(RunIsolated, AKillFromOutsideAndNoMemoryAreTheMachines) {
  const Outcome killed = run([](const sim::Sensors&) -> Estimate {
    kill(getpid(), SIGKILL);
    return {};
  });
  EXPECT_EQ(killed.status, OutcomeStatus::killed);
  EXPECT_EQ(killed.message, "ended by signal 9 (Killed)");
  const Outcome memory = run([](const sim::Sensors&) -> Estimate { throw std::bad_alloc(); });
  EXPECT_EQ(memory.status, OutcomeStatus::killed);
  EXPECT_EQ(memory.message,
            "there is not enough memory for the method; free memory or increase the memory limit of a process");
}

TEST_F(RunIsolated, EndlessWorkIsATimeout) {
  const Outcome outcome = run(
      [](const sim::Sensors&) -> Estimate {
        while (true) pause();
      },
      0.3);
  EXPECT_EQ(outcome.status, OutcomeStatus::timeout);
  EXPECT_NE(outcome.message.find("0.3"), std::string::npos);
}

TEST_F(RunIsolated, AnExceptionIsAFailure) {
  const Outcome outcome = run([](const sim::Sensors&) -> Estimate { throw std::runtime_error("two\nlines"); });
  EXPECT_EQ(outcome.status, OutcomeStatus::failed);
  EXPECT_EQ(outcome.message, "two lines");
}

TEST_F(RunIsolated, AStatusThatIsNotOkIsAFailure) {
  const Outcome outcome = run([](const sim::Sensors&) {
    Estimate estimate;
    estimate.status = {ErrorCode::gap, "imu.time_ns", 2.0, 1.0};
    return estimate;
  });
  EXPECT_EQ(outcome.status, OutcomeStatus::failed);
  EXPECT_EQ(outcome.message, "gap: imu.time_ns is 2; the bound is 1");
}

TEST_F(RunIsolated, NoAnswerIsADivergence) {
  EXPECT_EQ(run([](const sim::Sensors&) { return Estimate{}; }).status, OutcomeStatus::diverged);
}

}  // namespace
}  // namespace tumble::scenarios
