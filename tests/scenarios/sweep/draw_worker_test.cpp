// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/sweep/draw_worker.hpp"

#include <gtest/gtest.h>
#include <malloc.h>
#include <poll.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstddef>
#include <fstream>
#include <memory>
#include <vector>

#include "scenarios/sweep/small_catalogue.hpp"

namespace tumble::scenarios {
namespace {

/// Allocates the memory that earlier tests have freed and that malloc still holds. Otherwise, a worker forked from this
/// process could use this memory, despite its limit.
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

/// A limit sufficient for the process, but not for a world: its present data plus a little.
double too_little_mib() {
  std::ifstream file("/proc/self/statm");
  double pages[6] = {};
  for (double& each : pages) file >> each;
  return pages[5] * static_cast<double>(sysconf(_SC_PAGESIZE)) / (1024.0 * 1024.0) + 0.5;
}

class DrawWorkerTest : public testing::SmallCatalogue {
 protected:
  void SetUp() override {
    SmallCatalogue::SetUp();
    suite_.name = "small";
    suite_.scenarios = {"roll"};
    suite_.last_seed = 4;
    suite_.methods = {"rate/raw", "position/rolling"};
    suite_.timeout_s = 60;
  }

  /// Returns the messages of a worker until it is idle or ended.
  static std::vector<Message> all_of(DrawWorker& worker) {
    std::vector<Message> said;
    while (worker.is_busy() && worker.hear(said)) {
      pollfd waiting{worker.read_end(), POLLIN, 0};
      poll(&waiting, 1, 1000);
    }
    return said;
  }

  Suite suite_;
  SweepOptions options_;
};

// for each seed, the second draw of a worker has the bits of the first draw of another worker
TEST_F(DrawWorkerTest, NothingOfADrawIsThereAtTheNext) {
  const DataRoot data{folder_};
  SweepPlan plan(data, suite_, options_, folder_ / "a.db");
  const Results none(folder_ / "a.db", Results::Mode::create_or_append);
  const WorkerTerms terms{data, plan, suite_.timeout_s, kWorkerMemoryMib};
  DrawWorker pooled(terms);
  for (; !plan.at_end(); plan.advance()) {
    const DrawTask task = plan.next(none);
    const DrawTask same = plan.from_line(plan.to_line(task));
    EXPECT_EQ(same.seed, task.seed);
    EXPECT_EQ(same.runs.size(), 2u);
    ASSERT_TRUE(pooled.give(same, now_s() + 60.0));
    DrawWorker alone(terms);
    ASSERT_TRUE(alone.give(same, now_s() + 60.0));
    std::vector<std::string> digests[2];
    for (int k = 0; k < 2; ++k) {
      for (const Message& message : all_of(k == 0 ? pooled : alone)) {
        if (!message.outcome) continue;
        EXPECT_EQ(message.outcome->status, OutcomeStatus::ok);
        digests[k].push_back(message.outcome->recording_digest + message.outcome->estimate_digest);
      }
    }
    EXPECT_EQ(digests[0].size(), 2u);
    EXPECT_EQ(digests[0], digests[1]);
    EXPECT_TRUE(pooled.is_fresh());
  }
  const Process::End end = pooled.dismiss();
  EXPECT_TRUE(end.normal);
  EXPECT_GT(end.peak_mib, 1.0);
}

// a worker that died while idle gets no draw, and the sweep continues
TEST_F(DrawWorkerTest, OneThatDiedIdleIsSeen) {
  const DataRoot data{folder_};
  const SweepPlan plan(data, suite_, options_, folder_ / "a.db");
  const Results none(folder_ / "a.db", Results::Mode::create_or_append);
  DrawWorker worker({data, plan, suite_.timeout_s, kWorkerMemoryMib});
  worker.kill();
  siginfo_t info{};
  waitid(P_ALL, 0, &info, WEXITED | WNOWAIT);
  EXPECT_FALSE(worker.give(plan.from_line(plan.to_line(plan.next(none))), now_s() + 60.0));
  EXPECT_FALSE(worker.is_busy());
  EXPECT_EQ(worker.dismiss().signal, SIGKILL);
}

// a draw that needs too much memory is `killed`, which is not a failure of a method; the worker exits normally
TEST_F(DrawWorkerTest, MemoryIsLimited) {
  const DataRoot data{folder_};
  const SweepPlan plan(data, suite_, options_, folder_ / "a.db");
  const Results none(folder_ / "a.db", Results::Mode::create_or_append);
  const auto taken = freed_memory();
  DrawWorker worker({data, plan, suite_.timeout_s, too_little_mib()});
  ASSERT_TRUE(worker.give(plan.next(none), now_s() + 60.0));
  std::size_t outcomes = 0;
  for (const Message& message : all_of(worker)) {
    if (message.rejected) ADD_FAILURE() << message.rejected->message;
    if (!message.outcome) continue;
    ++outcomes;
    EXPECT_EQ(message.outcome->status, OutcomeStatus::killed) << message.outcome->message;
    EXPECT_NE(message.outcome->message.find("not enough memory"), std::string::npos) << message.outcome->message;
  }
  EXPECT_EQ(outcomes, 2u);
  EXPECT_FALSE(worker.is_fresh()) << "it is not used again";
  EXPECT_TRUE(worker.dismiss().normal);
}

}  // namespace
}  // namespace tumble::scenarios
