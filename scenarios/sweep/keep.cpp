// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/sweep/keep.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <string_view>
#include <system_error>
#include <tuple>

#include "scenarios/errors.hpp"
#include "scenarios/methods/registry.hpp"
#include "scenarios/scoring/metric.hpp"
#include "scenarios/sweep/draw_files.hpp"
#include "scenarios/text.hpp"

namespace tumble::scenarios {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t kCountMax = 1000;
constexpr std::string_view kWorst = "worst:";

std::string ranking_metric(Kind kind) {
  for (const std::string& name : headline_metrics(kind)) {
    const MetricInfo& info = metric_info(name);
    if (info.sense != Sense::none && info.unit != Unit::verdict) return name;
  }
  return {};
}

bool needs_truth(Kind kind, std::string_view method) {
  const auto all = methods();
  return std::any_of(all.begin(), all.end(), [&](const Method& m) {
    return m.info.kind == kind && m.info.name == method && m.info.needs_truth;
  });
}

std::optional<double> badness(const OutcomeView& row, const std::string& metric) {
  if (row.status != OutcomeStatus::ok) return std::numeric_limits<double>::infinity();
  for (const OutcomeView::Value& score : row.scores) {
    if (*score.metric != metric) continue;
    const double bad = how_bad(metric_info(metric), score.value);
    return std::isnan(bad) ? std::nullopt : std::optional(bad);
  }
  return std::nullopt;
}

class Worst {
 public:
  void add(double badness, std::uint64_t seed, std::size_t count) {
    draws_.insert({-badness, seed});
    if (draws_.size() > count) draws_.erase(std::prev(draws_.end()));
  }
  const std::set<std::pair<double, std::uint64_t>>& draws() const { return draws_; }

 private:
  std::set<std::pair<double, std::uint64_t>> draws_;  // worst first, then by seed
};

std::set<DrawName> worst_draws(const Results& results, std::size_t count) {
  std::map<Kind, std::string> metric_of;
  for (const Kind kind : kKinds) metric_of[kind] = ranking_metric(kind);
  std::map<std::tuple<std::string, Kind, std::string>, Worst> worst;
  Names names;
  results.each(Rows::plain, names, [&](const OutcomeView& row) {
    if (const auto bad = badness(row, metric_of[row.kind]))
      worst[{std::string(row.scenario), row.kind, std::string(row.method)}].add(*bad, row.seed, count);
  });
  std::set<DrawName> out;
  for (const auto& [key, own] : worst) {
    if (needs_truth(std::get<1>(key), std::get<2>(key))) continue;
    for (const auto& [bad, seed] : own.draws()) out.insert({std::get<0>(key), seed});
  }
  return out;
}

}  // namespace

Keep parse_keep(const std::string& text) {
  if (text == "none") return {};
  if (text == "failed") return {Keep::Which::failed, 0};
  if (text == "all") return {Keep::Which::all, 0};
  if (text.starts_with(kWorst)) {
    std::size_t count = 0;
    if (read_number(std::string_view(text).substr(kWorst.size()), count) && count >= 1 && count <= kCountMax)
      return {Keep::Which::worst, count};
  }
  throw BadInput(fmt::format(
      "the rule for kept simulated runs is '{}'; it must be none, failed, all, or worst:N with N from 1 to {}", text,
      kCountMax));
}

std::string to_string(const Keep& keep) {
  switch (keep.which) {
    case Keep::Which::failed:
      return "failed";
    case Keep::Which::worst:
      return std::string(kWorst) + std::to_string(keep.count);
    case Keep::Which::all:
      return "all";
    case Keep::Which::none:
      break;
  }
  return "none";
}

std::set<DrawName> draws_to_keep(const Results& results, const Keep& keep) {
  if (keep.which == Keep::Which::worst) return worst_draws(results, keep.count);
  std::set<DrawName> out;
  if (keep.which == Keep::Which::none) return out;
  Names names;
  results.each(Rows::plain, names, [&](const OutcomeView& row) {
    if (keep.which == Keep::Which::all || row.status != OutcomeStatus::ok)
      out.insert({std::string(row.scenario), row.seed});
  });
  return out;
}

