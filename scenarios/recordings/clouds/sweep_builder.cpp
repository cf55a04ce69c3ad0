// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/recordings/clouds/sweep_builder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <set>
#include <span>
#include <string_view>

#include "scenarios/errors.hpp"
#include "scenarios/recordings/clouds/import_sweeps.hpp"
#include "scenarios/recordings/upper_median.hpp"
#include "tumble_ros/point_fields.hpp"

namespace tumble::scenarios {

namespace {

/// A single point cloud may be incomplete, so several clouds determine the unit of the point times.
constexpr std::ptrdiff_t kProbe = 10;
constexpr double kByteIntensity = 255.0;
constexpr double kPointFar_m = 1e6;
constexpr double kBeyond = 2.0;             // in ranges of the data sheet
constexpr double kFarthestPoint_m = 500.0;  // above that of robot lidars
constexpr std::size_t kBackwards = 20;      // falling over rising point times
constexpr double kOverlapMost = 1.05;       // sweep period over sweep interval
constexpr std::int64_t kOffsetMax_ns = 1000000000;

using tumble::ros::kRingNames, tumble::ros::kIntensityNames;

const std::vector<double>& coordinate(const Cloud& cloud, const char* name, const std::string& where) {
  const std::vector<double>* found = cloud.find(name);
  if (found != nullptr) return *found;
  std::string all;
  for (const std::string& each : cloud.names) all += " " + each;
  throw BadInput(fmt::format("{}: the points have no field '{}' (existing fields:{})", where, name, all));
}

bool is_among(const std::string& name, std::span<const std::string_view> names) {
  return std::ranges::find(names, tumble::ros::lower_case(name)) != names.end();
}

const std::vector<double>* first_of(const Cloud& cloud, std::span<const std::string_view> names) {
  for (std::size_t c = 0; c < cloud.names.size(); ++c) {
    if (is_among(cloud.names[c], names)) return &cloud.columns[c];
  }
  return nullptr;
}

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

std::string rule_text(const PointTimeRule& rule) {
  const char* unit = rule.unit_ns == 1e9 ? "s" : rule.unit_ns == 1e6 ? "ms" : rule.unit_ns == 1e3 ? "us" : "ns";
  return rule.absolute
             ? fmt::format("the point times come from field '{}', which counts {} on the lidar's clock", rule.field,
                           unit)
             : fmt::format("the point times come from field '{}', which counts {} from the sweep's time stamp",
                           rule.field, unit);
}

std::int64_t middle_of(const std::vector<std::optional<std::int64_t>>& times_ns) {
  std::vector<std::int64_t> known;
  for (const auto& time : times_ns) {
    if (time) known.push_back(*time);
  }
  return upper_median(std::move(known));
}

std::vector<std::uint16_t> rings_of(const Cloud& cloud, const std::vector<std::size_t>& kept,
                                    const std::string& where) {
  const std::vector<double>* column = first_of(cloud, kRingNames);
  std::vector<std::uint16_t> rings;
  for (const std::size_t i : kept) {
    const double ring = column != nullptr ? (*column)[i] : 0.0;
    if (!(ring >= 0.0 && ring <= 65535.0 && ring == std::floor(ring)))
      throw BadInput(
          fmt::format("{}: the ring of point {} is {}; it must be a whole number from 0 to 65535", where, i, ring));
    rings.push_back(static_cast<std::uint16_t>(ring));
  }
  return rings;
}

}  // namespace

void SweepBuilder::add(std::optional<std::int64_t> stamp_ns, Cloud cloud, std::string where) {
  Waiting sweep{stamp_ns, std::move(cloud), std::move(where)};
  if (rule_) return take(sweep);
  waiting_.push_back(std::move(sweep));
  if (fields_.empty()) fields_ = waiting_.back().cloud.names;
  const auto holds_points = [](const Waiting& each) { return each.cloud.points > 0; };
  if (std::count_if(waiting_.begin(), waiting_.end(), holds_points) >= kProbe) find_rule();
}

void SweepBuilder::find_rule() {
  std::vector<Cloud> first;
  for (Waiting& sweep : waiting_) first.push_back(std::move(sweep.cloud));
  rule_ = find_point_times(first, period_ns_, reading_, waiting_.front().where);
  if (rule_->field.empty()) {
    const bool not_skewed = reading_.not_skewed || rule_->constant;
    record_.point_times = not_skewed ? sim::PointTimes::not_skewed : sim::PointTimes::unknown;
  }
  for (std::size_t k = 0; k < waiting_.size(); ++k) waiting_[k].cloud = std::move(first[k]);
  other_clock_ = has_other_clock();
  for (Waiting& sweep : waiting_) take(sweep);
  waiting_.clear();
}

bool SweepBuilder::has_other_clock() const {
  if (!rule_->absolute || reading_.assumed || period_ns_ <= 0) return false;
  std::size_t apart = 0, all = 0;
  for (const Waiting& sweep : waiting_) {
    const std::vector<double>* column = sweep.cloud.find(rule_->field);
    if (!sweep.stamp_ns || column == nullptr) continue;
    std::vector<double> times;  // missed rays may have the time 0
    std::ranges::copy_if(*column, std::back_inserter(times), [](double t) { return std::isfinite(t) && t != 0.0; });
    if (times.empty()) continue;
    const double middle_ns = upper_median(std::move(times)) * rule_->unit_ns;
    ++all;
    const double most_ns = static_cast<double>(longest_sweep_ns() + period_ns_);
    if (std::abs(middle_ns - static_cast<double>(*sweep.stamp_ns)) > most_ns) ++apart;
  }
  return 2 * apart > all;
}

void SweepBuilder::take(Waiting& sweep) {
  last_point_ns_.emplace_back();
  left_out_.guard([&] { read(sweep); });
}

void SweepBuilder::read(Waiting& sweep) {
  if (reading_.assumed && rule_->absolute) sweep.stamp_ns.reset();
  std::vector<std::size_t> kept = sweep.cloud.points > 0 ? hits(sweep.cloud, sweep.where) : std::vector<std::size_t>{};
  misses_ += sweep.cloud.points - kept.size();
  if (!sweep.cloud.viewpoint.empty() && viewpoints_++ == 0)
    first_viewpoint_ = sweep.where + ": " + sweep.cloud.viewpoint;
  if (kept.empty() && !sweep.stamp_ns) {
    ++skipped_;
    return;
  }
  std::vector<std::int64_t> times_ns = point_times(sweep, kept);
  const std::int64_t start_ns = start_of(sweep, times_ns);
  std::vector<std::int64_t>& starts = record_.sweep_start_ns;
  if (!starts.empty() && start_ns <= starts.back()) {
    throw BadInput(fmt::format("{}: the sweep starts at {}; it must start after the previous sweep, which starts at {}",
                               sweep.where, in_ns(start_ns), in_ns(starts.back())));
  }
  const std::vector<std::uint16_t> rings = rings_of(sweep.cloud, kept, sweep.where);
  if (is_far(sweep, kept)) return;
  starts.push_back(start_ns);
  record_.sweep_first.push_back(points());
  for (const std::int64_t time_ns : times_ns) {
    record_.offset_ns.push_back(static_cast<std::uint32_t>(time_ns - start_ns));
    longest_ns_ = std::max(longest_ns_, time_ns - start_ns);
  }
  for (std::size_t k = 1; k < times_ns.size(); ++k) {
    rises_ += times_ns[k] > times_ns[k - 1] ? 1 : 0;
    falls_ += times_ns[k] < times_ns[k - 1] ? 1 : 0;
  }
  last_point_ns_.back() = times_ns.empty() ? start_ns : *std::max_element(times_ns.begin(), times_ns.end());
  record_.ring.insert(record_.ring.end(), rings.begin(), rings.end());
  take_points(sweep, kept);
  if (store_) store_->take(record_);
}

std::vector<std::int64_t> SweepBuilder::point_times(const Waiting& sweep, std::vector<std::size_t>& kept) {
  if (rule_->field.empty() || kept.empty()) {
    if (!sweep.stamp_ns)
      throw BadInput(fmt::format(
          "{}: neither the sweep nor its points have a time stamp; state the times of the sweeps (--times), or the "
          "duration of one sweep (--sweep-period)",
          sweep.where));
    return std::vector<std::int64_t>(kept.size(), *sweep.stamp_ns);
  }
  const std::vector<double>* numbers = sweep.cloud.find(rule_->field);
  if (numbers == nullptr)
    throw BadInput(fmt::format("{}: the points have no field '{}' for their times, but other sweeps have this field",
                               sweep.where, rule_->field));
  if (!rule_->absolute && !sweep.stamp_ns)
    throw BadInput(fmt::format(
        "{}: the point times are relative to the start of the sweep, but the sweep has no time stamp", sweep.where));
  constexpr double kBound = 4.6e18;  // larger differences overflow int64
  const std::int64_t origin_ns = rule_->absolute ? 0 : *sweep.stamp_ns;
  std::vector<std::optional<std::int64_t>> times_ns;
  for (const std::size_t i : kept) {
    const double time_ns = (*numbers)[i] * rule_->unit_ns;
    times_ns.push_back(std::abs(time_ns) + static_cast<double>(std::abs(origin_ns)) < kBound
                           ? std::optional(origin_ns + std::llround(time_ns))
                           : std::nullopt);
  }
  const std::int64_t middle_ns = middle_of(times_ns), bound_ns = longest_sweep_ns();
  std::vector<std::size_t> timed;
  std::vector<std::int64_t> out;
  std::string first_mistimed;
  for (std::size_t k = 0; k < kept.size(); ++k) {
    if (times_ns[k] && *times_ns[k] - middle_ns <= bound_ns && middle_ns - *times_ns[k] <= bound_ns) {
      timed.push_back(kept[k]);
      out.push_back(*times_ns[k]);
    } else if (first_mistimed.empty()) {
      first_mistimed =
          times_ns[k]
              ? fmt::format(
                    "{}: the time of point {} is {} after the middle of the sweep; it must be within {} of the middle",
                    sweep.where, kept[k], in_ns(*times_ns[k] - middle_ns), in_ns(bound_ns))
              : fmt::format("{}: the time of point {} is {}; it must be finite and at most 146 years", sweep.where,
                            kept[k], std::to_string((*numbers)[kept[k]]));
    }
  }
  const std::size_t mistimed = kept.size() - timed.size();
  if (mistimed > 0 && !may_leave_out(mistimed, kept.size())) throw BadInput(first_mistimed);
  if (mistimed > 0 && mistimed_ == 0) first_mistimed_ = first_mistimed;
  mistimed_ += mistimed;
  kept = std::move(timed);
  return out;
}

std::int64_t SweepBuilder::longest_sweep_ns() const {
  return period_ns_ > 0 ? 2 * period_ns_ : kOffsetMax_ns;
}

std::int64_t SweepBuilder::start_of(const Waiting& sweep, std::vector<std::int64_t>& times_ns) const {
  if (times_ns.empty()) return *sweep.stamp_ns;
  const std::int64_t first = *std::min_element(times_ns.begin(), times_ns.end()), bound = longest_sweep_ns();
  std::int64_t start = sweep.stamp_ns.value_or(first);
  if (other_clock_ && sweep.stamp_ns) {
    for (std::int64_t& time : times_ns) time += start - first;
  } else {
    if (start - first > bound || first - start > bound) {
      throw BadInput(
          fmt::format("{}: the first point of the sweep is at {}, but the time stamp of the sweep is {}; the "
                      "difference must be at most {}. Check the clock and the unit",
                      sweep.where, in_ns(first), in_ns(start), in_ns(bound)));
    }
    if (start > first || first - start >= bound / 2) start = first;
  }
  const std::int64_t last = *std::max_element(times_ns.begin(), times_ns.end());
  if (last - start > bound || last - start > std::numeric_limits<std::uint32_t>::max()) {
    throw BadInput(fmt::format("{}: the last point is {} after the start of the sweep; this time must be at most {}",
                               sweep.where, in_ns(last - start), in_ns(bound)));
  }
  return start;
}

bool SweepBuilder::is_far(const Waiting& sweep, const std::vector<std::size_t>& kept) {
  if (kept.empty()) return false;
  const std::vector<double>&x = *sweep.cloud.find("x"), &y = *sweep.cloud.find("y"), &z = *sweep.cloud.find("z");
  const auto beyond = static_cast<std::size_t>(std::ranges::count_if(kept, [&](std::size_t i) {
    return Eigen::Vector3d(x[i], y[i], z[i]).cast<float>().norm() > kBeyond * range_max_m();
  }));
  beyond_ += beyond;
  if (2 * beyond <= kept.size()) return false;
  far_ += kept.size();
  left_out_.add_unlimited("points beyond the lidar's range", sweep.where);
  return true;
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
    const bool lit = intensity != nullptr && std::isfinite((*intensity)[i]) && (*intensity)[i] >= 0.0;
    record_.intensity.push_back(lit ? static_cast<float>((*intensity)[i]) : 0.0f);
    brightest_ = std::max(brightest_, record_.intensity.back());
    if (!lit) ++dark_;
  }
  const std::set<std::string> used = {"x", "y", "z", rule_->field};
  for (const std::string& name : cloud.names) {
    if (used.contains(name) || is_among(name, kRingNames) || is_among(name, kIntensityNames)) continue;
    ++ignored_[name];
  }
}

