// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string>

#include "scenarios/errors.hpp"
#include "scenarios/scoring/beside_truth.hpp"
#include "scenarios/scoring/families.hpp"

/// A slip event is a time interval in which every sample has the contact label slip or the contact label slide, except
/// for short interruptions. Interruptions of a slip event are allowed because an unbalanced spinning sphere hops. In an
/// interruption, the label grip lasts at most kBridge_ns, and the labels grip and air together last at most kHop_ns. A
/// true slip event is scored if the event lasts at least kShortest_ns, and the contact speed reaches kLeastSpeed_m_s.
/// Weaker slip events cause no position error.
///
/// An estimated slip event is correct if true events, widened by kMargin_ns, cover at least half of the estimated
/// event. A true slip event is detected if correct estimated events cover at least half of the true event.
///
/// A method loses the position in a true slip event if the horizontal error grows by more than kLost_m during the
/// event. An estimate reports a lost position if its horizontal variance grows by more than kFlagged_m^2 in a slip
/// event.
namespace tumble::scenarios {

namespace {

constexpr std::int64_t kBridge_ns = 50'000'000;
constexpr std::int64_t kHop_ns = 250'000'000;
constexpr std::int64_t kShortest_ns = 50'000'000;
constexpr std::int64_t kMargin_ns = 30'000'000;
constexpr double kLeastSpeed_m_s = 0.05;
constexpr double kHalf = 0.5;
constexpr double kLost_m = 0.1, kFlagged_m = 0.03;

struct SlipSpan {
  std::int64_t begin_ns, end_ns;
};

bool moves(sim::ContactLabel label) {
  return label == sim::ContactLabel::slip || label == sim::ContactLabel::slide;
}

class Events {
 public:
  void add(sim::ContactLabel label, std::int64_t begin_ns, std::int64_t end_ns) {
    if (label == sim::ContactLabel::grip) gripped_ns_ += end_ns - begin_ns;
    if (!moves(label)) return;
    const bool goes_on = !spans_.empty() && gripped_ns_ <= kBridge_ns && begin_ns - spans_.back().end_ns <= kHop_ns;
    if (!goes_on) spans_.push_back({begin_ns, end_ns});
    spans_.back().end_ns = end_ns;
    gripped_ns_ = 0;
  }
  const std::vector<SlipSpan>& spans() const { return spans_; }

