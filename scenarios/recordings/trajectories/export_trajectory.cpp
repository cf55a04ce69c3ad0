// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <span>
#include <string>

#include "scenarios/errors.hpp"
#include "scenarios/recordings/export.hpp"
#include "scenarios/recordings/number_text.hpp"
#include "scenarios/recordings/replace_file.hpp"

namespace tumble::scenarios {

namespace {

/// A reference has gaps.
bool known(const sim::Truth& truth, std::size_t i) {
  return truth.q_WB[i].coeffs().allFinite() && truth.p_WB_m[i].allFinite();
}

constexpr const char* kTumHead = "# t[s] x y z[m] qx qy qz qw: true pose of the body (centre of mass) in the world\n";

/// `first_ns`: stamp of the first of them.
void append_poses(const sim::Truth& truth, std::int64_t first_ns, std::string& text) {
  for (std::size_t i = 0; i < truth.p_WB_m.size(); ++i) {
    if (!known(truth, i)) continue;
    append_seconds(text, first_ns + static_cast<std::int64_t>(i) * truth.period_ns);
    for (const double x : truth.p_WB_m[i]) append_number(text += ' ', x);
    for (const double x : truth.q_WB[i].coeffs()) append_number(text += ' ', x);
    text += '\n';
  }
}

}  // namespace

void export_tum(const sim::Truth& truth, const std::filesystem::path& file, std::int64_t origin_ns) {
  std::string text = kTumHead;
  append_poses(truth, origin_ns, text);
  replace_file(file, text);
}

void export_tum(const StoredTruth& truth, const std::filesystem::path& file, std::int64_t origin_ns) {
  constexpr std::size_t kStretch = 4096;
  OutputFile output(file);
  std::string text = kTumHead;
  for (std::size_t first = 0; first <= truth.size(); first += kStretch) {
    const sim::Truth states = truth.states(first, std::min(first + kStretch, truth.size()));
    append_poses(states, origin_ns + static_cast<std::int64_t>(first) * truth.period_ns, text);
    output.write(std::as_bytes(std::span(text)));
    text.clear();
  }
  output.move_into_place();
}

void export_kitti(const sim::Truth& truth, const std::filesystem::path& file) {
  std::string text;
  for (std::size_t i = 0; i < truth.p_WB_m.size(); ++i) {
    if (!known(truth, i))
      throw BadInput("the reference has gaps, and KITTI's format has no time to leave them out; use tum");
    const Eigen::Matrix3d R_WB = truth.q_WB[i].toRotationMatrix();
    for (int row = 0; row < 3; ++row) {
      if (row > 0) text += ' ';
      for (int column = 0; column < 3; ++column) {
        append_number(text, R_WB(row, column));
        text += ' ';
      }
      append_number(text, truth.p_WB_m[i](row));
    }
    text += '\n';
  }
  replace_file(file, text);
}

}  // namespace tumble::scenarios
