// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/recordings/clouds/sweep_builder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>
#include <span>

#include "scenarios/errors.hpp"
#include "scenarios/recordings/clouds/sweep_stamps.hpp"

namespace tumble::scenarios {

namespace {

/// Number of clouds that determine the time unit; a single cloud may be incomplete.
constexpr std::ptrdiff_t kProbe = 10;
constexpr double kByteIntensity = 255.0;
constexpr double kPointFar_m = 1e6;
constexpr double kBeyond = 2.0;        // multiple of the data sheet's range
constexpr double kFarthest_m = 500.0;  // default limit without a data sheet: beyond the range of robot lidars
constexpr double kOverlapMost = 1.05;  // longest sweep relative to the time between sweeps
/// Longest point offset while the period is unknown.
constexpr std::int64_t kOffsetMax_ns = 1000000000;

constexpr std::array<const char*, 3> kRingNames = {"ring", "line", "channel"};
constexpr std::array<const char*, 3> kIntensityNames = {"intensity", "Intensity", "reflectivity"};

const std::vector<double>& coordinate(const Cloud& cloud, const char* name, const std::string& where) {
  const std::vector<double>* found = cloud.find(name);
  if (found != nullptr) return *found;
  std::string all;
  for (const std::string& each : cloud.names) all += " " + each;
  throw BadInput(fmt::format("{}: there is no field '{}' (existing fields:{})", where, name, all));
}

template <std::size_t kCount>
const std::vector<double>* first_of(const Cloud& cloud, const std::array<const char*, kCount>& names) {
  for (const char* name : names) {
    if (const std::vector<double>* found = cloud.find(name)) return found;
  }
  return nullptr;
}

/// Returns the indices of valid points.
std::vector<std::size_t> hits(const Cloud& cloud, const std::string& where) {
  const std::vector<double>&x = coordinate(cloud, "x", where), &y = coordinate(cloud, "y", where),
        &z = coordinate(cloud, "z", where);
  std::vector<std::size_t> kept;
  for (std::size_t i = 0; i < cloud.points; ++i) {
    const bool within = std::abs(x[i]) <= kPointFar_m && std::abs(y[i]) <= kPointFar_m && std::abs(z[i]) <= kPointFar_m;
    if (within && (x[i] != 0.0 || y[i] != 0.0 || z[i] != 0.0)) kept.push_back(i);
  }
  return kept;
}

std::string in_ns(std::int64_t time_ns) {
  return std::to_string(time_ns) + " ns";
}

/// Describes how point times were read.
std::string said(const PointTimeRule& rule) {
  const char* unit = rule.unit_ns == 1e9 ? "s" : rule.unit_ns == 1e6 ? "ms" : rule.unit_ns == 1e3 ? "us" : "ns";
  return fmt::format("point times: field '{}', in {}{}", rule.field, unit,
                     rule.absolute ? " of the clock" : " after the sweep's time stamp");
}

/// Converts the field's numbers to whole nanoseconds.
std::vector<std::int64_t> whole_times(const std::vector<double>& numbers, const std::vector<std::size_t>& kept,
                                      double unit_ns, const std::string& where) {
  constexpr double kBound = 9.2e18;
  std::vector<std::int64_t> times;
  for (const std::size_t i : kept) {
    const double time = numbers[i] * unit_ns;
    if (!(std::abs(time) < kBound)) {
      throw BadInput(fmt::format("{}: point {}: the time is {}, must be finite and within 292 years", where, i,
                                 std::to_string(numbers[i])));
    }
    times.push_back(std::llround(time));
  }
  return times;
}

}  // namespace

void SweepBuilder::add(std::optional<std::int64_t> stamp_ns, Cloud cloud, std::string where) {
  Waiting sweep{stamp_ns, std::move(cloud), std::move(where)};
  if (rule_) return take(sweep);
  waiting_.push_back(std::move(sweep));
  const auto holds_points = [](const Waiting& each) { return each.cloud.points > 0; };
  if (std::count_if(waiting_.begin(), waiting_.end(), holds_points) >= kProbe) find_rule();
}

void SweepBuilder::find_rule() {
  std::vector<Cloud> first;
  for (Waiting& sweep : waiting_) first.push_back(std::move(sweep.cloud));
  rule_ = find_point_times(first, period_ns_, reading_, waiting_.front().where);
  if (rule_->field.empty()) {
    record_.point_times = reading_.not_skewed ? sim::PointTimes::not_skewed : sim::PointTimes::unknown;
  }
  for (std::size_t k = 0; k < waiting_.size(); ++k) {
    waiting_[k].cloud = std::move(first[k]);
    take(waiting_[k]);
  }
  waiting_.clear();
}

void SweepBuilder::take(Waiting& sweep) {
  if (reading_.assumed && rule_->absolute) sweep.stamp_ns.reset();
  const std::vector<std::size_t> kept =
      sweep.cloud.points > 0 ? hits(sweep.cloud, sweep.where) : std::vector<std::size_t>{};
  misses_ += sweep.cloud.points - kept.size();
  if (!sweep.cloud.viewpoint.empty() && viewpoints_++ == 0)
    first_viewpoint_ = sweep.where + ": " + sweep.cloud.viewpoint;
  if (kept.empty() && !sweep.stamp_ns) {
    ++skipped_;
    return;
  }
  const std::int64_t start_ns = take_times(sweep, kept);
  std::vector<std::int64_t>& starts = record_.sweep_start_ns;
  if (!starts.empty() && start_ns <= starts.back()) {
    throw BadInput(fmt::format("{}: the sweep starts at {}; it must start after the previous sweep, which starts at {}",
                               sweep.where, in_ns(start_ns), in_ns(starts.back())));
  }
  starts.push_back(start_ns);
  const auto offsets = std::span(record_.offset_ns).last(kept.size());
  last_point_ns_.push_back(start_ns + (kept.empty() ? 0 : *std::max_element(offsets.begin(), offsets.end())));
  record_.sweep_first.push_back(points());
  take_points(sweep, kept);
  take_rings(sweep, kept);
  if (store_) store_->take(record_);
}

/// Returns the start of the sweep; stores the time offsets of the points from this start.
std::int64_t SweepBuilder::take_times(const Waiting& sweep, const std::vector<std::size_t>& kept) {
  const auto no_offsets = [&] { record_.offset_ns.resize(record_.offset_ns.size() + kept.size(), 0); };
  if (rule_->field.empty() || kept.empty()) {
    if (!sweep.stamp_ns) throw BadInput(sweep.where + ": neither the sweep nor its points have a time stamp");
    no_offsets();
    return *sweep.stamp_ns;
  }
  const std::vector<double>* numbers = sweep.cloud.find(rule_->field);
  if (numbers == nullptr)
    throw BadInput(fmt::format("{}: there is no field '{}', which other sweeps have", sweep.where, rule_->field));
  std::vector<std::int64_t> times = whole_times(*numbers, kept, rule_->unit_ns, sweep.where);
  if (!rule_->absolute) {
    if (!sweep.stamp_ns)
      throw BadInput(sweep.where + ": its point times are relative, but the sweep has no time stamp");
    for (std::int64_t& time : times) time += *sweep.stamp_ns;
  }
  const std::int64_t first = *std::min_element(times.begin(), times.end());
  const std::int64_t bound = period_ns_ > 0 ? 2 * period_ns_ : kOffsetMax_ns;
  std::int64_t start = sweep.stamp_ns.value_or(first);
  if (start - first > bound || first - start > bound) {
    throw BadInput(
        fmt::format("{}: its first point is at {}, but its time stamp is {}; the difference must be at most {}. Check "
                    "the clock and the unit",
                    sweep.where, in_ns(first), in_ns(start), in_ns(bound)));
  }
  if (start > first || first - start >= bound / 2) start = first;
  for (std::size_t k = 0; k < times.size(); ++k) {
    const std::int64_t offset = times[k] - start;
    if (offset > bound || offset > std::numeric_limits<std::uint32_t>::max()) {
      throw BadInput(fmt::format("{}: point {} is {} after the start of the sweep; this must be at most {}",
                                 sweep.where, kept[k], in_ns(offset), in_ns(bound)));
    }
    record_.offset_ns.push_back(static_cast<std::uint32_t>(offset));
    longest_ns_ = std::max(longest_ns_, offset);
  }
  return start;
}

void SweepBuilder::take_points(const Waiting& sweep, const std::vector<std::size_t>& kept) {
  if (kept.empty()) return;
  const Cloud& cloud = sweep.cloud;
  const std::vector<double>&x = *cloud.find("x"), &y = *cloud.find("y"), &z = *cloud.find("z");
  const std::vector<double>* intensity = first_of(cloud, kIntensityNames);
  for (const std::size_t i : kept) {
    const Eigen::Vector3d position(x[i], y[i], z[i]);
    record_.position_L_m.push_back(position.cast<float>());
    record_.range_m.push_back(record_.position_L_m.back().norm());
    if (record_.range_m.back() > kBeyond * range_max_m()) ++beyond_;
    const bool lit = intensity != nullptr && std::isfinite((*intensity)[i]) && (*intensity)[i] >= 0.0;
    record_.intensity.push_back(lit ? static_cast<float>((*intensity)[i]) : 0.0f);
    brightest_ = std::max(brightest_, record_.intensity.back());
    if (!lit) ++dark_;
  }
  const std::set<std::string> used = {"x", "y", "z", rule_->field};
  for (const std::string& name : cloud.names) {
    const auto is = [&](const char* each) { return name == each; };
    if (used.contains(name) || std::any_of(kRingNames.begin(), kRingNames.end(), is) ||
        std::any_of(kIntensityNames.begin(), kIntensityNames.end(), is))
      continue;
    ++ignored_[name];
  }
}

void SweepBuilder::take_rings(const Waiting& sweep, const std::vector<std::size_t>& kept) {
  const std::vector<double>* rings = first_of(sweep.cloud, kRingNames);
  for (const std::size_t i : kept) {
    const double ring = rings != nullptr ? (*rings)[i] : 0.0;
    if (!(ring >= 0.0 && ring <= 65535.0 && ring == std::floor(ring))) {
      throw BadInput(
          fmt::format("{}: point {}: ring is {}, must be a whole number from 0 to 65535", sweep.where, i, ring));
    }
    record_.ring.push_back(static_cast<std::uint16_t>(ring));
  }
}

void SweepBuilder::scale_intensity(std::vector<std::string>& notes) {
  if (brightest_ <= 1.0f) return;
  const double full = brightest_ <= kByteIntensity ? kByteIntensity : static_cast<double>(brightest_);
  const auto scale = [&](float& each) { each = static_cast<float>(each / full); };
  if (store_) store_->intensity.change(scale);
  std::for_each(record_.intensity.begin(), record_.intensity.end(), scale);
  notes.push_back("intensities exceed 1; they are divided by " + std::to_string(full));
}

double SweepBuilder::range_max_m() const {
  return reading_.range_max_m > 0.0 ? reading_.range_max_m : kFarthest_m;
}

/// Throws BadInput if ranges are probably in mm. Single points beyond the range in the data sheet are accepted.
void SweepBuilder::require_range(const std::string& where) const {
  if (2 * beyond_ <= points()) return;
  throw BadInput(fmt::format(
      "{}: {} of {} points are farther than {:g} m, twice {}; at most half may be. Check that x, y and z are in metres",
      where, beyond_, points(), kBeyond * range_max_m(),
      reading_.range_max_m > 0.0 ? "the range of the data sheet" : "the range of any robot lidar"));
}

void SweepBuilder::note_what_was_left(std::vector<std::string>& notes) const {
  if (misses_ > 0)
    notes.push_back(std::to_string(misses_) +
                    " points are missing returns (not finite, beyond 1000 km, or at the origin)");
  if (skipped_ > 0) notes.push_back(std::to_string(skipped_) + " sweeps without points and time stamp are left out");
  if (dark_ > 0) notes.push_back(std::to_string(dark_) + " points have no intensity; 0 is stored");
  if (viewpoints_ > 0)
    notes.push_back(
        fmt::format("{} sweeps have a VIEWPOINT, which is not applied; points are read as coordinates in the lidar's "
                    "axes (first VIEWPOINT: {})",
                    viewpoints_, first_viewpoint_));
  if (record_.point_times == sim::PointTimes::unknown)
    notes.push_back("the points have no time stamps, so sweeps cannot be deskewed");
  std::string names;
  for (const auto& [name, sweeps] : ignored_) names += " " + name;
  if (!names.empty()) notes.push_back("ignored fields:" + names);
}

BuiltSweeps SweepBuilder::finish(const std::string& where, std::vector<std::string>& notes) {
  if (!rule_ && !waiting_.empty()) find_rule();
  if (points() == 0) throw BadInput(where + ": no sweep has a point");
  require_range(where);
  record_.sweep_first.push_back(points());
  record_.name = reading_.device.name;
  record_.device = reading_.device.device;
  record_.T_BL = reading_.device.T_BL;
  const std::int64_t stated_ns = reading_.device.sweep_period_ns, step_ns = median_step_ns(record_.sweep_start_ns);
  record_.sweep_period_ns = stated_ns > 0 ? stated_ns : step_ns;
  if (record_.sweep_period_ns <= 0) throw BadInput(where + ": a single sweep needs its period (--sweep-period)");
  if (rule_ && !rule_->field.empty()) notes.push_back(said(*rule_));
  const bool overlaps = step_ns > 0 && static_cast<double>(stated_ns) > kOverlapMost * static_cast<double>(step_ns);
  if (stated_ns > 0 && (overlaps || stated_ns < longest_ns_)) {
    notes.push_back(fmt::format(
        "the stated period of a sweep is {} and is used, but sweeps are {} apart and their points span up to {}",
        in_ns(stated_ns), in_ns(step_ns), in_ns(longest_ns_)));
  }
  if (stated_ns <= 0 && longest_ns_ > record_.sweep_period_ns) {
    notes.push_back(fmt::format("sweeps are {} apart and last up to {}; the latter is used as their period",
                                in_ns(record_.sweep_period_ns), in_ns(longest_ns_)));
    record_.sweep_period_ns = longest_ns_;
  }
  note_what_was_left(notes);
  scale_intensity(notes);
  return {std::move(record_), std::move(store_), std::move(last_point_ns_)};
}

}  // namespace tumble::scenarios
