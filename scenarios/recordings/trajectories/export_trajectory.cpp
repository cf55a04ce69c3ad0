// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "scenarios/errors.hpp"
#include "scenarios/recordings/export.hpp"
#include "scenarios/recordings/export_names.hpp"
#include "scenarios/recordings/number_text.hpp"
#include "scenarios/recordings/replace_file.hpp"
#include "scenarios/text.hpp"

namespace tumble::scenarios {

namespace {

bool known(const sim::Truth& truth, std::size_t i) {
  return truth.q_WB[i].coeffs().allFinite() && truth.p_WB_m[i].allFinite();
}

std::string tum_head(const std::string& frame) {
  return "# t[s] x y z[m] qx qy qz qw: true pose of " +
         (frame == "body" ? std::string("the body (centre of mass)") : "'" + frame + "'") + " in the world\n";
}

struct Pose {
  Eigen::Vector3d p_WA_m;
  Eigen::Quaterniond q_WA;
};

Pose pose(const sim::Truth& truth, std::size_t i, const Eigen::Isometry3d& T_BA) {
  const Eigen::Quaterniond& q_WB = truth.q_WB[i];
  return {truth.p_WB_m[i] + q_WB * T_BA.translation(), q_WB * Eigen::Quaterniond(T_BA.linear())};
}

void append_poses(const sim::Truth& truth, const Eigen::Isometry3d& T_BA, std::int64_t first_ns, std::string& text) {
  for (std::size_t i = 0; i < truth.p_WB_m.size(); ++i) {
    if (!known(truth, i)) continue;
    const Pose each = pose(truth, i, T_BA);
    append_seconds(text, first_ns + static_cast<std::int64_t>(i) * truth.period_ns);
    for (const double x : each.p_WA_m) append_number(text += ' ', x);
    for (const double x : each.q_WA.coeffs()) append_number(text += ' ', x);
    text += '\n';
  }
}

template <class Record>
std::optional<Eigen::Isometry3d> mounting_in(const std::vector<Record>& records, const GivenNames& given,
                                             Eigen::Isometry3d Record::*mounting, const std::string& frame) {
  for (std::size_t k = 0; k < records.size(); ++k)
    if (given.names[k] == frame) return records[k].*mounting;
  for (const Record& record : records)
    if (record.name == frame) return record.*mounting;
  return std::nullopt;
}

}  // namespace

Eigen::Isometry3d true_mounting(const sim::Truth& truth, const std::string& frame) {
  if (frame == "body") return Eigen::Isometry3d::Identity();
  if (frame == "centre") return Eigen::Isometry3d(Eigen::Translation3d(truth.p_BG_m));
  const ExportNames names = export_names(truth);
  if (const auto T_BI = mounting_in(truth.imus, names.imus, &sim::ImuTruth::T_BI, frame)) return *T_BI;
  if (const auto T_BL = mounting_in(truth.lidars, names.lidars, &sim::LidarTruth::T_BL, frame)) return *T_BL;
  if (const auto T_BX = mounting_in(truth.series, names.series, &sim::SeriesTruth::T_BX, frame)) return *T_BX;
  std::vector<std::string> known = {"body", "centre"};
  for (const GivenNames* given : {&names.imus, &names.lidars, &names.series})
    known.insert(known.end(), given->names.begin(), given->names.end());
  throw BadInput(
      fmt::format("the recording's truth has no frame '{}' (known frames: {})", frame, fmt::join(known, " ")));
}

void export_tum(const sim::Truth& truth, const std::filesystem::path& file, std::int64_t origin_ns,
                const std::string& frame) {
  std::string text = tum_head(frame);
  append_poses(truth, true_mounting(truth, frame), origin_ns, text);
  replace_file(file, text);
}

void export_tum(const StoredTruth& truth, const std::filesystem::path& file, std::int64_t origin_ns,
                const std::string& frame) {
  constexpr std::size_t kSegment = 4096;
  const Eigen::Isometry3d T_BA = true_mounting(truth.states(0, 0), frame);
  OutputFile output(file);
  std::string text = tum_head(frame);
  for (std::size_t first = 0; first <= truth.size(); first += kSegment) {
    const sim::Truth states = truth.states(first, std::min(first + kSegment, truth.size()));
    append_poses(states, T_BA, origin_ns + static_cast<std::int64_t>(first) * truth.period_ns, text);
    output.write(std::as_bytes(std::span(text)));
    text.clear();
  }
  output.move_into_place();
}

void export_kitti(const sim::Truth& truth, const std::filesystem::path& file, const std::string& frame) {
  const Eigen::Isometry3d T_BA = true_mounting(truth, frame);
  std::string text;
  for (std::size_t i = 0; i < truth.p_WB_m.size(); ++i) {
    if (!known(truth, i))
      throw BadInput(
          "the reference has gaps, but a KITTI file cannot represent gaps, because the format has no times; use the "
          "format tum");
    const Pose each = pose(truth, i, T_BA);
    const Eigen::Matrix3d R_WA = each.q_WA.toRotationMatrix();
    for (int row = 0; row < 3; ++row) {
      if (row > 0) text += ' ';
      for (int column = 0; column < 3; ++column) {
        append_number(text, R_WA(row, column));
        text += ' ';
      }
      append_number(text, each.p_WA_m(row));
    }
    text += '\n';
  }
  replace_file(file, text);
}

}  // namespace tumble::scenarios
