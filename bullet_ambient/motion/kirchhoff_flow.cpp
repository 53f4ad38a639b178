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

SeriesStart seriesStart(const BodyModel& model, const Twist& twist, double duration,
                        double precision) {
  SeriesStart start;
  Eigen::Map<Eigen::Matrix<double, 6, 6>>(start.inverse_inertia[0]) = model.inverse_inertia;
  Eigen::Map<Vector6>(start.momentum) = model.inertia * twist.vector();
  Eigen::Map<Vector6>(start.twist) = twist.vector();
  start.duration = duration;
  start.precision = precision;
  return start;
}

RigidState endState(const BodyModel& model, const RigidState& start, const SeriesEnd& series) {
  const double* q = series.turn;
  RigidState end;
  end.orientation = (start.orientation * Quaternion(q[3], q[0], q[1], q[2])).normalized();
  end.position = start.position + end.orientation * Eigen::Map<const Vector3>(series.way);
  end.twist = Twist::fromVector(model.inverse_inertia * Eigen::Map<const Vector6>(series.momentum));
  return end;
}

// Scales the twist down to the energy that it had.
RigidState withoutGain(const BodyModel& model, RigidState end, double energy_norm_sq) {
  const double after = inertiaNormSquared(model, end.twist.vector());
  if (after > energy_norm_sq) {
    const double scale = std::sqrt(energy_norm_sq / after);
    end.twist = {scale * end.twist.angular, scale * end.twist.linear};
  }
  return end;
}

// Turns with the present angular velocity. World momentum stays: it gives the twist in the end.
RigidState coast(const BodyModel& model, const RigidState& state, double duration) {
  const WorldMomentum momentum = worldMomentum(model, state);
  RigidState end;
  end.orientation =
      (state.orientation * rotationFromVector(duration * state.twist.angular)).normalized();
  end.position = state.position + state.orientation * (duration * state.twist.linear);
  end.twist = twistOf(model, momentum, end.orientation, end.position);
  return end;
}

}  // namespace

Flow flowWithoutLoads(const BodyModel& model, const RigidState& state, double duration,
                      double precision) noexcept {
  static const SumMotionSeries sum_series = fastestMotionSeries();
  const double energy_norm_sq = inertiaNormSquared(model, state.twist.vector());
  if (!(energy_norm_sq > 0)) return {state};
  RigidState end = state;
  double left = duration;
  for (int i = 0; i < kMaxPieces && left > 0; ++i) {
    const SeriesEnd series = sum_series(seriesStart(model, end.twist, left, precision));
    end = endState(model, end, series);
    left -= series.fraction * left;
  }
  const bool is_precise = !(left > 0);
  if (!is_precise) end = coast(model, end, left);
  return {withoutGain(model, end, energy_norm_sq), is_precise};
}

}  // namespace ambient