 private:
  std::vector<SlipSpan> spans_;
  std::int64_t gripped_ns_ = 0;  ///< grip since the last slip
};

std::vector<SlipSpan> true_spans(const sim::Truth& truth) {
  if (truth.label.size() != truth.q_WB.size()) {
    throw BadInput(fmt::format("the truth has {} contact labels; it must have {}, one per physics step",
                               truth.label.size(), truth.q_WB.size()));
  }
  Events events;
  for (std::size_t k = 0; k < truth.label.size(); ++k) {
    const std::int64_t begin_ns = static_cast<std::int64_t>(k) * truth.period_ns;
    events.add(truth.label[k], begin_ns, begin_ns + truth.period_ns);
  }
  return events.spans();
}

bool counts(const SlipSpan& span, const sim::Truth& truth) {
  if (span.end_ns - span.begin_ns < kShortest_ns) return false;
  const auto before = [](const sim::ContactTruth& contact, std::int64_t time_ns) { return contact.time_ns < time_ns; };
  auto contact = std::lower_bound(truth.contacts.begin(), truth.contacts.end(), span.begin_ns, before);
  for (; contact != truth.contacts.end() && contact->time_ns < span.end_ns; ++contact) {
    if (contact->slip_velocity_W_m_s.norm() >= kLeastSpeed_m_s) return true;
  }
  return false;
}

std::vector<SlipSpan> claimed_spans(const Estimate& estimate) {
  if (estimate.contacts.size() != estimate.poses.size()) {
    throw BadInput(fmt::format("the estimate has {} contact labels for {} poses; the two numbers must be equal",
                               estimate.contacts.size(), estimate.poses.size()));
  }
  Events events;
  for (std::size_t k = 0; k + 1 < estimate.contacts.size(); ++k) {
    events.add(estimate.contacts[k], estimate.poses[k].time_ns, estimate.poses[k + 1].time_ns);
  }
  return events.spans();
}

std::int64_t covered_ns(const SlipSpan& span, const std::vector<SlipSpan>& by, std::int64_t margin_ns) {
  std::int64_t sum_ns = 0, done_ns = span.begin_ns;  // widened intervals may overlap
  for (const SlipSpan& one : by) {
    const std::int64_t begin_ns = std::max(done_ns, one.begin_ns - margin_ns);
    const std::int64_t end_ns = std::min(span.end_ns, one.end_ns + margin_ns);
    if (end_ns <= begin_ns) continue;
    sum_ns += end_ns - begin_ns;
    done_ns = end_ns;
  }
  return sum_ns;
}

bool half_covered(const SlipSpan& span, const std::vector<SlipSpan>& by, std::int64_t margin_ns) {
  return static_cast<double>(covered_ns(span, by, margin_ns)) >=
         kHalf * static_cast<double>(span.end_ns - span.begin_ns);
}

struct MatchedEvents {
  std::vector<SlipSpan> events;  ///< scored true events
  std::vector<SlipSpan> claimed;
  std::vector<SlipSpan> right;  ///< correct estimated events
};

std::optional<MatchedEvents> match_events(const ScoredEstimate& scored) {
  const sim::Truth& truth = scored.truth();
  if (scored.estimate().contacts.empty() || truth.label.empty()) return std::nullopt;
  const std::vector<SlipSpan> all = true_spans(truth);
  MatchedEvents out;
  for (const SlipSpan& span : all) {
    if (counts(span, truth)) out.events.push_back(span);
  }
  out.claimed = claimed_spans(scored.estimate());
  for (const SlipSpan& span : out.claimed) {
    if (half_covered(span, all, kMargin_ns)) out.right.push_back(span);
  }
  return out;
}

bool precision(const ScoredEstimate& scored, double& value) {
  const auto& found = scored.once(match_events);
  if (!found) return false;
  value = found->claimed.empty()
              ? 1.0
              : static_cast<double>(found->right.size()) / static_cast<double>(found->claimed.size());
  return true;
}

bool recall(const ScoredEstimate& scored, double& value) {
  const auto& found = scored.once(match_events);
  if (!found || found->events.empty()) return false;
  const auto count = std::count_if(found->events.begin(), found->events.end(),
                                   [&](const SlipSpan& event) { return half_covered(event, found->right, 0); });
  value = static_cast<double>(count) / static_cast<double>(found->events.size());
  return true;
}

struct Passed {
  bool lost = false, flagged = false;
};

std::vector<Passed> passed_events(const ScoredEstimate& scored) {
  const sim::Truth& truth = scored.truth();
  std::vector<Passed> out;
  if (truth.label.empty()) return out;  // a reference has no contact labels
  const std::vector<PairedPose>& poses = paired_track(scored).poses;
  const auto pose_at = [&](std::int64_t time_ns) {
    return std::lower_bound(poses.begin(), poses.end(), time_ns,
                            [](const PairedPose& one, std::int64_t at) { return one.time_ns < at; });
  };
  const auto variance_m2 = [](const PairedPose& pose) {
    return pose.estimate.covariance(0, 0) + pose.estimate.covariance(1, 1);
  };
  const auto error_m = [](const PairedPose& pose) -> Eigen::Vector2d {
    return (pose.estimate.position_W_m - pose.truth.position_W_m).head<2>();
  };
  for (const SlipSpan& span : true_spans(truth)) {
    if (!counts(span, truth)) continue;
    const auto before = pose_at(span.begin_ns - kMargin_ns), after = pose_at(span.end_ns + kMargin_ns);
    if (after == poses.end() || !(variance_m2(*after) > 0.0)) continue;
    Passed passed;
    passed.lost = !((error_m(*after) - error_m(*before)).norm() <= kLost_m);  // NaN counts as lost
    passed.flagged = variance_m2(*after) - variance_m2(*before) > kFlagged_m * kFlagged_m;
    out.push_back(passed);
  }
  return out;
}

bool flag_recall(const ScoredEstimate& scored, double& value) {
  const std::vector<Passed>& events = scored.once(passed_events);
  const auto lost = std::count_if(events.begin(), events.end(), [](const Passed& one) { return one.lost; });
  if (lost == 0) return false;
  const auto both =
      std::count_if(events.begin(), events.end(), [](const Passed& one) { return one.lost && one.flagged; });
  value = static_cast<double>(both) / static_cast<double>(lost);
  return true;
}

bool flagged_share(const ScoredEstimate& scored, double& value) {
  const std::vector<Passed>& events = scored.once(passed_events);
  if (events.empty()) return false;
  const auto flagged = std::count_if(events.begin(), events.end(), [](const Passed& one) { return one.flagged; });
  value = static_cast<double>(flagged) / static_cast<double>(events.size());
  return true;
}

}  // namespace

std::vector<Metric> slip_metrics() {
  return {
      {{"slip_precision", Unit::share,
        "share of the reported slip and slide events that are true; 1 if the method reports no event", Sense::higher,
        Place::held, kNoTarget, Compared::by_difference},
       Kind::position,
       precision},
      {{"slip_recall", Unit::share, "share of the true slip events that the method detects", Sense::higher, Place::held,
        kNoTarget, Compared::by_difference},
       Kind::position,
       recall},
      {{"slip_flag_recall", Unit::share,
        "share of the true slip and slide events in which the reported horizontal variance grows by more than 0.0009 "
        "m^2. Only events that change the horizontal position error by more than 0.1 m count",
        Sense::higher, Place::detail, kNoTarget, Compared::by_difference},
       Kind::position,
       flag_recall},
      {{"slip_flagged_share", Unit::share,
        "share of the true slip and slide events in which the reported horizontal variance grows by more than 0.0009 "
        "m^2",
        Sense::none},
       Kind::position,
       flagged_share},
  };
}

}  // namespace tumble::scenarios
