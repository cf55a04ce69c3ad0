// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>

namespace tumble {

/// How high a rail lies at the least, element by element and side by side, by what was read: nothing is read beyond
/// one. rails.md (R75)
class LeastRails {
 public:
  void add(const Eigen::Vector3d& rate_rad_s);
  /// Whether a reading of element `axis` is short of any rail that the element can have on that side, by more than what
  /// a tilt and the noise of rails make of it.
  bool refute(const Eigen::Vector3d& rate_rad_s, Eigen::Index axis) const;
  bool operator==(const LeastRails&) const = default;

  template <class Self, class Visitor>
  static void members(Self& s, Visitor& visit) {
    visit("least_rails", s.rad_s_);
  }

 private:
  std::array<Eigen::Vector3d, 2> rad_s_{Eigen::Vector3d::Zero(),
                                        Eigen::Vector3d::Zero()};  // of negative, positive side
};

}  // namespace tumble
