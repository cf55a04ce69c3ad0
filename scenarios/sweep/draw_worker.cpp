// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/sweep/draw_worker.hpp"

#include <malloc.h>
#include <stdlib.h>
#include <unistd.h>

#include <cerrno>
#include <optional>

namespace tumble::scenarios {

namespace {

std::optional<std::string> next_line(int fd, std::string& buffer) {
  char chunk[8192];
  std::size_t newline;
  while ((newline = buffer.find('\n')) == std::string::npos) {
    const ssize_t count = read(fd, chunk, sizeof(chunk));
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return std::nullopt;
    buffer.append(chunk, static_cast<std::size_t>(count));
  }
  std::string line = buffer.substr(0, newline);
  buffer.erase(0, newline + 1);
  return line;
}

void serve(const WorkerTerms& terms, int tasks, int fd) {
  limit_memory(terms.memory_mib);
  if (!terms.temporary.empty()) setenv("TMPDIR", terms.temporary.c_str(), 1);
  std::string buffer;
  while (const std::optional<std::string> line = next_line(tasks, buffer)) {
    if (line->empty()) return;
    run_draw(terms.data, terms.plan.from_line(*line), terms.timeout_s, fd, terms.recordings_unseen);
    malloc_trim(0);  // an idle worker must free memory
    // The worker writes the final message of a task after all destructors, so a task without a final message has
    // failed.
    write_all(fd, to_line({}));
  }
}

}  // namespace

DrawWorker::DrawWorker(const WorkerTerms& terms)
    : plan_(terms.plan), process_([&](int tasks, int fd) { serve(terms, tasks, fd); }, true) {}

bool DrawWorker::give(const DrawTask& task, double deadline_s) {
  if (!process_.write_text(plan_.to_line(task))) return false;
  draw_ = task;
  deadline_s_ = deadline_s;
  busy_ = true;
  ++served_;
  return true;
}

bool DrawWorker::hear(std::vector<Message>& said) {
  const bool open = process_.read_available(buffer_);
  std::size_t newline;
  while ((newline = buffer_.find('\n')) != std::string::npos) {
    const std::optional<Message> message = from_line(buffer_.substr(0, newline));
    buffer_.erase(0, newline + 1);
    if (!message) continue;
    take_up(*message);
    said.push_back(*message);
  }
  return open;
}

void DrawWorker::take_up(const Message& message) {
  if (message.outcome) {
    spoilt_ = spoilt_ || !was_scored(message.outcome->status);
    std::erase_if(draw_.runs, [&](const DrawTask::Run& run) {
      const MethodInfo& info = run.method->info;
      return info.kind == message.outcome->kind && info.name == message.outcome->method &&
             run.setting == message.outcome->setting;
    });
  } else if (message.rejected) {
    draw_.runs.clear();  // methods without a message fail
  } else if (message.is_last()) {
    busy_ = false;
  }
}

Process::End DrawWorker::dismiss() {
  if (!busy_) process_.write_text("\n");
  return process_.wait();
}

}  // namespace tumble::scenarios
