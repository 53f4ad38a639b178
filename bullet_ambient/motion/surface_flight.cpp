#include "bullet_ambient/motion/surface_flight.h"

#include <algorithm>
#include <cmath>

#include "bullet_ambient/force/surface_loads.h"
#include "bullet_ambient/motion/flight_group.h"
#include "bullet_ambient/motion/passive_kick.h"
#include "bullet_ambient/spatial/cholesky.h"

namespace ambient {
namespace {

constexpr int kSurfaceAttempts = 3;
constexpr int kSurfaceSubsteps = 16;
constexpr double kFlowAccuracy = 1e-6;   // of the tolerance
constexpr double kMostSurfaceError = 2;  // of an accepted step, in tolerances

struct Pose {
  Quaternion orientation;
  Vector3 way_W;  // from where the step began
};

/// Of a body in the frame that moves with the water.
class SurfaceFlight {
 public:
  SurfaceFlight(const SurfaceTask& task, const RigidState& start, const FlightMemory& memory,
                const WaveMemory& waves)
      : task_(task), model_(task.model), memory_(memory), start_(start), start_waves_(waves) {
    const Surroundings& s = task.surroundings;
    gravity_W_ = s.gravity - s.ambient_acceleration;
    plane_W_ = {task.plane_W.normal, task.plane_W.depth(start.position), model_.excess_density,
                gravity_W_.norm()};
    wind_W_ = s.ambient_velocity - task.velocity_above;
    fall_scale_ = fallScale({model_.below, s, task.settings, task.duration});
    lanes_.has_diagonal_inertia = false;
    lanes_.active[0] = 1;
    lanes_.precision[0] = kFlowAccuracy * task.settings.tolerance;
  }

  SurfaceFlightResult fly() {
    const int most =
        task_.settings.max_substeps > 0 ? task_.settings.max_substeps : kSurfaceSubsteps;
    const double duration = task_.duration;
    const double remembered = memory_.substep > 0 ? memory_.substep : duration;
    swing_ = task_.stand.swing;
    int count = substepsOf(std::min(remembered, kLongestSwing / swing_), most);
    for (int attempt = 1;; ++attempt) {
      is_stiff_ = duration / count * swing_ > kLongestSwing * (1 + 1e-9);
      run(count, count);
      const double ratio = error_ / task_.settings.tolerance, h = duration / count;
      const double next = ratio > 0 ? std::min(4 * h, 0.9 * h / std::sqrt(ratio)) : 4 * h;
      const int needed = substepsOf(kLongestSwing / swing_, most);
      const bool is_coarse = ratio > kMostSurfaceError || has_gained_;
      const bool is_done = !is_coarse && needed <= count;
      const bool is_last = count == most || (attempt >= kSurfaceAttempts && !has_gained_);
      if (is_done || is_last) {
        if (has_gained_) halt(count);
        return resultOf(flight_count_.halted ? h : next, is_coarse);
      }
      count = std::min(
          most, std::max({has_gained_ ? 2 * count : count + 1, needed, substepsOf(next, most)}));
    }
  }

 private:
  int substepsOf(double substep, int most) const {
    const double wanted = std::ceil(task_.duration / substep * (1 - 1e-9));
    return wanted < most ? std::max(1, static_cast<int>(wanted)) : most;
  }

  SurfaceStand standHere() const {
    return standAtSurface(model_, seenFrom(plane_W_, to_world_, pose_.way_W));
  }
  void turnTo(const Quaternion& orientation) {
    pose_.orientation = orientation;
    to_world_ = orientation.toRotationMatrix();
  }
  Matrix3 toBody() const { return to_world_.transpose(); }

  DualPair motionOf(const Vector6& x) const { return {x, stand_->inertia * x}; }
  DualPair responseTo(const Wrench& load) const {
    const Vector6 f = load.vector();
    return {stand_->inverse * f, f};
  }
  WetPart partBelow(const FrameOffset& frame) const {
    return {seenFrom(stand_->plane, frame), wetShare(stand_->immersion_F, model_.shape->volume)};
  }

  /// The first `made` of `count` substeps.
  void run(int count, int made) {
    const double before = begin(), h = task_.duration / count;
    for (int substep = 0; substep < made; ++substep) advance(h);
    boundEnergy(before);
  }

  /// Returns the energy at the start of the step [J].
  double begin() {
    has_gained_ = false;
    returnToStart();
    x_ = start_.twist.vector();
    waves_ = start_waves_;
    load_W_ = memory_.load_W;
    has_load_ = memory_.has_load;
    error_ = 0;
    energy_removed_ = 0;
    lanes_.is_coarse[0] = lanes_.energy_removed[0] = 0;
    return energy();
  }

