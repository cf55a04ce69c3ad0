// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/processes/process_pool.hpp"

#include <fmt/format.h>
#include <poll.h>

#include <list>
#include <system_error>
#include <utility>
#include <vector>

#include "scenarios/errors.hpp"

namespace tumble::scenarios {

namespace {

/// Longest wait for messages before the deadlines are checked [ms].
constexpr int kWaitMs = 200;

struct Running {
  std::size_t index;
  double deadline_s;  ///< deadline as a time of now_s()
  Process process;
  std::string said;
};

/// Returns false if the operating system refuses to start a process while other processes of the pool are running. The
/// caller can call begin() again after another process of the pool has ended.
bool begin(std::list<Running>& running, std::size_t index, double deadline_s, const std::function<void(int)>& work) {
  try {
    running.push_back({index, deadline_s, Process(work, true), {}});
    return true;
  } catch (const std::system_error& error) {
    if (running.empty()) throw BadInput(fmt::format("cannot start a worker process: {}", error.what()));
    return false;
  }
}

void wait_for_words(const std::list<Running>& running) {
  std::vector<pollfd> waiting;
  for (const Running& each : running) waiting.push_back({each.process.read_end(), POLLIN, 0});
  poll(waiting.data(), waiting.size(), kWaitMs);
}

}  // namespace

void run_in_processes(std::size_t count, const PoolOptions& options, const std::function<void(std::size_t, int)>& work,
                      const std::function<void(const PooledEnd&)>& on_end) {
  const auto stopped = [&] { return options.stop != nullptr && options.stop->load(); };
  std::list<Running> running;
  std::size_t next = 0;
  while (!stopped() && (next < count || !running.empty())) {
    while (next < count && running.size() < static_cast<std::size_t>(options.jobs)) {
      const auto own = [&work, index = next](int fd) { work(index, fd); };
      if (!begin(running, next, now_s() + options.limit_s, own)) break;
      ++next;
    }
    wait_for_words(running);
    for (auto each = running.begin(); each != running.end();) {
      const bool open = each->process.read_available(each->said);
      const bool late = open && now_s() > each->deadline_s;
      if (open && !late) {
        ++each;
        continue;
      }
      if (late) each->process.kill();
      const Process::End end = each->process.wait();
      on_end({each->index, std::move(each->said), late, end});
      each = running.erase(each);
    }
  }
}

}  // namespace tumble::scenarios
