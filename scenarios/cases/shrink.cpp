// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/cases/shrink.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <numeric>
#include <span>
#include <sstream>

#include "scenarios/cases/complication.hpp"
#include "scenarios/cases/delta_debugging.hpp"
#include "scenarios/cases/same_failure.hpp"
#include "scenarios/draw/fixed_scenario.hpp"
#include "scenarios/errors.hpp"
#include "scenarios/sweep/draw_process.hpp"
#include "scenarios/text.hpp"
#include "sim/lidar/surface.hpp"
#include "sim/simulate.hpp"

namespace tumble::scenarios {

namespace {

constexpr double kLengthResolution = 0.05;  // relative to the original duration
constexpr double kAmountResolution = 0.1;   // relative to the distance between the drawn and the ideal value

std::string text_of(double value) {
  std::ostringstream text;
  text << value;
  return text.str();
}

class ShrinkRun {
 public:
  ShrinkRun(const DataRoot& data, const Scenario& scenario, std::uint64_t seed, Kind kind)
      : draw_(simulate_draw(data, scenario, seed, 1, kind == Kind::rate ? Lidars::left_out : Lidars::simulated)) {
    if (kind == Kind::slam) surface_.emplace(*draw_.built);
  }
  Outcome outcome(const Method& method, double timeout_s) const {
    return run_isolated(method, draw_, draw_, surface_ ? &*surface_ : nullptr, timeout_s);
  }
  bool is_cured(const TrueInput& input, const Method& method, const ShrinkOptions& options) const {
    SimulatedDraw cured = draw_;
    if (!input.replace(cured.recording.sensors, draw_.recording.truth)) return false;
    return !options.failure.holds(
        run_isolated(method, cured, scored_by(draw_, cured), surface_ ? &*surface_ : nullptr, options.timeout_s));
  }

 private:
  SimulatedDraw draw_;
  std::optional<sim::Surface> surface_;
};

using Indices = std::vector<std::size_t>;

Scenario with_only(const std::vector<Complication>& all, const Indices& kept, Scenario scenario) {
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (!std::binary_search(kept.begin(), kept.end(), i)) take_away(all[i], scenario);
  }
  return scenario;
}

std::string difference(const std::vector<Complication>& all, const Indices& left, const Indices& kept) {
  Indices gone;
  std::set_difference(left.begin(), left.end(), kept.begin(), kept.end(), std::back_inserter(gone));
  if (gone.size() == 1) return all[gone.front()].name;
  return std::to_string(gone.size()) + " of " + std::to_string(left.size());
}

class Shrinking {
 public:
  Shrinking(const DataRoot& data, const Scenario& scenario, std::uint64_t seed, const Method& method,
            const ShrinkOptions& options)
      : data_(data), seed_(seed), method_(method), options_(options) {
    shrunk_.scenario = fixed_as(scenario, draw(data, scenario, seed));
    shrunk_.scenario.named_case.reset();
    const ShrinkRun run(data, shrunk_.scenario, seed, method.info.kind);
    shrunk_.drawn = shrunk_.left = run.outcome(method, options.timeout_s);
    failure_.emplace(options.failure, shrunk_.drawn);
    shrunk_.failure = failure_->describe();
    shrunk_.controlled = options.control && !options.failure.holds(run.outcome(*options.control, options.timeout_s));
    report("as drawn", true, shrunk_.drawn);
    find_cure(run);
  }

  Shrunk run() {
    const double drawn_s = shrunk_.scenario.duration_s.numbers.front();
    bool complete = shorten(drawn_s);
    complete = simplify() && complete;
    for (const Complication& each : needed_) complete = make_smaller(each) && complete;
    complete = shorten(drawn_s) && complete;
    shrunk_.complete = complete;
    const double left_s = shrunk_.scenario.duration_s.numbers.front();
    shrunk_.lines.insert(shrunk_.lines.begin(),
                         {"duration_s", left_s < drawn_s ? Fate::smaller : Fate::needed, drawn_s, left_s});
    return std::move(shrunk_);
  }

 private:
  void find_cure(const ShrinkRun& run) {
    const std::span<const TrueInput> single = true_inputs().first(true_inputs().size() - 1);
    const auto cure = std::find_if(single.begin(), single.end(),
                                   [&](const TrueInput& input) { return run.is_cured(input, method_, options_); });
    if (cure == single.end()) return;
    cure_ = &*cure;
    shrunk_.cure = cure->name;
  }

  std::string other_cause(const ShrinkRun& run) const {
    if (shrunk_.controlled && options_.failure.holds(run.outcome(*options_.control, options_.timeout_s)))
      return fmt::format("the failure does not come from the method, because the control method {} also fails",
                         options_.control->info.name);
    if (cure_ != nullptr && !run.is_cured(*cure_, method_, options_))
      return fmt::format(
          "the failure has another cause, because the method also fails with the true values of the input {}",
          cure_->name);
    return "";
  }