  void advance(double h) {
    beginWith(h);
    move(h);
    endWith(h);
    ++flight_count_.substeps;
  }

  /// The flow with the inertia frozen in body axes, eq. (22), and then its change.
  void move(double duration) {
    static const FlightKernel& kernel = fastestFlightKernel();
    const DualPair motion = motionOf(x_);
    const Wrench gradient = gradientAt(model_, *stand_, x_);
    setInertia(lanes_, 0, stand_->inertia, stand_->inverse, false);
    setLane(lanes_.orientation, 0, pose_.orientation);
    setLane(lanes_.way_W, 0, pose_.way_W);
    setLane(lanes_.twist_B, 0, Twist::fromVector(motion.twist));
    setLane(lanes_.momentum_B, 0, Twist::fromVector(motion.momentum));
    lanes_.flow_time[0] = duration;
    kernel.flow(lanes_);
    turnTo(orientationOf(lanes_.orientation, 0));
    pose_.way_W = vectorOf(lanes_.way_W, 0);
    x_ = twistOf(lanes_.twist_B, 0).vector();
    const Matrix6 before = stand_->inertia;
    later_stand_ = standHere();
    stand_ = &later_stand_;
    keep(passSurface({model_, before, *stand_, duration, gradient}, x_));
  }

  /// The second half of a kick of h, in reversed order: loads are still those of the first half.
  void beginWith(double h) {
    if (model_.loads_below.loads) keepLoads(h);
    if (model_.loads_above.loads) takeWindFor(h / 2);
    makeWaves(h / 2);
    x_ += h / 2 * fallOver(h);
  }

  /// The first half, at the pose where the flow has come to.
  void endWith(double h) {
    swing_ = std::max(swing_, stand_->swing);
    x_ += h / 2 * fallOver(h);
    makeWaves(h / 2);
    if (model_.loads_above.loads) takeWindFor(h / 2);
    if (model_.loads_below.loads) takeLoads(h);
  }

  void makeWaves(double h) {
    meetModes(stand_->waves, to_world_, waves_);
    x_ = exchangeWaves(stand_->waves, to_world_, stand_->inverse, h, x_, waves_);
  }

  /// Acceleration by weight, applied forces and buoyancy; where the substep is too long for the
  /// stiffness of the buoyancy, as of a mean that knows it.
  Vector6 fallOver(double h) const {
    const Vector6 wrench = (externalWrench(model_.above, task_.surroundings, to_world_) +
                            hydrostaticWrench(stand_->wet, stand_->plane))
                               .vector();
    if (!is_stiff_) return stand_->inverse * wrench;
    return Cholesky<6>(stiffInertia(*stand_, h)).solve(wrench);
  }

  Wrench loadAt(const Vector6& x) {
    const PartLoads& part = model_.loads_below;
    const Twist twist = Twist::fromVector(x);
    const Wrench wrench =
        part.frame.toB(part.loads->wetLoad(part.frame.toF(twist), partBelow(part.frame)));
    ++flight_count_.load_evaluations;
    if (!part.loads->needsGuard()) return wrench;
    const SurfaceLoad guarded = removePositivePower(wrench, twist, stand_->inertia);
    flight_count_.guarded += guarded.guarded;
    return guarded.wrench;
  }

  Wrench lastLoad() const { return {toBody() * load_W_.torque, toBody() * load_W_.force}; }
  void setLoad(const Wrench& load) {
    load_W_ = {to_world_ * load.torque, to_world_ * load.force};
    has_load_ = true;
  }

  /// Half of a kick of h, with the load that the other half has found.
  void keepLoads(double h) {
    if (!has_load_) setLoad(loadAt(x_));
    const DualPair now = motionOf(x_);
    x_ = passiveKick(now, {now, responseTo(lastLoad())}, h / 2).twist;
  }

  /// Half of a kick of h, with the load in the middle of the whole, eq. (23) to (25).
  void takeLoads(double h) {
    const Wrench guess = lastLoad();
    const DualPair now = motionOf(x_);
    const DualPair sample = passiveKick(now, {now, responseTo(guess)}, h / 2);
    const Wrench load = loadAt(sample.twist);
    x_ = passiveKick(now, {sample, responseTo(load)}, h / 2).twist;
    const Vector6 surprise = load.vector() - guess.vector();
    const double change = h * std::sqrt(std::max(0.0, surprise.dot(stand_->inverse * surprise)));
    const double scale = std::sqrt(std::max(0.0, inner(now, now))) + fall_scale_;
    if (scale > 0) error_ = std::max(error_, change / scale);
    setLoad(load);
  }

  void takeWindFor(double h) {
    x_ = takeWind({model_, *stand_, toBody() * wind_W_, h}, x_);
    ++flight_count_.load_evaluations;
  }

