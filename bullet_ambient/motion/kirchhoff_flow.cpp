#include "bullet_ambient/motion/kirchhoff_flow.h"

#include <cmath>

#include "bullet_ambient/motion/kirchhoff.h"
#include "bullet_ambient/motion/motion_series.h"
#include "bullet_ambient/motion/rotation.h"

namespace ambient {
namespace {

constexpr int kMaxPieces = 1024;  // series per call

SumMotionSeries fastestMotionSeries() noexcept {
#if defined(__x86_64__)
  if (hasAvx2MotionSeries()) return sumMotionSeriesAvx2;
#endif
  return sumMotionSeriesBaseline;
}

SeriesStart seriesStart(const BodyModel& model, const DualPair& motion, double duration,
                        double precision) {
  SeriesStart start;
  start.inverse_inertia = model.inverse_inertia.data();
  start.has_diagonal_inertia = model.has_diagonal_inertia;
  Eigen::Map<Vector6>(start.momentum) = motion.momentum;
  Eigen::Map<Vector6>(start.twist) = motion.twist;
  start.duration = duration;
  start.precision = precision;
  return start;
}

MomentumState endState(const BodyModel& model, const MomentumState& start,
                       const SeriesEnd& series) {
  const double* q = series.turn;
  MomentumState end;
  end.orientation = (start.orientation * Quaternion(q[3], q[0], q[1], q[2])).normalized();
  end.position = start.position + end.orientation * Eigen::Map<const Vector3>(series.way);
  end.motion = pairOfMomentum(model, Eigen::Map<const Vector6>(series.momentum));
  return end;
}

// Scales the motion down to the energy that it had. That is x.K x of the twist that was rounded
// last: K^-1 K is the identity only up to the condition of K.
MomentumState withoutGain(const BodyModel& model, MomentumState end, double energy_norm_sq) {
  end.motion = pairOfTwist(model, end.motion.twist);
  const double after = inner(end.motion, end.motion);
  if (after > energy_norm_sq) end.motion = std::sqrt(energy_norm_sq / after) * end.motion;
  return end;
}

// Turns with the present angular velocity. World momentum stays: it gives the twist in the end.
MomentumState coast(const BodyModel& model, const MomentumState& start, double duration) {
  const RigidState state = start.rigidState();
  const WorldMomentum momentum = worldMomentum(model, state);
  RigidState end;
  end.orientation =
      (state.orientation * rotationFromVector(duration * state.twist.angular)).normalized();
  end.position = state.position + state.orientation * (duration * state.twist.linear);
  end.twist = twistOf(model, momentum, end.orientation, end.position);
  return MomentumState::of(model, end);
}

}  // namespace

Flow flowWithoutLoads(const BodyModel& model, const MomentumState& state, double duration,
                      double precision) noexcept {
  static const SumMotionSeries sum_series = fastestMotionSeries();
  const double energy_norm_sq = inner(state.motion, state.motion);
  if (!(energy_norm_sq > 0)) return {state};
  MomentumState end = state;
  double left = duration;
  for (int i = 0; i < kMaxPieces && left > 0; ++i) {
    const SeriesEnd series = sum_series(seriesStart(model, end.motion, left, precision));
    end = endState(model, end, series);
    left -= series.fraction * left;
  }
  const bool is_precise = !(left > 0);
  if (!is_precise) end = coast(model, end, left);
  return {withoutGain(model, end, energy_norm_sq), is_precise};
}

}  // namespace ambient
