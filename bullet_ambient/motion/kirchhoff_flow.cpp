#include "bullet_ambient/motion/kirchhoff_flow.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "bullet_ambient/motion/kirchhoff.h"
#include "bullet_ambient/motion/rotation.h"

namespace ambient {
namespace {

constexpr int kMaxOrder = 18;
constexpr double kRounding = 1e-15;  // a term below it, relative to the motion, is zero
constexpr int kMaxPieces = 64;       // series per call

// Kirchhoff's equations in body axes are bilinear, so that the coefficients of their power series
// follow from one another by sums of cross products (Jorba and Zou 2005 on such integrators):
//   l' = l x w + p x v,   p' = p x w,   (w, v) = K^-1 (l, p),
//   r' = r x w + v,       q' = 1/2 q w,
// r being the way from the start in body axes, y = y_0 + R r, and q the turn since the start.
// Coefficients are scaled to t = fraction of the duration.
class MotionSeries {
 public:
  MotionSeries(const BodyModel& model, const Twist& start, double duration)
      : model_(model), duration_(duration) {
    const Vector6 momentum = model.inertia * start.vector();
    c_[0] = {momentum.head<3>(),
             momentum.tail<3>(),
             start.angular,
             start.linear,
             Vector3::Zero(),
             Vector3::Zero(),
             1.0};
    energy_ = momentum.dot(start.vector());
    double size = size_sq_[0] = 1;
    do {
      addTerm();
      size = std::max(size_sq_[order_], size_sq_[order_ - 1]);
    } while (!(size <= kRounding * kRounding) && order_ < kMaxOrder);
  }

  // Largest fraction of the duration at which the series still holds to rounding.
  double reach() const {
    return std::min(reachOfTerm(order_), order_ > 1 ? reachOfTerm(order_ - 1) : 1.0);
  }

  RigidState at(double fraction, const RigidState& start) const {
    Coefficient sum = c_[order_];
    for (int k = order_ - 1; k >= 0; --k) {
      const Coefficient& c = c_[k];
      sum.l = c.l + fraction * sum.l;
      sum.p = c.p + fraction * sum.p;
      sum.r = c.r + fraction * sum.r;
      sum.turn = c.turn + fraction * sum.turn;
      sum.cosine = c.cosine + fraction * sum.cosine;
    }
    RigidState end;
    const Quaternion turn(sum.cosine, sum.turn.x(), sum.turn.y(), sum.turn.z());
    end.orientation = (start.orientation * turn).normalized();
    end.position = start.position + end.orientation * sum.r;
    end.twist = Twist::fromVector(model_.inverse_inertia * stack(sum.l, sum.p));
    return end;
  }

 private:
  struct Coefficient {
    Vector3 l, p, w, v, r;
    Vector3 turn;  // vector part of q
    double cosine;
  };

  void addTerm() {
    const int k = order_;
    Coefficient rate;
    rate.l = rate.p = rate.turn = Vector3::Zero();
    rate.r = c_[k].v;
    rate.cosine = 0;
    for (int i = 0; i <= k; ++i) {
      const Coefficient& a = c_[i];
      const Coefficient& b = c_[k - i];
      rate.l += a.l.cross(b.w) + a.p.cross(b.v);
      rate.p += a.p.cross(b.w);
      rate.r += a.r.cross(b.w);
      rate.turn += a.cosine * b.w + a.turn.cross(b.w);
      rate.cosine -= a.turn.dot(b.w);
    }
    const double step = duration_ / (k + 1);
    Coefficient& next = c_[k + 1];
    next.l = step * rate.l;
    next.p = step * rate.p;
    next.r = step * rate.r;
    next.turn = step / 2 * rate.turn;
    next.cosine = step / 2 * rate.cosine;
    const Twist x = Twist::fromVector(model_.inverse_inertia * stack(next.l, next.p));
    next.w = x.angular;
    next.v = x.linear;
    ++order_;
    size_sq_[order_] = std::max((next.l.dot(next.w) + next.p.dot(next.v)) / energy_,
                                next.turn.squaredNorm() + next.cosine * next.cosine);
  }

  double reachOfTerm(int k) const {
    const double excess = size_sq_[k] / (kRounding * kRounding);
    return excess > 1 ? std::pow(excess, -0.5 / k) : 1.0;
  }

  const BodyModel& model_;
  double duration_;
  double energy_;
  int order_ = 0;
  std::array<Coefficient, kMaxOrder + 1> c_;
  std::array<double, kMaxOrder + 1> size_sq_;  // in the norms of K^-1 and of the quaternion
};

// Turns with the present angular velocity. World momentum stays: it gives the twist in the end.
RigidState coast(const BodyModel& model, const RigidState& state, double duration) {
  const WorldMomentum momentum = worldMomentum(model, state);
  RigidState end;
  end.orientation =
      (state.orientation * rotationFromVector(duration * state.twist.angular)).normalized();
  end.position = state.position + state.orientation * (duration * state.twist.linear);
  end.twist = twistOf(model, momentum, end.orientation, end.position);
  const double before = inertiaNormSquared(model, state.twist.vector());
  const double after = inertiaNormSquared(model, end.twist.vector());
  if (after > before) {
    const double scale = std::sqrt(before / after);
    end.twist = {scale * end.twist.angular, scale * end.twist.linear};
  }
  return end;
}

}  // namespace

RigidState flowWithoutLoads(const BodyModel& model, const RigidState& state,
                            double duration) noexcept {
  if (!(inertiaNormSquared(model, state.twist.vector()) > 0)) return state;
  RigidState end = state;
  double left = duration;
  for (int i = 0; i < kMaxPieces; ++i) {
    const MotionSeries series(model, end.twist, left);
    const double fraction = series.reach();
    end = series.at(fraction, end);
    if (fraction == 1) return end;
    left -= fraction * left;
  }
  return coast(model, end, left);
}

}  // namespace ambient