  double kinetic2() const { return x_.dot(stand_->inertia * x_); }

  /// Docs/theory.md eq. (64), without the kinetic energy.
  double potential() const {
    const BodyModel& above = model_.above;
    const Surroundings& s = task_.surroundings;
    const Vector3 force = s.applied.force - above.mass * s.ambient_acceleration;
    const Vector3 buoyancy = -above.displaced_mass * gravity_W_;
    const Vector3 arm = pose_.way_W + to_world_ * above.centre_of_volume;
    return hydrostaticEnergy(stand_->wet, stand_->plane) + waves_.energy() -
           force.dot(pose_.way_W) - buoyancy.dot(arm);
  }
  double energy() const { return 0.5 * kinetic2() + potential(); }

  void keep(const BoundedTwist& bounded) {
    x_ = bounded.twist;
    energy_removed_ += bounded.energy_removed;
  }

  bool mayGain() const {
    const bool has_wind = model_.loads_above.loads && !wind_W_.isZero(0);
    return has_wind || !task_.surroundings.applied.torque.isZero(0);
  }
  /// Whether the energy of place alone is more than all that there was before: `left` is the rest.
  bool isGain(double left, double before) const {
    constexpr double kRounding = 1e-13;
    return left < -kRounding * (fall_scale_ * fall_scale_ + std::abs(before));
  }
  void boundEnergy(double before) {
    if (mayGain()) return;
    const double left = before - potential();
    has_gained_ = isGain(left, before);
    keep(scaledWithin(x_, kinetic2(), std::max(0.0, 2 * left)));
  }

  /// Ends the motion after the last substep that ends where the energy reaches. Where there is no
  /// such one, the body stays where it is, at rest.
  void halt(int count) {
    const double before = begin(), h = task_.duration / count;
    int reached = 0;
    for (int substep = 1; substep <= count; ++substep) {
      advance(h);
      if (!isGain(before - potential(), before)) reached = substep;
    }
    run(count, reached);
    if (reached == 0) keep(scaledWithin(x_, kinetic2(), 0));
    flight_count_.halted = true;
  }
  void returnToStart() {
    turnTo(start_.orientation);
    pose_.way_W.setZero();
    stand_ = &task_.stand;
  }

  SurfaceFlightResult resultOf(double next_substep, bool is_coarse) {
    flight_count_.coarse = is_coarse || lanes_.is_coarse[0] > 0;
    const bool is_unknown = lanes_.is_coarse[0] > 0 || flight_count_.halted;
    if (flight_count_.coarse) flight_count_.error = is_unknown ? 1 : error_;
    flight_count_.energy_removed = energy_removed_ + lanes_.energy_removed[0];
    const RigidState state{pose_.orientation, start_.position + pose_.way_W, Twist::fromVector(x_)};
    return {{state, {load_W_, has_load_, next_substep}, flight_count_}, waves_, *stand_};
  }

  const SurfaceTask& task_;
  const SurfaceModel& model_;
  const FlightMemory& memory_;
  const RigidState& start_;
  const WaveMemory& start_waves_;
  Vector3 gravity_W_, wind_W_;
  SurfacePlane plane_W_;  // from where the step began
  double fall_scale_ = 0;
  double swing_ = 0;         // the largest natural frequency that was met [1/s]
  bool is_stiff_ = false;    // substeps are too long for the stiffness of the buoyancy
  bool has_gained_ = false;  // more energy of place than it had in all
  FlightLanes lanes_{};

  Pose pose_;
  Vector6 x_;         // in B
  Matrix3 to_world_;  // its rotation
  SurfaceStand later_stand_;
  const SurfaceStand* stand_ = nullptr;  // at the pose: that of the task, or the later one
  WaveMemory waves_;
  Wrench load_W_;
  bool has_load_ = false;
  double error_ = 0;
  double energy_removed_ = 0;  // by all but the flow [J]
  FlightCount flight_count_;
};

}  // namespace

SurfaceFlightResult flyAtSurface(const SurfaceTask& task, const RigidState& start,
                                 const FlightMemory& memory, const WaveMemory& waves) noexcept {
  const Surroundings& s = task.surroundings;
  RigidState state = start;
  state.twist.linear -= start.orientation.conjugate() * s.ambient_velocity;
  SurfaceFlightResult result = SurfaceFlight(task, state, memory, waves).fly();
  RigidState& end = result.flight.state;
  const double t = task.duration;
  end.position += t * s.ambient_velocity + t * t / 2 * s.ambient_acceleration;
  end.twist.linear +=
      end.orientation.conjugate() * (s.ambient_velocity + t * s.ambient_acceleration);
  return result;
}

}  // namespace ambient
