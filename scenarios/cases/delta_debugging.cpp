// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/cases/delta_debugging.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

namespace tumble::scenarios {

namespace {

using Indices = std::vector<std::size_t>;

Indices without(const Indices& kept, std::size_t first, std::size_t count) {
  Indices out(kept.begin(), kept.begin() + static_cast<std::ptrdiff_t>(first));
  const std::size_t end = std::min(first + count, kept.size());
  out.insert(out.end(), kept.begin() + static_cast<std::ptrdiff_t>(end), kept.end());
  return out;
}

class Asked {
 public:
  explicit Asked(const FailsWith& fails) : fails_(fails) {}
  std::optional<bool> operator()(const Indices& kept) {
    const auto known = answers_.find(kept);
    if (known != answers_.end()) return known->second;
    const std::optional<bool> answer = fails_(kept);
    if (answer) answers_[kept] = *answer;
    return answer;
  }

 private:
  const FailsWith& fails_;
  std::map<Indices, bool> answers_;
};

}  // namespace

LeastSet least_failing_set(std::size_t count, const FailsWith& fails) {
  Asked asked(fails);
  LeastSet out;
  out.kept.resize(count);
  std::iota(out.kept.begin(), out.kept.end(), std::size_t{0});
  for (std::size_t chunk = std::max<std::size_t>(count, 1); !out.kept.empty();) {
    bool removed = false;
    out.needed.clear();
    for (std::size_t first = 0; first < out.kept.size();) {
      const std::optional<bool> still = asked(without(out.kept, first, chunk));
      if (!still) return out;
      if (*still) {
        out.kept = without(out.kept, first, chunk);
        out.needed.clear();
        removed = true;
        continue;
      }
      if (chunk == 1) out.needed.push_back(out.kept[first]);
      first += chunk;
    }
    if (chunk == 1 && !removed) break;
    chunk = std::max<std::size_t>(1, std::min(chunk, out.kept.size()) / 2);
  }
  out.complete = true;
  return out;
}

LeastNumber least_failing_number(double failing, double ideal, double resolution, bool whole, const FailsAt& fails) {
  LeastNumber out{failing, ideal, false};
  const double least = whole ? std::max(1.0, resolution) : resolution;
  while (std::abs(out.fails_at - out.holds_at) > least) {
    double middle = 0.5 * (out.fails_at + out.holds_at);
    if (whole) middle = std::round(middle);
    if (middle == out.fails_at || middle == out.holds_at) break;
    const std::optional<bool> still = fails(middle);
    if (!still) return out;
    (*still ? out.fails_at : out.holds_at) = middle;
  }
  out.complete = true;
  return out;
}

}  // namespace tumble::scenarios
