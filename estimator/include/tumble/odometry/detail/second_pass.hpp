// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <vector>

#include "tumble/angular_velocity/rest_detector.hpp"
#include "tumble/common/parameters.hpp"
#include "tumble/odometry/detail/odometry_pass.hpp"

namespace tumble {

/// What a first pass learns too late is put right by a second one over the same readings, while the first goes on.
///
/// The first seconds of a tumble are mapped with a lever arm, a mounting and a clock that they are only about to tell.
/// So samples and sweeps are remembered from the end of the rest at the start on. After `after_s` of motion they are
/// passed through again, with the rig and the calibration as learnt until then and rates that have `lag_s` ahead of
/// them, `sweeps` sweeps for each that comes. When the second pass has caught up, its map and its pose take the place
/// of those of the first one, unless it is lost or rejected clearly more sweeps, and what was remembered is forgotten.
/// A first pass that has been lost for `lost_s` is not waited for: all is passed through at once, once, and again after
/// `after_s`. Poses that were given out stay: the pose moves by what the first pass was off, and one that was lost is
/// found.
///
/// Memory: samples and sweeps of `rest_s` and of at most `remembered_s` of motion, and for as long a second map. Not
/// modelled: a third pass with what the second has learnt; a jolt that ends the rest long before the tumble.
class SecondPass {
 public:
  struct Params {
    double after_s = 3.0;        ///< of motion, after which the second pass begins; 0: there is none
    double lost_s = 0.4;         ///< or after the first pass has rejected sweeps for so long; 0: that begins nothing
    double lag_s = 0.5;          ///< of its rates
    std::size_t sweeps = 3;      ///< that it takes for each that comes; two at least, or it never catches up
    double remembered_s = 10.0;  ///< where it has not caught up within this of motion it is given up
    /// What was learnt is learnt again from the same readings: its variance counts so many times.
    double inflation = 4.0;
    double rest_s = 1.0;  ///< of the rest at the start that is remembered

    /// Every number of it, stated once.
    template <class Self, class Visitor>
    static void fields(Self& p, Visitor& visit) {
      visit(p.after_s, {"after_s", "s", 0.0, 100.0,
                        "motion time after which the second pass processes all data with the calibration; 0: never"});
      visit(p.lost_s, {"lost_s", "s", 0.0, 100.0,
                       "time without a registered sweep after which the second pass starts early, once; 0: never"});
      visit(p.lag_s, {"lag_s", "s", 0.0, 10.0, "age of a sample in the second pass when its rate is reported"});
      visit(p.sweeps, {"sweeps", "1", 2, 1000, "sweeps that the second pass processes per new sweep"});
      visit(p.remembered_s, {"remembered_s", "s", 0.0, 1000.0,
                             "longest motion that is stored; the second pass must catch up within it"});
      visit(p.inflation,
            {"inflation", "1", 1.0, 1e6, "factor on the variance of the calibration that the second pass starts with"});
      visit(p.rest_s, {"rest_s", "s", 0.1, 100.0, "longest part of the initial rest that is stored"});
    }
  };

  /// `rate`, `mapping`: of the first pass. Throws InvalidParams on a parameter outside of its bound.
  SecondPass(const Params& params, const RegimeStream::Params& rate, const LidarInertialOdometry::Params& mapping);

  /// A sample that the first pass has taken. No allocation.
  void remember(const ImuSample& sample);
  /// A sweep that the first pass has registered, with the reading of an odometer if there was one.
  void remember(TimeNs start_ns, TimeNs end_ns, std::vector<LidarPoint> points,
                const std::optional<OdometerReading>& reading, SweepVerdict verdict);

  /// Goes on, after a sweep of the first pass; where it has caught up the map of `first` becomes its own.
  void advance(OdometryPass& first);
  /// The same to its end, where it has begun.
  void complete(OdometryPass& first);
  /// Forgets everything; there will be none.
  void give_up();

  bool under_way() const { return pass_.has_value(); }
  /// Whether the map became that of the second pass.
  bool taken() const { return taken_; }

  /// Stated once, in the library's own sources: state_visitor.hpp.
  template <class Self, class Visitor>
  static void members(Self& s, Visitor& visit);
  /// What holds between the members of every state, beside that first pass; the first that does not.
  Status check_state(const OdometryPass& first) const;

 private:
  struct Sweep {
    TimeNs start_ns = 0, end_ns = 0;
    std::vector<LidarPoint> points;
    std::optional<OdometerReading> reading;
    SweepVerdict verdict = SweepVerdict::first;  ///< of the first pass
    template <class Self, class Visitor>
    static void members(Self& s, Visitor& visit);
  };

  bool is_due() const;
  bool first_is_lost() const;
  bool begin(const OdometryPass& first);
  void run(OdometryPass& first, std::size_t sweeps);
  void take_over(OdometryPass& first);
  RegimeStream::Params lagging_rate() const;
  RegimeStream::Params learnt_rate(const OdometryPass& first) const;
  LidarInertialOdometry::Params learnt_mapping(const OdometryPass& first) const;

  Params params_;
  RegimeStream::Params rate_;
  LidarInertialOdometry::Params mapping_;
  bool wanted_, taken_ = false;
  RestDetector rests_;  ///< with the mapper's numbers
  RestDetector::State rest_;
  std::optional<TimeNs> moves_ns_;  ///< end of the rest at the start
  OdometryPass::Queue samples_;
  std::deque<Sweep> sweeps_;
  std::optional<OdometryPass> pass_;
  std::size_t next_sample_ = 0, next_sweep_ = 0;
  std::size_t rejected_by_first_ = 0, rejected_ = 0;
  bool lost_ = false;                   ///< the second pass rejected its last sweep
  bool early_ = false, tried_ = false;  ///< it began because the first was lost; that has been, for good or not
};

}  // namespace tumble