void SweepBuilder::scale_intensity(std::vector<std::string>& notes) {
  if (brightest_ <= 1.0f) return;
  const double full = brightest_ <= kByteIntensity ? kByteIntensity : static_cast<double>(brightest_);
  const auto scale = [&](float& each) { each = static_cast<float>(each / full); };
  if (store_) store_->intensity.change(scale);
  std::for_each(record_.intensity.begin(), record_.intensity.end(), scale);
  notes.push_back(fmt::format("the intensities exceed 1, so the import divides them by {}", std::to_string(full)));
}

double SweepBuilder::range_max_m() const {
  return reading_.range_max_m > 0.0 ? reading_.range_max_m : kFarthestPoint_m;
}

void SweepBuilder::require_range(const std::string& where) const {
  const std::size_t all = points() + far_;
  if (2 * beyond_ <= all) return;
  throw BadInput(fmt::format(
      "{}: {} of {} points are farther than {:g} m, which is twice the range of {}; at most half of the "
      "points may be that far. Check that x, y and z are in metres",
      where, beyond_, all, kBeyond * range_max_m(), reading_.range_max_m > 0.0 ? "the data sheet" : "any robot lidar"));
}

void SweepBuilder::note_dropped_points(std::vector<std::string>& notes) const {
  std::string names;
  for (const auto& [name, sweeps] : ignored_) names += " " + name;
  if (left_out_.count() > 0) notes.push_back(left_out_.note(record_.sweep_start_ns.size() + skipped_));
  if (mistimed_ > 0)
    notes.push_back(fmt::format("caution: the import leaves out {} {} with times outside their sweep (first: {})",
                                mistimed_, mistimed_ == 1 ? "point" : "points", first_mistimed_));
  if (other_clock_)
    notes.push_back(
        "caution: the point times and the time stamps of the sweeps come from different clocks. The import assumes "
        "that the first point of each sweep was measured at the sweep's time stamp");
  if (falls_ > kBackwards * (rises_ + 1))
    notes.push_back(
        "caution: points that are stored later have earlier times. If the driver stores the points in the order of "
        "measurement, the times are wrong and deskewing doubles the distortion");
  if (rule_ && rule_->constant)
    notes.push_back(
        "caution: all points of a sweep have the same time, so the sweeps are treated as not skewed. If the lidar "
        "rotates during a sweep, configure the lidar's driver to provide point times");
  if (rule_ && rule_->short_span)
    notes.push_back(
        "caution: the point times span less than 2 % of the sweep period. Check the unit (set '--time-unit'), or set "
        "'--not-skewed' if the times count from the start of each packet");
  if (misses_ > 0)
    notes.push_back(fmt::format(
        "{} points are treated as missing returns (not finite, farther than 1000 km, or at the origin)", misses_));
  if (skipped_ > 0)
    notes.push_back(fmt::format("{} sweeps have neither points nor a time stamp and are left out", skipped_));
  if (dark_ > 0) notes.push_back(fmt::format("{} points have no valid intensity; the import stores 0", dark_));
  if (viewpoints_ > 0)
    notes.push_back(
        fmt::format("{} sweeps have a VIEWPOINT. The import ignores the VIEWPOINT and reads the points as coordinates "
                    "in the lidar's axes (first VIEWPOINT: {})",
                    viewpoints_, first_viewpoint_));
  if (record_.point_times == sim::PointTimes::unknown)
    notes.push_back(
        names.empty() ? "the points have no time stamps, so sweeps cannot be deskewed"
                      : fmt::format("the points have no time stamps, so sweeps cannot be deskewed (set '--time-field' "
                                    "to a field with times):{}",
                                    names));
  if (!names.empty()) notes.push_back("ignored fields:" + names);
}

