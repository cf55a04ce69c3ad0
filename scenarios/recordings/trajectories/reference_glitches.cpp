// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/recordings/trajectories/reference_glitches.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "scenarios/recordings/clouds/sweep_stamps.hpp"

namespace tumble::scenarios {

namespace {

constexpr double kLeap_rad_s = 10.0;
constexpr std::size_t kNear = 3, kFar = 6;  // steps
constexpr std::size_t kMargin = 3;          // samples
constexpr std::int64_t kPair_ns = 500'000'000;
constexpr double kThaw_rad = 0.02, kCatchUp = 1.5;

double rotation_rad(const ReferencePose& a, const ReferencePose& b) {
  const Eigen::Quaterniond q = a.q_WA.conjugate() * b.q_WA;
  return 2.0 * std::atan2(q.vec().norm(), std::abs(q.w()));
}

std::vector<double> step_rates_rad_s(const std::vector<ReferencePose>& poses) {
  std::vector<double> rates;
  for (std::size_t k = 0; k + 1 < poses.size(); ++k) {
    const double step_s = 1e-9 * static_cast<double>(poses[k + 1].time_ns - poses[k].time_ns);
    rates.push_back(rotation_rad(poses[k], poses[k + 1]) / step_s);
  }
  return rates;
}

/// Returns the lower median of up to four step rates on one side; 0 (rest) if there are none at an end of the
/// recording.
double side_rad_s(const std::vector<double>& rates, std::ptrdiff_t k, std::ptrdiff_t direction) {
  std::vector<double> side;
  for (auto i = static_cast<std::ptrdiff_t>(kNear); i <= static_cast<std::ptrdiff_t>(kFar); ++i) {
    const std::ptrdiff_t at = k + direction * i;
    if (at >= 0 && at < static_cast<std::ptrdiff_t>(rates.size())) side.push_back(rates[static_cast<std::size_t>(at)]);
  }
  if (side.empty()) return 0.0;
  const auto middle = side.begin() + static_cast<std::ptrdiff_t>((side.size() - 1) / 2);
  std::nth_element(side.begin(), middle, side.end());
  return *middle;
}

/// Returns the first and the last step of each jump of the attitude.
std::vector<std::array<std::size_t, 2>> find_leaps(const std::vector<double>& rates, double& fastest_rad_s) {
  std::vector<std::array<std::size_t, 2>> leaps;
  for (std::size_t k = 0; k < rates.size(); ++k) {
    const auto at = static_cast<std::ptrdiff_t>(k);
    if (!(rates[k] > std::max(side_rad_s(rates, at, -1), side_rad_s(rates, at, 1)) + kLeap_rad_s)) continue;
    fastest_rad_s = std::max(fastest_rad_s, rates[k]);
    if (!leaps.empty() && k <= leaps.back()[1] + kNear)
      leaps.back()[1] = k;
    else
      leaps.push_back({k, k});
  }
  return leaps;
}

void leave_out(std::vector<ReferencePose>& poses, const std::vector<bool>& out) {
  std::vector<ReferencePose> kept;
  for (std::size_t k = 0; k < poses.size(); ++k) {
    if (!out[k]) kept.push_back(poses[k]);
  }
  poses = std::move(kept);
}

void leave_out_unsound(std::vector<ReferencePose>& poses, GlitchReport& report) {
  std::vector<bool> out(poses.size());
  for (std::size_t k = 0; k < poses.size(); ++k) {
    const double norm = poses[k].q_WA.norm();
    const bool finite = std::isfinite(norm), sound = finite && std::abs(norm - 1.0) <= kReferenceNormTolerance;
    out[k] = !sound;
    report.unknown += finite ? 0 : 1;
    report.bad_norm += finite && !sound ? 1 : 0;
    if (sound) poses[k].q_WA.normalize();
  }
  leave_out(poses, out);
}

void exclude_frozen(std::vector<ReferencePose>& poses, GlitchReport& report) {
  std::vector<bool> out(poses.size());
  for (std::size_t first = 0; first < poses.size();) {
    std::size_t last = first;
    while (last + 1 < poses.size() && poses[last + 1].q_WA.coeffs() == poses[first].q_WA.coeffs()) ++last;
    // At rest, rounded attitudes may repeat without a later jump.
    const bool thaws = last > first && last + 2 < poses.size();
    const double thaw_rad = thaws ? rotation_rad(poses[last], poses[last + 1]) : 0.0;
    if (thaws && thaw_rad > kThaw_rad && thaw_rad > kCatchUp * rotation_rad(poses[last + 1], poses[last + 2])) {
      std::fill(out.begin() + static_cast<std::ptrdiff_t>(first + 1),
                out.begin() + static_cast<std::ptrdiff_t>(last + 1), true);
      report.frozen += last - first;
    }
    first = last + 1;
  }
  leave_out(poses, out);
}

void leave_out_leaps(std::vector<ReferencePose>& poses, GlitchReport& report) {
  const auto leaps = find_leaps(step_rates_rad_s(poses), report.fastest_leap_rad_s);
  report.leaps = leaps.size();
  std::vector<bool> out(poses.size());
  const auto drop = [&](std::size_t first, std::size_t last) {
    for (std::size_t k = first > kMargin ? first - kMargin : 0; k <= std::min(last + kMargin, poses.size() - 1); ++k)
      out[k] = true;
  };
  bool away = false;  // between a jump and its return
  for (std::size_t i = 0; i < leaps.size(); ++i) {
    drop(leaps[i][0], leaps[i][1] + 1);
    const bool near = i > 0 && poses[leaps[i][0]].time_ns - poses[leaps[i - 1][1]].time_ns < kPair_ns;
    if (near && away) drop(leaps[i - 1][1], leaps[i][0]);
    away = !(near && away);
  }
  report.leapt = static_cast<std::size_t>(std::count(out.begin(), out.end(), true));
  leave_out(poses, out);
}

}  // namespace

GlitchReport leave_out_glitches(std::vector<ReferencePose>& poses) {
  GlitchReport report;
  std::vector<std::int64_t> times;
  for (const ReferencePose& pose : poses) times.push_back(pose.time_ns);
  const std::int64_t step_ns = median_step_ns(times);
  leave_out_unsound(poses, report);
  exclude_frozen(poses, report);
  leave_out_leaps(poses, report);
  for (std::size_t k = 1; k < poses.size(); ++k) {
    if (2 * (poses[k].time_ns - poses[k - 1].time_ns) > 5 * step_ns) ++report.gaps;
  }
  return report;
}

std::string GlitchReport::text(std::size_t samples) const {
  const std::size_t left_out = unknown + bad_norm + frozen + leapt;
  std::string out = fmt::format("reference: {} of {} samples are left out", left_out, samples);
  if (leaps > 0)
    out += fmt::format(
        ", {} because they are within or between {} jumps of up to {:.0f} rad/s, which cannot be real motion", leapt,
        leaps, fastest_leap_rad_s);
  if (bad_norm > 0)
    out += fmt::format(", {} because the norm of the quaternion differs from 1 by more than 1 %", bad_norm);
  if (frozen > 0) out += fmt::format(", {} because the reference was frozen while the body moved", frozen);
  if (unknown > 0) out += fmt::format(", {} unknown", unknown);
  if (gaps > 0) out += fmt::format("; the reference has {} gaps without data", gaps);
  return out;
}

}  // namespace tumble::scenarios
