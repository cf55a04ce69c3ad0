// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/recordings/left_out.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace tumble::scenarios {

namespace {

constexpr std::size_t kNoIndex = ~std::size_t{0};
constexpr std::size_t kLeastForEnds = 10;
/// A gap of more than a day between a few time stamps and all other time stamps indicates that the clock was set.
constexpr std::uint64_t kClockSet_ns = 86'400'000'000'000;

/// Returns the indices of a longest increasing subsequence of the stamps (Fredman, Discrete Mathematics 11:29, 1975).
std::vector<std::size_t> longest_increasing(std::span<const std::int64_t> stamps_ns) {
  std::vector<std::size_t> first_of_length, after(stamps_ns.size(), kNoIndex);
  for (std::size_t k = stamps_ns.size(); k-- > 0;) {
    const auto at =
        std::lower_bound(first_of_length.begin(), first_of_length.end(), stamps_ns[k],
                         [&](std::size_t index, std::int64_t stamp_ns) { return stamps_ns[index] > stamp_ns; });
    if (at != first_of_length.begin()) after[k] = *(at - 1);
    if (at == first_of_length.end())
      first_of_length.push_back(k);
    else
      *at = k;
  }
  std::vector<std::size_t> indices;
  for (std::size_t k = first_of_length.empty() ? kNoIndex : first_of_length.back(); k != kNoIndex; k = after[k])
    indices.push_back(k);
  return indices;
}

void drop_far_ends(std::span<const std::int64_t> stamps_ns, std::vector<std::size_t>& indices) {
  const std::size_t all = indices.size();
  if (all < kLeastForEnds) return;
  // The difference of two int64 may exceed int64, so the subtraction uses unsigned numbers.
  const auto duration = [&](std::size_t from, std::size_t to) {
    return static_cast<std::uint64_t>(stamps_ns[indices[to]]) - static_cast<std::uint64_t>(stamps_ns[indices[from]]);
  };
  const auto is_far = [&](std::size_t count, std::uint64_t gap_ns, std::uint64_t others_ns) {
    return gap_ns > others_ns && (count == 1 || gap_ns > kClockSet_ns);
  };
  std::size_t first = 0, end = all;
  for (std::size_t k = 1; may_leave_out(k, all); ++k) {
    if (is_far(k, duration(k - 1, k), duration(k, all - 1))) first = k;
  }
  for (std::size_t k = all - 1; may_leave_out(all - k, all); --k) {
    if (is_far(all - k, duration(k - 1, k), duration(first, k - 1))) end = k;
  }
  indices = std::vector<std::size_t>(indices.begin() + static_cast<std::ptrdiff_t>(first),
                                     indices.begin() + static_cast<std::ptrdiff_t>(end));
}

}  // namespace

bool may_leave_out(std::size_t count, std::size_t all) {
  return static_cast<double>(count) <= kLeftOutShareMax * static_cast<double>(all) ||
         (count == 1 && all >= kLeftOutOneOf);
}

void LeftOut::count_cause(const std::string& cause, const std::string& error) {
  auto found = std::ranges::find(causes_, cause, &Cause::name);
  if (found == causes_.end()) found = causes_.insert(causes_.end(), {cause, error});
  ++found->count;
}

void LeftOut::add(const std::string& cause, const std::string& error) {
  if (faulty_++ == 0) first_error_ = error;
  count_cause(cause, error);
}

void LeftOut::add_unlimited(const std::string& cause, const std::string& error) {
  ++unlimited_;
  count_cause(cause, error);
}

void LeftOut::require_few(std::size_t kept) const {
  const std::size_t all = kept + count();
  if (faulty_ == 0 || may_leave_out(faulty_, all)) return;
  throw BadInput(fmt::format("{} ({} of {} {} are faulty; the import leaves out at most {:g} % of a sensor's data)",
                             first_error_, faulty_, all, items_, 100.0 * kLeftOutShareMax));
}

std::string LeftOut::note(std::size_t kept) const {
  if (count() == 0) return "";
  std::string text = fmt::format("caution: the import leaves out {} of {} {}:", count(), kept + count(), items_);
  const char* separator = " ";
  for (const Cause& each : causes_) {
    text += fmt::format("{}{} because of {} (first error: {})", separator, each.count, each.name, each.first);
    separator = "; ";
  }
  return text;
}

std::vector<bool> stamps_in_order(std::span<const std::int64_t> stamps_ns) {
  const bool increase = std::ranges::adjacent_find(stamps_ns, [](auto a, auto b) { return a >= b; }) == stamps_ns.end();
  std::vector<std::size_t> indices(increase ? stamps_ns.size() : 0);
  for (std::size_t k = 0; k < indices.size(); ++k) indices[k] = k;
  if (!increase) indices = longest_increasing(stamps_ns);
  drop_far_ends(stamps_ns, indices);
  std::vector<bool> kept(stamps_ns.size(), false);
  for (const std::size_t k : indices) kept[k] = true;
  return kept;
}

}  // namespace tumble::scenarios
