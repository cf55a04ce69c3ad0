// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "imu_members.hpp"
#include "tumble/common/detail/outlier_filter.hpp"

/// outlier_filter_members.hpp lists the members of OutlierFilter's state, for saving (see state_visitor.hpp).
namespace tumble {

template <StateOf<OutlierFilter::State> Self, class Visitor>
void members(Self& s, Visitor& visit) {
  visit("outliers.passed", s.recent_inliers);
  visit("outliers.count", s.count, 0.0, 2.0);
  visit("outliers.held", s.delayed);
  visit("outliers.rejected", s.rejected);
}

}  // namespace tumble
