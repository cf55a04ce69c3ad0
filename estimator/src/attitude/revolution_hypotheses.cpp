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

#include "tumble/common/types.hpp"

namespace tumble::hand_held {

namespace {

using Eigen::Vector3d;
using Vector9 = Eigen::Matrix<double, 9, 1>;
using Matrix9 = Eigen::Matrix<double, 9, 9>;

constexpr double kPi = std::numbers::pi;
// A clipped segment may have a wrong number of revolutions if its mean rate exceeds the saturation level by less than
// kBeyondSigmas standard deviations.
constexpr double kBeyondSigmas = 3.0;
// largest jerk cost of a plausible additional revolution: the square of ten standard deviations
constexpr double kRevolutionCost = 100.0;
// duration before and after a clipped segment that is optimised together with the segment
constexpr double kSurroundings_s = 0.3;
// The number of revolutions changes only at log odds above kAcceptLogOdds (odds of 20 to 1), because the cost neglects
// model errors.
constexpr double kAcceptLogOdds = 3.0;
constexpr int kExtraRevolutionsMax = 2;  // maximum number of revolutions more or less than in the optimised solution
constexpr int kRounds = 3;

/// range [first, last] of time steps (nodes) in which all readings of a sensing element are clipped or unusable
struct Segment {
  std::size_t sensing_axis = 0, first = 0, last = 0;
};

struct Hypothesis {
  std::vector<Node> nodes;
  double cost = 0.0;
};

struct RevolutionAlternatives {
  std::size_t from = 0;
  std::vector<std::pair<double, std::vector<Node>>> alternative_nodes;
};

double revolution_cost(const HandHeldProblem& problem, std::size_t steps) {
  return hand_held::revolution_cost(static_cast<double>(steps) * problem.node_interval_s(),
                                    problem.jerk_rad_s3_sqrts());
}

/// See carried.md (C28).
std::vector<Segment> possibly_wrong_segments(const HandHeldProblem& problem) {
  std::vector<Segment> out;
  const std::size_t count = problem.nodes().size();
  for (std::size_t j = 0; j < 3; ++j) {
    const Eigen::RowVector3d m = problem.sensing_directions().row(static_cast<Eigen::Index>(j));
    for (std::size_t i = 0; i < count; ++i) {
      if (!(problem.readings(i).gyro[j].clipped_reading_count > 0.0)) continue;
      Segment segment{j, i, i};
      double angle_rad = 0.0, beyond_rad_s = 0.0, clipped = 0.0;
      for (; i < count; ++i) {
        const SensingAxisSums& element = problem.readings(i).gyro[j];
        if (element.count > 0.0 && !(element.clipped_reading_count > 0.0)) break;
        if (element.clipped_reading_count > 0.0) {
          segment.last = i;
          clipped += 1.0;
          beyond_rad_s += element.saturated_side * (m.dot(problem.gyro_rad_s(i)) - element.mean_saturation_limit);
        }
        const Eigen::Matrix3d covariance = problem.covariance(i).block<3, 3>(kRate, kRate);
        angle_rad += problem.node_interval_s() * std::sqrt(std::max(0.0, m.dot(covariance * m.transpose())));
      }
      // If the recording starts or ends during a saturation, the number of revolutions in the saturation is
      // undetermined.
      if (segment.first == 0 || segment.last + 1 >= count) continue;
      const bool against_rail = beyond_rad_s < kBeyondSigmas * problem.saturation_limit_sigma_rad_s() * clipped &&
                                revolution_cost(problem, segment.last + 2 - segment.first) < kRevolutionCost;
      if (angle_rad > kAngleShare * kPi || against_rail) out.push_back(segment);
    }
  }
  return out;
}

std::vector<Node> with_extra_revolutions(const HandHeldProblem& part, const Vector3d& axis, double turns, std::size_t a,
                                         std::size_t b) {
  std::vector<Node> nodes(part.nodes().begin(), part.nodes().end());
  const double h = part.node_interval_s(), span_s = static_cast<double>(b - a) * h, mean = 2.0 * kPi * turns / span_s;
  const auto along = [&](std::size_t i) { return static_cast<double>(i - a) / static_cast<double>(b - a); };
  for (std::size_t i = a; i <= b; ++i) {
    const double phase = 2.0 * kPi * along(i);
    nodes[i].w_WI_I_rad_s += mean * (1.0 - std::cos(phase)) * axis;
    nodes[i].angular_acceleration_rad_s2 += mean * 2.0 * kPi / span_s * std::sin(phase) * axis;
  }
  for (std::size_t i = a; i < b; ++i)
    nodes[i + 1].q_WI = nodes[i].q_WI * so3::exp(rotation_between_nodes(nodes[i], nodes[i + 1], h));
  const Vector3d missed = so3::logarithm(nodes[b].q_WI.conjugate() * part.nodes()[b].q_WI);
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

std::vector<Hypothesis> hypotheses(const HandHeldProblem& whole, const Segment& segment, const ProblemSegment& part) {
  const Eigen::RowVector3d m = whole.sensing_directions().row(static_cast<Eigen::Index>(segment.sensing_axis));
  const Vector3d axis =
      whole.sensing_directions().inverse().col(static_cast<Eigen::Index>(segment.sensing_axis)).normalized();
  const std::size_t a = segment.first - 1 - part.first, b = segment.last + 1 - part.first;
  std::vector<Hypothesis> out;
  const auto keep = [&](HandHeldProblem& problem) {
    Hypothesis found{{}, problem.iterate_to_convergence()};
    found.nodes.assign(problem.nodes().begin(), problem.nodes().end());
    if (!std::isfinite(found.cost)) return false;
    for (const Hypothesis& other : out)
      if (std::abs(angle_between(other.nodes, found.nodes, m, whole.node_interval_s())) < kPi) return false;
    const bool likely = out.empty() || found.cost < out.front().cost + 2.0 * kLogOdds;
    if (!likely) return false;
    out.push_back(std::move(found));
    if (out.back().cost < out.front().cost) std::swap(out.back(), out.front());
    return true;
  };
  HandHeldProblem as_it_is(whole, part);
  if (!keep(as_it_is)) return out;
  for (const double sign : {1.0, -1.0}) {
    for (int n = 1; n <= kExtraRevolutionsMax; ++n) {
      HandHeldProblem other(whole, part);
      other.set_nodes(0, with_extra_revolutions(as_it_is, axis, sign * n, a, b));
      if (!keep(other)) break;
    }
  }
  std::erase_if(out, [&](const Hypothesis& each) { return each.cost > out.front().cost + 2.0 * kLogOdds; });
  return out;
}

/// `revolution_hypotheses` contains solutions with different numbers of revolutions, best first. `accepted_alternative`
/// is the index of the solution with the number of revolutions in the optimised problem.
struct TestedRevolutionSegment {
  std::size_t from = 0;
  std::vector<Hypothesis> revolution_hypotheses;
  std::optional<std::size_t> accepted_alternative = std::nullopt;
  bool needs_another_solution = false;
};

/// See carried.md (C29).
RevolutionAlternatives revolution_probabilities(const TestedRevolutionSegment& tested,
                                                std::optional<std::size_t> standing) {
  RevolutionAlternatives out{tested.from, {}};
  const double least = tested.revolution_hypotheses.front().cost;
  const auto weight = [&](const Hypothesis& each) { return std::exp(-0.5 * (each.cost - least)); };
  double sum = 0.0;
  for (const Hypothesis& each : tested.revolution_hypotheses) sum += weight(each);
  for (std::size_t k = 0; k < tested.revolution_hypotheses.size(); ++k) {
    if (k != standing)
      out.alternative_nodes.emplace_back(weight(tested.revolution_hypotheses[k]) / sum,
                                         tested.revolution_hypotheses[k].nodes);
  }
  return out;
}

/// Returns, for each segment, the numbers of revolutions that were not accepted. If `taken` is true, segments that need
/// another solution have accepted their most probable number of revolutions.
std::vector<RevolutionAlternatives> remaining_revolution_hypotheses(const std::vector<TestedRevolutionSegment>& tested,
                                                                    bool taken) {
  std::vector<RevolutionAlternatives> out;
  for (const TestedRevolutionSegment& each : tested) {
    const std::optional<std::size_t> standing =
        taken && each.needs_another_solution ? std::optional<std::size_t>(0) : each.accepted_alternative;
    RevolutionAlternatives open = revolution_probabilities(each, standing);
    if (!open.alternative_nodes.empty()) out.push_back(std::move(open));
  }
  return out;
}

Vector9 attitude_and_motion_difference(const Node& from, const Node& to) {
  Vector9 out;
  out << so3::logarithm(from.q_WI.conjugate() * to.q_WI), to.w_WI_I_rad_s - from.w_WI_I_rad_s,
      to.angular_acceleration_rad_s2 - from.angular_acceleration_rad_s2;
  return out;
}

std::vector<ProblemSegment> with_neighbouring_nodes(const HandHeldProblem& problem, std::span<const Segment> segments) {
  const auto around = static_cast<std::size_t>(std::llround(kSurroundings_s / problem.node_interval_s()));
  std::vector<ProblemSegment> out;
  for (const Segment& segment : segments) {
    const std::size_t from = segment.first > around ? segment.first - 1 - around : 0;
    out.push_back({from, std::min(segment.last + 1 + around, problem.nodes().size() - 1)});
  }
  return out;
}

/// `fallen` marks segments that needed another number of revolutions in an earlier round. A marked segment always gets
/// its most probable number of revolutions.
std::vector<TestedRevolutionSegment> test_revolution_segments(const HandHeldProblem& problem,
                                                              std::span<const Segment> segments,
                                                              std::span<const ProblemSegment> parts,
                                                              std::vector<bool>& fallen) {
  std::vector<TestedRevolutionSegment> out;
  for (std::size_t k = 0; k < parts.size(); ++k) {
    const ProblemSegment& part = parts[k];
    TestedRevolutionSegment tested{part.first, hypotheses(problem, segments[k], part)};
    if (tested.revolution_hypotheses.empty()) continue;
    std::sort(tested.revolution_hypotheses.begin(), tested.revolution_hypotheses.end(),
              [](const Hypothesis& a, const Hypothesis& b) { return a.cost < b.cost; });
    const std::span<const Node> before = problem.nodes().subspan(part.first, part.last - part.first + 1);
    const Eigen::RowVector3d m = problem.sensing_directions().row(static_cast<Eigen::Index>(segments[k].sensing_axis));
    for (std::size_t i = 0; i < tested.revolution_hypotheses.size() && !tested.accepted_alternative; ++i) {
      if (std::abs(angle_between(before, tested.revolution_hypotheses[i].nodes, m, problem.node_interval_s())) <= kPi)
        tested.accepted_alternative = i;
    }
    const double margin = fallen[k] ? 0.0 : 2.0 * kAcceptLogOdds;
    tested.needs_another_solution =
        !tested.accepted_alternative || tested.revolution_hypotheses[*tested.accepted_alternative].cost >
                                            tested.revolution_hypotheses.front().cost + margin;
    fallen[k] = fallen[k] || tested.needs_another_solution;
    out.push_back(std::move(tested));
  }
  return out;
}

Status solve_again(HandHeldProblem& problem, HandHeldSmoother::Report& report) {
  const Status status = problem.solve(report);
  return status.ok() ? problem.covariances(report) : status;
}

}  // namespace

double revolution_cost(double span_s, double jerk) {
  return 720.0 * std::pow(2.0 * kPi / jerk, 2.0) / std::pow(span_s, 5.0);
}

void test_revolutions(HandHeldProblem& problem, HandHeldSmoother::Report& report) {
  test_revolutions(problem, report, solve_again);
}

void test_revolutions(HandHeldProblem& problem, HandHeldSmoother::Report& report, SolveAgain again) {
  const std::vector<Segment> segments = possibly_wrong_segments(problem);
  report.revolutions_tested = static_cast<int>(segments.size());
  if (segments.empty()) return;
  std::vector<ProblemSegment> parts = with_neighbouring_nodes(problem, segments);
  std::vector<RevolutionAlternatives> open;
  std::vector<bool> fallen(parts.size(), false);
  // The test of a clipped segment linearises the motion outside this segment. A changed number of revolutions changes
  // the motion outside all other segments, so all segments are tested again.
  for (int round = 0; round < kRounds; ++round) {
    if (!problem.condense_other_nodes(parts)) break;
    const std::vector<TestedRevolutionSegment> tested = test_revolution_segments(problem, segments, parts, fallen);
    const auto taken = std::count_if(tested.begin(), tested.end(),
                                     [](const TestedRevolutionSegment& each) { return each.needs_another_solution; });
    open = remaining_revolution_hypotheses(tested, true);
    if (taken == 0) break;
    const HandHeldProblem::Solution before = problem.solution();
    const HandHeldSmoother::Report report_before = report;
    for (const TestedRevolutionSegment& each : tested) {
      if (each.needs_another_solution) problem.set_nodes(each.from, each.revolution_hypotheses.front().nodes);
    }
    if (!again(problem, report).ok()) {
      problem.restore(before);
      report = report_before;
      report.revolutions_failed += static_cast<int>(taken);
      open = remaining_revolution_hypotheses(tested, false);
      break;
    }
    report.revolutions_corrected += static_cast<int>(taken);
  }
  report.revolutions_ambiguous = static_cast<int>(open.size());
  // See carried.md (C29).
  for (const RevolutionAlternatives& segment : open) {
    for (const auto& [share, nodes] : segment.alternative_nodes) {
      for (std::size_t i = 0; i < nodes.size(); ++i) {
        const Vector9 d = attitude_and_motion_difference(problem.nodes()[segment.from + i], nodes[i]);
        problem.add_covariance(segment.from + i, share * d * d.transpose());
      }
    }
  }
}

}  // namespace tumble::hand_held