  std::optional<bool> try_out(const Scenario& simpler, const std::string& what, Outcome* outcome_out = nullptr) {
    if (shrunk_.runs >= options_.budget) return std::nullopt;
    bool fails = false;
    Outcome outcome;
    try {
      const ShrinkRun run(data_, simpler, seed_, method_.info.kind);
      outcome = run.outcome(method_, options_.timeout_s);
      fails = failure_->holds(outcome);
      if (const std::string other = fails ? other_cause(run) : ""; !other.empty()) {
        fails = false;
        outcome.message = one_line(other);
      }
    } catch (const std::exception& error) {  // an invalid run shows no failure
      outcome.status = OutcomeStatus::rejected;
      outcome.message = one_line(error.what());
    }
    if (fails) {
      shrunk_.scenario = simpler;
      shrunk_.left = outcome;
    }
    if (outcome_out != nullptr) *outcome_out = outcome;
    report(what, fails, outcome);
    return fails;
  }

  void report(const std::string& what, bool kept, const Outcome& outcome) {
    ++shrunk_.runs;
    if (options_.on_trial) options_.on_trial({shrunk_.runs, what, kept, outcome});
  }

  bool shorten(double drawn_s) {
    const auto fails = [&](double length_s) {
      Scenario shorter = shrunk_.scenario;
      fix_number(shorter, "duration_s", length_s);
      return try_out(shorter, text_of(length_s) + " s");
    };
    const double now_s = shrunk_.scenario.duration_s.numbers.front();
    return least_failing_number(now_s, 0.0, kLengthResolution * drawn_s, false, fails).complete;
  }

  bool simplify() {
    const std::vector<Complication> all = complications(shrunk_.scenario);
    const Scenario whole = shrunk_.scenario;
    std::map<Indices, Outcome> outcomes;
    Indices left(all.size());
    std::iota(left.begin(), left.end(), std::size_t{0});
    const auto fails = [&](const Indices& kept) {
      const std::optional<bool> answer =
          try_out(with_only(all, kept, whole), "without " + difference(all, left, kept), &outcomes[kept]);
      if (answer.value_or(false)) left = kept;
      return answer;
    };
    const LeastSet least = least_failing_set(all.size(), fails);
    for (std::size_t i = 0; i < all.size(); ++i) add_line(all[i], i, least, outcomes);
    return least.complete;
  }

  void add_line(const Complication& complication, std::size_t index, const LeastSet& least,
                const std::map<Indices, Outcome>& outcomes) {
    ShrinkLine line{complication.name, Fate::removed, complication.amount, {}};
    if (std::binary_search(least.needed.begin(), least.needed.end(), index)) {
      line.fate = Fate::needed;
      Indices others = least.kept;
      std::erase(others, index);
      line.without = outcomes.at(others);
      needed_.push_back(complication);
    } else if (std::binary_search(least.kept.begin(), least.kept.end(), index)) {
      line.fate = Fate::not_tried;
    }
    shrunk_.lines.push_back(std::move(line));
  }

  bool make_smaller(const Complication& needed) {
    if (!needed.amount) return true;
    const auto& [place, ideal] = needed.without.front();
    const auto fails = [&, place = place](double amount) {
      Scenario simpler = shrunk_.scenario;
      fix_number(simpler, place, amount);
      return try_out(simpler, place + " " + text_of(amount));
    };
    const double resolution = kAmountResolution * std::abs(*needed.amount - ideal);
    const LeastNumber least = least_failing_number(*needed.amount, ideal, resolution, needed.whole, fails);
    const auto line = std::find_if(shrunk_.lines.begin(), shrunk_.lines.end(),
                                   [&](const ShrinkLine& each) { return each.what == needed.name; });
    line->to = least.fails_at;
    if (least.fails_at != *needed.amount) line->fate = Fate::smaller;
    return least.complete;
  }

  const DataRoot& data_;
  std::uint64_t seed_;
  const Method& method_;
  const ShrinkOptions& options_;
  std::optional<SameFailure> failure_;
  const TrueInput* cure_ = nullptr;
  Shrunk shrunk_;
  std::vector<Complication> needed_;
};

}  // namespace

const char* to_string(Fate fate) {
  switch (fate) {
    case Fate::removed:
      return "removed";
    case Fate::smaller:
      return "made smaller";
    case Fate::needed:
      return "needed";
    case Fate::not_tried:
      break;
  }
  return "not tried";
}

Shrunk shrink(const DataRoot& data, const Scenario& scenario, std::uint64_t seed, const Method& method,
              const ShrinkOptions& options) {
  require_applies(method, scenario);
  if (options.control) {
    require_applies(*options.control, scenario);
    if (options.control->info.kind != method.info.kind)
      throw BadInput(
          fmt::format("the control method '{}' is of kind {}; it must be of kind {}, like the failing method",
                      options.control->info.name, to_string(options.control->info.kind), to_string(method.info.kind)));
  }
  return Shrinking(data, scenario, seed, method, options).run();
}

}  // namespace tumble::scenarios