namespace {

namespace fs = std::filesystem;

template <typename Action>
auto guarded(Action&& action) {
  try {
    return action();
  } catch (const fs::filesystem_error& error) {
    throw BadInput(error.path1().string() + ": " + error.code().message());
  }
}

std::optional<std::uint64_t> seed_of(const std::string& text) {
  std::uint64_t seed = 0;
  return read_number(text, seed) ? std::optional(seed) : std::nullopt;
}

void link_or_copy(const fs::path& from, const fs::path& to) {
  std::error_code no_link;
  fs::create_hard_link(from, to, no_link);
  if (no_link) fs::copy_file(from, to);
}

void take_tree(const fs::path& from, const fs::path& to) {
  fs::create_directories(to);
  for (const fs::directory_entry& each : fs::directory_iterator(from)) {
    if (each.is_directory())
      take_tree(each.path(), to / each.path().filename());
    else
      link_or_copy(each.path(), to / each.path().filename());
  }
}

std::string rule_of(const fs::path& database) {
  return Results(database, Results::Mode::read_only).note(kKeepNote);
}

}  // namespace

fs::path estimate_folder(const fs::path& draw, Kind kind, const std::string& method) {
  return draw / "estimates" / (std::string(to_string(kind)) + "-" + method);
}

KeptDraws::KeptDraws(const fs::path& database) : folder_(database.string() + ".files/kept") {}

fs::path KeptDraws::folder_of(const DrawName& draw) const {
  return folder_ / draw.scenario / std::to_string(draw.seed);
}

bool KeptDraws::holds(const DrawName& draw, std::span<const Outcome> estimated) const {
  const fs::path folder = folder_of(draw);
  // The file `command` is written last, so its presence marks a complete folder of a kept run.
  return guarded([&] {
    return fs::exists(folder / kDrawCommand) &&
           std::all_of(estimated.begin(), estimated.end(), [&](const Outcome& row) {
             return fs::exists(estimate_folder(folder, row.kind, row.method) / "estimate.json");
           });
  });
}

std::vector<DrawName> KeptDraws::found() const {
  return guarded([&] {
    std::vector<DrawName> out;
    if (!fs::exists(folder_)) return out;
    for (const fs::directory_entry& scenario : fs::directory_iterator(folder_)) {
      if (!scenario.is_directory() || scenario.path().filename() == kUnfinished) continue;
      for (const fs::directory_entry& draw : fs::directory_iterator(scenario)) {
        if (const auto seed = seed_of(draw.path().filename().string()))
          out.push_back({scenario.path().filename().string(), *seed});
      }
    }
    std::sort(out.begin(), out.end());
    return out;
  });
}

void KeptDraws::remove(const DrawName& draw) const {
  guarded([&] {
    fs::remove_all(folder_of(draw));
    std::error_code not_empty;
    fs::remove(folder_ / draw.scenario, not_empty);
  });
}

void KeptDraws::discard_unfinished() const {
  guarded([&] { fs::remove_all(folder_ / kUnfinished); });
}

bool KeptDraws::take(const DrawName& draw, const KeptDraws& from) const {
  const fs::path theirs = from.folder_of(draw), own = folder_of(draw);
  return guarded([&] {
    if (!from.holds(draw, {})) return false;
    if (!holds(draw, {})) {
      UnfinishedFolder made(own, folder_);
      take_tree(theirs, made.path());
      made.move_into_place();
      return true;
    }
    if (!fs::exists(theirs / "estimates")) return true;
    for (const fs::directory_entry& each : fs::directory_iterator(theirs / "estimates")) {
      const fs::path place = own / "estimates" / each.path().filename();
      if (fs::exists(place)) continue;
      UnfinishedFolder made(place, folder_);
      take_tree(each.path(), made.path());
      made.move_into_place();
    }
    return true;
  });
}

std::size_t merge_kept(const DatabaseOwner& owner, std::span<const fs::path> in) {
  const fs::path& out = owner.database();
  const std::string rule = rule_of(out);
  if (rule.empty() || !std::all_of(in.begin(), in.end(), [&](const fs::path& each) { return rule_of(each) == rule; }))
    return 0;
  const std::set<DrawName> wanted = draws_to_keep(Results(out, Results::Mode::read_only), parse_keep(rule));
  const KeptDraws kept(out);
  kept.discard_unfinished();
  for (const DrawName& draw : kept.found()) {
    if (!wanted.contains(draw)) kept.remove(draw);
  }
  std::size_t count = 0;
  for (const DrawName& draw : wanted) {
    for (const fs::path& each : in) kept.take(draw, KeptDraws(each));
    count += kept.holds(draw, {});
  }
  kept.discard_unfinished();
  return count;
}

}  // namespace tumble::scenarios
