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

/// Longest wait for messages of the child processes [ms]. After each wait, the time limits of the child processes are
/// checked.
constexpr int kWaitMs = 200;

struct Running {
  std::size_t index;
  double deadline_s;  ///< deadline as a time of now_s()
  Process process;
  std::string output;
};

/// Returns false if the operating system refuses to start a process while other processes of the pool are running. The
/// caller can call begin() again after another process of the pool has ended.
bool begin(std::list<Running>& running, std::size_t index, const PooledWork& work) {
  try {
    running.push_back({index, now_s() + work.limit_s, Process(work.work, true), {}});
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

void run_in_processes(const std::function<std::optional<PooledWork>()>& next, const PoolOptions& options,
                      const std::function<void(const PooledEnd&)>& on_end) {
  const auto stopped = [&] { return options.stop != nullptr && options.stop->load(); };
  const auto end_round = [&] {
    if (options.on_round) options.on_round();
  };
  std::list<Running> running;
  std::size_t begun = 0;
  std::optional<PooledWork> waiting;
  for (bool more = true; !stopped();) {
    while (more && !stopped() && running.size() < static_cast<std::size_t>(options.jobs)) {
      if (!waiting) waiting = next();
      more = waiting.has_value();
      if (!more || !begin(running, begun, *waiting)) break;
      waiting.reset();
      ++begun;
    }
    end_round();
    if (running.empty()) return;
    wait_for_words(running);
    for (auto each = running.begin(); each != running.end();) {
      const bool open = each->process.read_available(each->output);
      if (options.on_output) options.on_output(each->index, each->output);
      const bool late = open && now_s() > each->deadline_s;
      if (open && !late) {
        ++each;
        continue;
      }
      if (late) each->process.kill();
      const Process::End end = each->process.wait();
      on_end({each->index, std::move(each->output), late, end});
      each = running.erase(each);
    }
    end_round();
  }
}

void run_in_processes(std::size_t count, double limit_s, const PoolOptions& options,
                      const std::function<void(std::size_t, int)>& work,
                      const std::function<void(const PooledEnd&)>& on_end) {
  std::size_t begun = 0;
  const auto next = [&]() -> std::optional<PooledWork> {
    if (begun == count) return std::nullopt;
    return PooledWork{[&work, index = begun++](int fd) { work(index, fd); }, limit_s};
  };
  run_in_processes(next, options, on_end);
}

}  // namespace tumble::scenarios
