// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/sweep/draw_process.hpp"

#include <malloc.h>
#include <unistd.h>

#include "scenarios/processes/process_pool.hpp"
#include "scenarios/sweep/message.hpp"
#include "scenarios/sweep/small_catalogue.hpp"
#include "scenarios/sweep/sweep_plan.hpp"
#include "tests/testing.hpp"

namespace tumble::scenarios {
namespace {

/// Takes the memory that earlier tests have freed and that malloc still keeps. Otherwise a process that is forked from
/// this process could use that memory, whatever its limit.
std::vector<std::unique_ptr<char[]>> freed_memory() {
  malloc_trim(0);
  std::vector<std::unique_ptr<char[]>> out;
  out.reserve(1u << 20);
  for (const std::size_t size : {65536u, 4096u, 512u}) {
    const auto held = mallinfo2().arena;
    while (out.size() < out.capacity() && mallinfo2().arena == held && mallinfo2().fordblks > size)
      out.push_back(std::make_unique<char[]>(size));
  }
  return out;
}

/// Returns a limit that is enough for the process as it is and too little for a world: its present data and a little
/// more.
double too_little_mib() {
  std::ifstream file("/proc/self/statm");
  double pages[6] = {};
  for (double& each : pages) file >> each;
  return pages[5] * static_cast<double>(sysconf(_SC_PAGESIZE)) / (1024.0 * 1024.0) + 0.5;
}

using DrawProcessTest = testing::SmallCatalogue;

// a draw that needs more memory than its process may use is `killed`, which is no verdict on a method; the process ends
// without a fault
TEST_F(DrawProcessTest, MemoryIsLimited) {
  Suite suite;
  suite.name = "small";
  suite.scenarios = {"roll"};
  suite.methods = {"rate/raw", "position/rolling"};
  suite.timeout_s = 60;
  const DataRoot data{folder_};
  const SweepOptions options;
  const SweepPlan plan(data, suite, options, folder_ / "a.db");
  const DrawTask task = plan.next(Results(folder_ / "a.db", Results::Mode::create_or_append));
  const auto taken = freed_memory();
  const double limit_mib = too_little_mib();
  std::size_t outcomes = 0;
  run_in_processes(
      1, 60.0, {},
      [&](std::size_t, int fd) {
        limit_memory(limit_mib);
        run_draw(data, task, suite.timeout_s, fd);
      },
      [&](const PooledEnd& ended) {
        EXPECT_TRUE(ended.end.normal) << ended.end.describe();
        EXPECT_GT(ended.end.peak_mib, 1.0);
        std::istringstream lines(ended.output);
        for (std::string line; std::getline(lines, line);) {
          const std::optional<Message> message = from_line(line);
          ASSERT_TRUE(message) << line;
          if (message->rejected) ADD_FAILURE() << message->rejected->message;
          if (!message->outcome) continue;
          ++outcomes;
          EXPECT_EQ(message->outcome->status, OutcomeStatus::killed) << message->outcome->message;
          EXPECT_NE(message->outcome->message.find("not enough memory"), std::string::npos)
              << message->outcome->message;
        }
      });
  EXPECT_EQ(outcomes, 2u);
}

// text arrives in pieces, also the text of a process that never ends; the other processes run meanwhile
TEST(ProcessPool, HandsOverWhatWasWrittenWhileTheProcessesRun) {
  std::atomic<bool> stop = false;
  std::vector<std::size_t> ended;
  std::string endless;
  PoolOptions options{2, &stop, {}, {}};
  options.on_output = [&](std::size_t index, std::string& output) {
    if (index != 0) return;
    endless += output;
    output.clear();
    stop = stop || (!endless.empty() && ended.size() == 2);
  };
  run_in_processes(
      3, 60.0, options,
      [](std::size_t index, int fd) {
        write_all(fd, "process " + std::to_string(index));
        while (index == 0) pause();
      },
      [&](const PooledEnd& end) {
        EXPECT_EQ(end.output, "process " + std::to_string(end.index));
        EXPECT_TRUE(end.end.normal);
        ended.push_back(end.index);
      });
  EXPECT_EQ(endless, "process 0");
  EXPECT_EQ(ended, (std::vector<std::size_t>{1, 2}));
}

}  // namespace
}  // namespace tumble::scenarios
