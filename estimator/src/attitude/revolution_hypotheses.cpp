// SPDX-License-Identifier: BSD-3-Clause
#include "revolution_hypotheses.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "tumble/common/so3.hpp"

namespace tumble::hand_held {

namespace {

using Eigen::Vector3d;
using Vector9 = Eigen::Matrix<double, 9, 1>;
using Matrix9 = Eigen::Matrix<double, 9, 9>;

constexpr double kPi = std::numbers::pi;
constexpr double kBeyondSigmas = 3.0;      // a segment is tested if its mean rate is this close to the level
constexpr double kRevolutionCost = 100.0;  // limit of a revolution's jerk cost: ten standard deviations
constexpr double kSurroundings_s = 0.3;    // duration before and after a segment that is solved with the segment
constexpr double kAcceptLogOdds = 3.0;     // log odds (20 to 1) for a change; the cost excludes model errors
constexpr int kExtraRevolutionsMax = 2;    // maximum number of revolutions more or less than in the optimised solution
constexpr int kRounds = 3;

/// range of nodes [first, last] in which all readings of a sensing element are clipped or unusable
struct Segment {
  std::size_t element = 0, first = 0, last = 0;
};

struct Hypothesis {
  std::vector<Node> nodes;
  double cost = 0.0;
};

struct AlternativeSolutions {
  std::size_t from = 0;
  std::vector<std::pair<double, std::vector<Node>>> others;
};

/// Returns the cost of the angular jerk that one additional revolution within `steps` node intervals requires.
double revolution_cost(const Problem& problem, std::size_t steps) {
  return hand_held::revolution_cost(static_cast<double>(steps) * problem.node_s(), problem.jerk_rad_s3_sqrts());
}

/// See carried.md (C28).
std::vector<Segment> suspect_segments(const Problem& problem) {
  std::vector<Segment> out;
  const std::size_t count = problem.nodes().size();
  for (std::size_t j = 0; j < 3; ++j) {
    const Eigen::RowVector3d m = problem.rows().row(static_cast<Eigen::Index>(j));
    for (std::size_t i = 0; i < count; ++i) {
      if (!(problem.readings(i).gyro[j].clipped > 0.0)) continue;
      Segment segment{j, i, i};
      double angle_rad = 0.0, beyond_rad_s = 0.0, clipped = 0.0;
      for (; i < count; ++i) {
        const ElementSums& element = problem.readings(i).gyro[j];
        if (element.count > 0.0 && !(element.clipped > 0.0)) break;
        if (element.clipped > 0.0) {
          segment.last = i;
          clipped += 1.0;
          beyond_rad_s += element.sign * (m.dot(problem.gyro_rad_s(i)) - element.rail);
        }
        const Eigen::Matrix3d covariance = problem.covariance(i).block<3, 3>(kRate, kRate);
        angle_rad += problem.node_s() * std::sqrt(std::max(0.0, m.dot(covariance * m.transpose())));
      }
      // If the recording starts or ends during a saturation, the number of revolutions is undetermined.
      if (segment.first == 0 || segment.last + 1 >= count) continue;
      const bool against_rail = beyond_rad_s < kBeyondSigmas * problem.rail_sigma_rad_s() * clipped &&
                                revolution_cost(problem, segment.last + 2 - segment.first) < kRevolutionCost;
      if (angle_rad > kAngleShare * kPi || against_rail) out.push_back(segment);
    }
  }
  return out;
}

/// Adds `turns` revolutions about `axis` between nodes a and b as a smooth bump of the rate.
std::vector<Node> with_more_revolutions(const Problem& part, const Vector3d& axis, double turns, std::size_t a,
                                        std::size_t b) {
  std::vector<Node> nodes(part.nodes().begin(), part.nodes().end());
  const double h = part.node_s(), span_s = static_cast<double>(b - a) * h, mean = 2.0 * kPi * turns / span_s;
  const auto along = [&](std::size_t i) { return static_cast<double>(i - a) / static_cast<double>(b - a); };
  for (std::size_t i = a; i <= b; ++i) {
    const double phase = 2.0 * kPi * along(i);
    nodes[i].w_WI_I_rad_s += mean * (1.0 - std::cos(phase)) * axis;
    nodes[i].angular_acceleration_rad_s2 += mean * 2.0 * kPi / span_s * std::sin(phase) * axis;
  }
  for (std::size_t i = a; i < b; ++i) nodes[i + 1].q_WI = nodes[i].q_WI * so3::exp(turned(nodes[i], nodes[i + 1], h));
  const Vector3d missed = so3::log(nodes[b].q_WI.conjugate() * part.nodes()[b].q_WI);
  const Vector3d& g_W = part.gravity_W_m_s2();
  for (std::size_t i = a; i <= b; ++i) {
    nodes[i].q_WI = (nodes[i].q_WI * so3::exp(along(i) * missed)).normalized();
    const Node& before = part.nodes()[i];
    nodes[i].a_W_m_s2 = nodes[i].q_WI * (before.q_WI.conjugate() * (before.a_W_m_s2 - g_W)) + g_W;
  }
  return nodes;
}

double angle_between(std::span<const Node> from, std::span<const Node> to, const Eigen::RowVector3d& m, double h) {
  double out = 0.0;
  for (std::size_t i = 0; i < from.size(); ++i) out += h * m.dot(to[i].w_WI_I_rad_s - from[i].w_WI_I_rad_s);
  return out;
}

std::vector<Hypothesis> hypotheses(const Problem& whole, const Segment& segment, const Part& part) {
  const Eigen::RowVector3d m = whole.rows().row(static_cast<Eigen::Index>(segment.element));
  const Vector3d axis = whole.rows().inverse().col(static_cast<Eigen::Index>(segment.element)).normalized();
  const std::size_t a = segment.first - 1 - part.first, b = segment.last + 1 - part.first;
  std::vector<Hypothesis> out;
  const auto keep = [&](Problem& problem) {
    Hypothesis found{{}, problem.converge()};
    found.nodes.assign(problem.nodes().begin(), problem.nodes().end());
    if (!std::isfinite(found.cost)) return false;
    for (const Hypothesis& other : out)
      if (std::abs(angle_between(other.nodes, found.nodes, m, whole.node_s())) < kPi) return false;
    const bool likely = out.empty() || found.cost < out.front().cost + 2.0 * kLogOdds;
    if (!likely) return false;
    out.push_back(std::move(found));
    if (out.back().cost < out.front().cost) std::swap(out.back(), out.front());
    return true;
  };
  Problem as_it_is(whole, part);
  if (!keep(as_it_is)) return out;
  for (const double sign : {1.0, -1.0}) {
    for (int n = 1; n <= kExtraRevolutionsMax; ++n) {
      Problem other(whole, part);
      other.place(0, with_more_revolutions(as_it_is, axis, sign * n, a, b));
      if (!keep(other)) break;
    }
  }
  std::erase_if(out, [&](const Hypothesis& each) { return each.cost > out.front().cost + 2.0 * kLogOdds; });
  return out;
}

/// `found` contains solutions with different numbers of revolutions, best first. `held` is the index of the solution
/// with the present number of revolutions.
struct TestedSegment {
  std::size_t from = 0;
  std::vector<Hypothesis> found;
  std::optional<std::size_t> held = std::nullopt;
  bool another = false;
};

/// See carried.md (C29).
AlternativeSolutions alternative_probabilities(const TestedSegment& tested, std::optional<std::size_t> standing) {
  AlternativeSolutions out{tested.from, {}};
  const double least = tested.found.front().cost;
  const auto weight = [&](const Hypothesis& each) { return std::exp(-0.5 * (each.cost - least)); };
  double sum = 0.0;
  for (const Hypothesis& each : tested.found) sum += weight(each);
  for (std::size_t k = 0; k < tested.found.size(); ++k) {
    if (k != standing) out.others.emplace_back(weight(tested.found[k]) / sum, tested.found[k].nodes);
  }
  return out;
}

/// `taken` is true if each segment now has its most probable number of revolutions.
std::vector<AlternativeSolutions> remaining_alternatives(const std::vector<TestedSegment>& tested, bool taken) {
  std::vector<AlternativeSolutions> out;
  for (const TestedSegment& each : tested) {
    const std::optional<std::size_t> standing = taken && each.another ? std::optional<std::size_t>(0) : each.held;
    AlternativeSolutions open = alternative_probabilities(each, standing);
    if (!open.others.empty()) out.push_back(std::move(open));
  }
  return out;
}

Vector9 apart(const Node& from, const Node& to) {
  Vector9 out;
  out << so3::log(from.q_WI.conjugate() * to.q_WI), to.w_WI_I_rad_s - from.w_WI_I_rad_s,
      to.angular_acceleration_rad_s2 - from.angular_acceleration_rad_s2;
  return out;
}

std::vector<Part> with_surroundings(const Problem& problem, std::span<const Segment> segments) {
  const auto around = static_cast<std::size_t>(std::llround(kSurroundings_s / problem.node_s()));
  std::vector<Part> out;
  for (const Segment& segment : segments) {
    const std::size_t from = segment.first > around ? segment.first - 1 - around : 0;
    out.push_back({from, std::min(segment.last + 1 + around, problem.nodes().size() - 1)});
  }
  return out;
}

/// `fallen` marks segments whose number of revolutions an earlier round has changed.
std::vector<TestedSegment> test_segments(const Problem& problem, std::span<const Segment> segments,
                                         std::span<const Part> parts, std::vector<bool>& fallen) {
  std::vector<TestedSegment> out;
  for (std::size_t k = 0; k < parts.size(); ++k) {
    const Part& part = parts[k];
    TestedSegment tested{part.first, hypotheses(problem, segments[k], part)};
    if (tested.found.empty()) continue;
    std::sort(tested.found.begin(), tested.found.end(),
              [](const Hypothesis& a, const Hypothesis& b) { return a.cost < b.cost; });
    const std::span<const Node> before = problem.nodes().subspan(part.first, part.last - part.first + 1);
    const Eigen::RowVector3d m = problem.rows().row(static_cast<Eigen::Index>(segments[k].element));
    for (std::size_t i = 0; i < tested.found.size() && !tested.held; ++i) {
      if (std::abs(angle_between(before, tested.found[i].nodes, m, problem.node_s())) <= kPi) tested.held = i;
    }
    const double margin = fallen[k] ? 0.0 : 2.0 * kAcceptLogOdds;
    tested.another = !tested.held || tested.found[*tested.held].cost > tested.found.front().cost + margin;
    fallen[k] = fallen[k] || tested.another;
    out.push_back(std::move(tested));
  }
  return out;
}

Status solve_again(Problem& problem, HandHeldSmoother::Report& report) {
  const Status status = problem.solve(report);
  return status.ok() ? problem.covariances(report) : status;
}

}  // namespace

double revolution_cost(double span_s, double jerk) {
  return 720.0 * std::pow(2.0 * kPi / jerk, 2.0) / std::pow(span_s, 5.0);
}

void test_revolutions(Problem& problem, HandHeldSmoother::Report& report) {
  test_revolutions(problem, report, solve_again);
}

void test_revolutions(Problem& problem, HandHeldSmoother::Report& report, SolveAgain again) {
  const std::vector<Segment> segments = suspect_segments(problem);
  report.revolutions_tested = static_cast<int>(segments.size());
  if (segments.empty()) return;
  std::vector<Part> parts = with_surroundings(problem, segments);
  std::vector<AlternativeSolutions> open;
  std::vector<bool> fallen(parts.size(), false);
  // The test of one clipped segment linearises the motion outside the segment. After a change of any number of
  // revolutions, all segments are therefore tested again.
  for (int round = 0; round < kRounds; ++round) {
    if (!problem.condense_rest(parts)) break;
    const std::vector<TestedSegment> tested = test_segments(problem, segments, parts, fallen);
    const auto taken =
        std::count_if(tested.begin(), tested.end(), [](const TestedSegment& each) { return each.another; });
    open = remaining_alternatives(tested, true);  // replaces the alternatives of the previous round
    if (taken == 0) break;
    const Problem::Answer before = problem.answer();
    const HandHeldSmoother::Report report_before = report;
    for (const TestedSegment& each : tested) {
      if (each.another) problem.place(each.from, each.found.front().nodes);
    }
    if (!again(problem, report).ok()) {
      problem.restore(before);
      report = report_before;
      report.revolutions_failed += static_cast<int>(taken);
      open = remaining_alternatives(tested, false);
      break;
    }
    report.revolutions_corrected += static_cast<int>(taken);
  }
  report.revolutions_ambiguous = static_cast<int>(open.size());
  // See carried.md (C29).
  for (const AlternativeSolutions& segment : open) {
    for (const auto& [share, nodes] : segment.others) {
      for (std::size_t i = 0; i < nodes.size(); ++i) {
        const Vector9 d = apart(problem.nodes()[segment.from + i], nodes[i]);
        problem.widen(segment.from + i, share * d * d.transpose());
      }
    }
  }
}

}  // namespace tumble::hand_held
