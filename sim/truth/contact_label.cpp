// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>

#include "sim/truth/record_truth.hpp"

namespace tumble::sim {

namespace {

constexpr std::int64_t kWindow_ns = 10'000'000;
constexpr double kGripSpeed_m_s = 0.02;

struct Sums {
  double weight = 0.0, slip = 0.0, overspin = 0.0;
};

/// Returns two speeds at a contact, weighted by the normal force:
///
/// - `slip`: the speed of the sliding contact point relative to the ground
/// - `overspin`: the speed of the contact point relative to the geometric centre, minus the tangential speed of the
///   geometric centre
Sums weigh(const Truth& truth, const ContactTruth& contact) {
  const std::size_t k = static_cast<std::size_t>(contact.time_ns / truth.period_ns);
  const Eigen::Vector3d w_W = truth.q_WB[k] * truth.w_WB_B_rad_s[k];
  const Eigen::Vector3d v_G = truth.v_WB_m_s[k] + w_W.cross(truth.q_WB[k] * truth.p_BG_m);
  const Eigen::Vector3d travel = v_G - v_G.dot(contact.normal_W) * contact.normal_W;
  const Eigen::Vector3d turn = contact.slip_velocity_W_m_s - travel;
  const double weight = std::max(contact.normal_force_n, 1e-9);
  return {weight, weight * contact.slip_velocity_W_m_s.norm(), weight * (turn.norm() - travel.norm())};
}

}  // namespace

std::vector<ContactLabel> label_contacts(const Truth& truth) {
  const std::size_t count = truth.q_WB.size();
  std::vector<Sums> at(count);
  for (const ContactTruth& contact : truth.contacts) {
    const Sums one = weigh(truth, contact);
    Sums& sum = at[static_cast<std::size_t>(contact.time_ns / truth.period_ns)];
    sum.weight += one.weight;
    sum.slip += one.slip;
    sum.overspin += one.overspin;
  }
  const std::size_t reach = static_cast<std::size_t>(kWindow_ns / truth.period_ns);
  std::vector<ContactLabel> labels(count, ContactLabel::air);
  for (std::size_t k = 0; k < count; ++k) {
    Sums sum;
    for (std::size_t j = k > reach ? k - reach : 0; j <= std::min(k + reach, count - 1); ++j) {
      sum.weight += at[j].weight;
      sum.slip += at[j].slip;
      sum.overspin += at[j].overspin;
    }
    if (sum.weight <= 0.0) continue;
    if (sum.slip < kGripSpeed_m_s * sum.weight)
      labels[k] = ContactLabel::grip;
    else
      labels[k] = sum.overspin > 0.0 ? ContactLabel::slip : ContactLabel::slide;
  }
  return labels;
}

}  // namespace tumble::sim
