// SPDX-License-Identifier: BSD-3-Clause
#include "tools/tumble/progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace tumble::tools {

namespace {

constexpr double kLinePeriodS = 10.0;
constexpr int kBarWidth = 24;

std::string failures_text(const scenarios::SweepProgress& progress) {
  std::string text;
  for (const auto& [status, count] : progress.failures)
    text += fmt::format("{}{} {}", text.empty() ? " (" : ", ", count, to_string(status));
  return text.empty() ? text : text + ")";
}

std::string bar_text(double share, int width) {
  if (width <= 0) return "";
  const int filled = std::clamp(static_cast<int>(share * width), 0, width);
  return "[" + std::string(static_cast<std::size_t>(filled), '#') +
         std::string(static_cast<std::size_t>(width - filled), '-') + "]  ";
}

}  // namespace

std::string duration_text(double seconds) {
  if (!(seconds >= 0.0) || !std::isfinite(seconds)) return "?";
  const long whole = std::lround(seconds);
  if (whole < 60) return fmt::format("{} s", whole);
  if (whole < 3600) return fmt::format("{} min {:02} s", whole / 60, whole % 60);
  return fmt::format("{} h {:02} min", whole / 3600, whole % 3600 / 60);
}

std::string progress_line(const scenarios::SweepProgress& p, int bar_width) {
  const double share =
      p.draws_total == 0 ? 1.0 : static_cast<double>(p.draws_done) / static_cast<double>(p.draws_total);
  std::string line = bar_text(share, bar_width);
  line +=
      fmt::format("{}/{} simulated runs  {} %  {} method runs, {} not ok{}  {} simulations rejected", p.draws_done,
                  p.draws_total, static_cast<int>(share * 100.0), p.outcomes, p.not_ok(), failures_text(p), p.rejected);
  if (p.to_keep > 0) line += fmt::format("  kept {}/{}", p.kept, p.to_keep);
  if (p.draws_done < p.draws_total) {
    line += "  left " + (p.draws_done == 0 ? "?" : duration_text(p.left_s));
  } else {
    line += "  in " + duration_text(p.elapsed_s);
  }
  return line;
}

std::string progress_line(const RegistrationProgress& p, int bar_width) {
  const double share = p.all == 0 ? 1.0 : static_cast<double>(p.done) / static_cast<double>(p.all);
  const double per_s = p.elapsed_s > 0.0 ? static_cast<double>(p.done) / p.elapsed_s : 0.0;
  return bar_text(share, bar_width) + fmt::format("{}/{} lidar sweeps  {:.0f} sweeps/s", p.done, p.all, per_s);
}

std::string progress_line(const SearchProgress& p, int bar_width) {
  const double share = p.budget == 0 ? 1.0 : static_cast<double>(p.runs) / static_cast<double>(p.budget);
  return bar_text(share, bar_width) +
         fmt::format("{}/{} runs  {} failures  in {}", p.runs, p.budget, p.failures, duration_text(p.elapsed_s));
}

ProgressDisplay::ProgressDisplay(Write write, bool terminal) : write_(std::move(write)), terminal_(terminal) {}

ProgressDisplay ProgressDisplay::on_standard_error() {
  const auto write = [](std::string_view text) {
    std::fwrite(text.data(), 1, text.size(), stderr);
    std::fflush(stderr);
  };
  return {write, isatty(STDERR_FILENO) == 1};
}

template <class Progress>
void ProgressDisplay::show_line(const Progress& progress, double elapsed_s) {
  if (terminal_) {
    write_("\r" + progress_line(progress, kBarWidth) + "\x1b[K");
  } else if (elapsed_s - shown_at_s_ >= kLinePeriodS) {
    shown_at_s_ = elapsed_s;
    write_(progress_line(progress, 0) + "\n");
  }
}

template <class Progress>
void ProgressDisplay::finish_line(const Progress& progress) {
  write_(terminal_ ? "\r" + progress_line(progress, kBarWidth) + "\x1b[K\n" : progress_line(progress, 0) + "\n");
}

template void ProgressDisplay::show_line(const scenarios::SweepProgress&, double);
template void ProgressDisplay::show_line(const RegistrationProgress&, double);
template void ProgressDisplay::show_line(const SearchProgress&, double);
template void ProgressDisplay::finish_line(const scenarios::SweepProgress&);
template void ProgressDisplay::finish_line(const RegistrationProgress&);
template void ProgressDisplay::finish_line(const SearchProgress&);

}  // namespace tumble::tools