BuiltSweeps SweepBuilder::finish(const std::string& where, std::vector<std::string>& notes) {
  if (!rule_ && !waiting_.empty()) find_rule();
  left_out_.require_few(record_.sweep_start_ns.size() + skipped_);
  require_range(where);
  if (points() == 0)
    throw BadInput(fmt::format("{}: all sweeps are empty; at least one sweep must have points", where));
  record_.sweep_first.push_back(points());
  record_.name = reading_.device.name;
  record_.device = reading_.device.device;
  record_.T_BL = reading_.device.T_BL;
  const std::int64_t stated_ns = reading_.device.sweep_period_ns, step_ns = median_step_ns(record_.sweep_start_ns);
  record_.sweep_period_ns = stated_ns > 0 ? stated_ns : step_ns;
  if (record_.sweep_period_ns <= 0)
    throw BadInput(
        fmt::format("{}: there is only one sweep, so its period is unknown; state the period (--sweep-period)", where));
  if (rule_ && !rule_->field.empty()) notes.push_back(rule_text(*rule_));
  const bool overlaps = step_ns > 0 && static_cast<double>(stated_ns) > kOverlapMost * static_cast<double>(step_ns);
  if (stated_ns > 0 && (overlaps || stated_ns < longest_ns_)) {
    notes.push_back(
        fmt::format("the import uses the stated sweep period of {}, but the sweeps start {} apart, and the points of a "
                    "sweep span up to {}",
                    in_ns(stated_ns), in_ns(step_ns), in_ns(longest_ns_)));
  }
  if (stated_ns <= 0 && longest_ns_ > record_.sweep_period_ns) {
    notes.push_back(
        fmt::format("the sweeps start {} apart, but the points of a sweep span up to {}; the import uses this span as "
                    "the sweep period",
                    in_ns(record_.sweep_period_ns), in_ns(longest_ns_)));
    record_.sweep_period_ns = longest_ns_;
  }
  note_dropped_points(notes);
  scale_intensity(notes);
  return {std::move(record_), std::move(store_), std::move(last_point_ns_), std::move(fields_)};
}

}  // namespace tumble::scenarios
