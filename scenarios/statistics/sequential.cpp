// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/statistics/sequential.hpp"

#include <fmt/format.h>

#include <boost/math/distributions/normal.hpp>
#include <cmath>
#include <string>

#include "scenarios/errors.hpp"

namespace tumble::scenarios {

double spent_by(double risk, double share) {
  if (!(share > 0.0)) return 0.0;
  const boost::math::normal normal;
  return 2.0 * cdf(complement(normal, quantile(complement(normal, 0.25 * risk)) / std::sqrt(share)));
}

SequentialSignTest::SequentialSignTest(double risk) : risk_(risk) {
  if (!(risk > 0.0 && risk < 1.0))
    throw BadInput(fmt::format("sequential test: the risk of a wrong verdict is {}; it must be within (0, 1)",
                               std::to_string(risk)));
}

SequentialSignTest::Verdict SequentialSignTest::look(double share, std::int64_t negative, std::int64_t positive) {
  if (!(share > 0.0 && share <= 1.0 && share >= share_))
    throw BadInput(
        fmt::format("sequential test: the share of the completed simulated runs is {}; it must be within (0, 1] and "
                    "must not decrease",
                    std::to_string(share)));
  if (negative < 0 || positive < 0 || negative + positive < pairs_)
    throw BadInput(fmt::format(
        "sequential test: {} pairs have a negative difference and {} pairs have a positive difference, but the "
        "previous analysis had {} pairs in total; the total must not decrease",
        negative, positive, pairs_));
  if (verdict_ != Verdict::open) return verdict_;
  share_ = share;
  toss(negative + positive - pairs_);
  stop_beyond(spent_by(risk_, share));
  if (positive >= needed_) verdict_ = Verdict::positive;
  if (negative >= needed_) verdict_ = Verdict::negative;
  return verdict_;
}

void SequentialSignTest::toss(std::int64_t pairs) {
  for (std::int64_t k = 0; k < pairs; ++k) {
    going_on_.push_back(0.0);
    for (std::size_t at = going_on_.size(); at-- > 1;) going_on_[at] = 0.5 * (going_on_[at] + going_on_[at - 1]);
    going_on_[0] *= 0.5;
  }
  pairs_ += pairs;
}

void SequentialSignTest::stop_beyond(double allowed) {
  std::size_t stopped = 0;
  while (2 * stopped + 1 < going_on_.size()) {
    const double more = going_on_[going_on_.size() - 1 - stopped];
    if (spent_a_side_ + more > allowed) break;
    spent_a_side_ += more;
    ++stopped;
  }
  const auto cut = static_cast<std::ptrdiff_t>(stopped);
  going_on_.erase(going_on_.end() - cut, going_on_.end());
  going_on_.erase(going_on_.begin(), going_on_.begin() + cut);
  lowest_ += cut;
  needed_ = lowest_ + static_cast<std::int64_t>(going_on_.size());
}

}  // namespace tumble::scenarios
