#include "bullet_ambient/motion/surface_flight.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>

#include "bullet_ambient/force/surface_loads.h"
#include "bullet_ambient/motion/flight_group.h"
#include "bullet_ambient/motion/passive_kick.h"
#include "bullet_ambient/motion/surface_passage.h"

namespace ambient {
namespace {

constexpr int kSurfaceAttempts = 3;
constexpr int kSurfaceSubsteps = 16;
constexpr double kLongestSwing = 0.5;    // substep times the largest natural frequency
constexpr double kFlowAccuracy = 1e-6;   // of the tolerance
constexpr double kMostSurfaceError = 2;  // of an accepted step, in tolerances

using Matrix = Eigen::Matrix<double, 6, 6>;

Matrix6 inverseOf(const Matrix6& K) {
  const Matrix6 inverse = Eigen::LLT<Matrix>(K).solve(Matrix::Identity());
  return 0.5 * (inverse + inverse.transpose());
}

/// A body at one pose against the surface; in B.
struct Stand {
  Matrix3 to_world;
  SurfacePlane plane;
  double draught, cover;
  Immersion immersion_F;
  WetVolume wet;
  Matrix6 inertia, inverse;
  WaveModes modes;

  DualPair motion(const Vector6& x) const { return {x, inertia * x}; }
  DualPair load(const Wrench& wrench) const {
    const Vector6 f = wrench.vector();
    return {inverse * f, f};
  }
  WetPart partBelow(const FrameOffset& frame, double volume) const {
    return {seenFrom(plane, frame), wetShare(immersion_F, volume)};
  }
};

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
    const Stand begin = standAt({start_.orientation, Vector3::Zero()});
    const int most =
        task_.settings.max_substeps > 0 ? task_.settings.max_substeps : kSurfaceSubsteps;
    double substep = task_.duration;
    if (memory_.substep > 0) substep = std::min(substep, memory_.substep);
    substep = std::min(substep, kLongestSwing / swingOf(begin));
    int count = substepsOf(substep, most);
    for (int attempt = 1;; ++attempt) {
      run(begin, count);
      const double ratio = error_ / task_.settings.tolerance, h = task_.duration / count;
      const double next = ratio > 0 ? std::min(4 * h, 0.9 * h / std::sqrt(ratio)) : 4 * h;
      if (!(ratio > kMostSurfaceError) || attempt == kSurfaceAttempts || count == most)
        return resultOf(next, ratio > kMostSurfaceError && count == most);
      count = std::max(count + 1, substepsOf(next, most));
    }
  }

 private:
  int substepsOf(double substep, int most) const {
    const double wanted = std::ceil(task_.duration / substep * (1 - 1e-9));
    return wanted < most ? std::max(1, static_cast<int>(wanted)) : most;
  }

  Stand standAt(const Pose& pose) const {
    Stand stand;
    stand.to_world = pose.orientation.toRotationMatrix();
    stand.plane = seenFrom(plane_W_, stand.to_world, pose.way_W);
    stand.immersion_F = immersionOf(model_, stand.plane);
    stand.draught = stand.immersion_F.draught();
    stand.cover = stand.immersion_F.cover();
    stand.wet = stand.immersion_F.wet.inB(model_.fluid_frame);
    stand.inertia = inertiaAt(model_, stand.immersion_F);
    stand.inverse = inverseOf(stand.inertia);
    stand.modes = modesAt(stand);
    return stand;
  }

  WaveModes modesAt(const Stand& stand) const {
    const Vector3& s = stand.plane.normal;
    const Matrix3 fluid =
        (stand.inertia - model_.above.inertia).bottomRightCorner<3, 3>() / model_.excess_density;
    const double along = model_.excess_density > 0 ? s.dot(fluid * s) : 0;
    return waveModesOf({stand.wet, stand.plane, model_.heave_factor * along, model_.wave_damping});
  }

  static std::array<const WaveMode*, 3> modesOf(const Stand& stand) {
    return {&stand.modes.heave, &stand.modes.tilt[0], &stand.modes.tilt[1]};
  }

  /// The largest natural frequency [1/s].
  double swingOf(const Stand& stand) const {
    double square = 1e-12;
    for (const WaveMode* mode : modesOf(stand)) {
      const double inertia = mode->motion.dot(stand.inertia * mode->motion);
      if (inertia > 0) square = std::max(square, mode->stiffness / inertia);
    }
    return std::sqrt(square);
  }

  void run(const Stand& begin, int count) {
    pose_ = {start_.orientation, Vector3::Zero()};
    x_ = start_.twist.vector();
    waves_ = start_waves_;
    load_W_ = memory_.load_W;
    has_load_ = memory_.has_load;
    error_ = 0;
    stand_ = begin;
    meetModes(stand_.modes, stand_.to_world, waves_);
    const double before = energy(), h = task_.duration / count;
    move(h / 2);
    for (int substep = 1; substep <= count; ++substep) {
      kick(h);
      move(substep < count ? h : h / 2);
    }
    meetModes(stand_.modes, stand_.to_world, waves_);
    boundEnergy(before);
    flight_count_.substeps += count;
  }

  /// The flow with the inertia frozen in body axes, eq. (22), and then its change.
  void move(double duration) {
    static const FlightKernel& kernel = fastestFlightKernel();
    const DualPair motion = stand_.motion(x_);
    const Wrench gradient = gradientAt(stand_);
    setInertia(lanes_, 0, stand_.inertia, stand_.inverse, false);
    setLane(lanes_.orientation, 0, pose_.orientation);
    setLane(lanes_.way_W, 0, pose_.way_W);
    setLane(lanes_.twist_B, 0, Twist::fromVector(motion.twist));
    setLane(lanes_.momentum_B, 0, Twist::fromVector(motion.momentum));
    lanes_.flow_time[0] = duration;
    kernel.flow(lanes_);
    pose_ = {orientationOf(lanes_.orientation, 0), vectorOf(lanes_.way_W, 0)};
    x_ = twistOf(lanes_.twist_B, 0).vector();
    pass(duration, gradient);
  }

  /// F_K, eq. (66).
  Wrench gradientAt(const Stand& stand) const {
    const FrameOffset& frame = model_.fluid_frame;
    const Immersion& at = stand.immersion_F;
    const Twist in_F = frame.toF(Twist::fromVector(x_));
    return model_.excess_density * frame.toB(model_.wetted->gradient(at, in_F).wrench(at.plane));
  }

  void pass(double duration, const Wrench& gradient) {
    const Matrix6 before = stand_.inertia;
    stand_ = standAt(pose_);
    const double volume = stand_.wet.volume;
    const Vector3 centre =
        volume > 0 ? Vector3(stand_.wet.moment / volume) : model_.above.centre_of_volume;
    x_ = passSurface({before, stand_.inertia, stand_.inverse, gradient, stand_.plane.normal, centre,
                      stand_.draught, stand_.cover, plane_W_.gravity, duration},
                     x_);
  }

  void kick(double h) {
    meetModes(stand_.modes, stand_.to_world, waves_);
    const Vector6 fall = h / 2 * fallOver(h);
    x_ += fall;
    if (model_.loads_below.loads) takeLoads(h);
    if (model_.loads_above.loads) takeWind(h);
    x_ = exchangeWaves(stand_.modes, stand_.to_world, stand_.inverse, h, x_, waves_);
    x_ += fall;
  }

  /// Acceleration by weight, applied forces and buoyancy; where the substep is too long for the
  /// stiffness of the buoyancy, as of a mean that knows it.
  Vector6 fallOver(double h) const {
    const Vector6 wrench = (externalWrench(model_.above, task_.surroundings, stand_.to_world) +
                            hydrostaticWrench(stand_.wet, stand_.plane))
                               .vector();
    if (!(h * swingOf(stand_) > 1.01 * kLongestSwing)) return stand_.inverse * wrench;
    Matrix K = stand_.inertia;
    for (const WaveMode* mode : modesOf(stand_))
      K += h * h / 4 * std::max(0.0, mode->stiffness) * mode->motion * mode->motion.transpose();
    return Eigen::LLT<Matrix>(K).solve(wrench);
  }

  Wrench loadAt(const Vector6& x) {
    const PartLoads& part = model_.loads_below;
    const Twist twist = Twist::fromVector(x);
    const Wrench wrench = part.frame.toB(part.loads->wetLoad(
        part.frame.toF(twist), stand_.partBelow(part.frame, model_.shape->volume)));
    ++flight_count_.load_evaluations;
    if (!part.loads->needsGuard()) return wrench;
    const SurfaceLoad guarded = removePositivePower(wrench, twist, stand_.inertia);
    flight_count_.guarded += guarded.guarded;
    return guarded.wrench;
  }

  /// Eq. (23) to (25).
  void takeLoads(double h) {
    const Matrix3& R = stand_.to_world;
    const Wrench guess = has_load_
                             ? Wrench{R.transpose() * load_W_.torque, R.transpose() * load_W_.force}
                             : loadAt(x_);
    const DualPair now = stand_.motion(x_);
    const DualPair sample = passiveKick(now, {now, stand_.load(guess)}, h / 2);
    const Wrench load = loadAt(sample.twist);
    x_ = passiveKick(now, {sample, stand_.load(load)}, h).twist;
    const Vector6 surprise = load.vector() - guess.vector();
    const double change = h * std::sqrt(std::max(0.0, surprise.dot(stand_.inverse * surprise)));
    const double scale = std::sqrt(std::max(0.0, inner(now, now))) + fall_scale_;
    if (scale > 0) error_ = std::max(error_, change / scale);
    load_W_ = {R * load.torque, R * load.force};
    has_load_ = true;
  }

  /// In the frame of the fluid above.
  void takeWind(double h) {
    const PartLoads& part = model_.loads_above;
    const Vector6 shift = stack(Vector3::Zero(), stand_.to_world.transpose() * wind_W_);
    const DualPair motion = stand_.motion(x_ + shift);
    WetPart in_air = stand_.partBelow(part.frame, model_.shape->volume);
    in_air = {in_air.plane.flipped(), 1 - in_air.share};
    const Twist twist = Twist::fromVector(motion.twist);
    const Wrench wrench = part.frame.toB(part.loads->wetLoad(part.frame.toF(twist), in_air));
    ++flight_count_.load_evaluations;
    x_ = passiveKick(motion, {motion, stand_.load(wrench)}, h).twist - shift;
  }

  double kinetic2() const { return x_.dot(stand_.inertia * x_); }

  /// Docs/theory.md eq. (64), without the kinetic energy.
  double potential() const {
    const BodyModel& above = model_.above;
    const Surroundings& s = task_.surroundings;
    const Vector3 force = s.applied.force - above.mass * s.ambient_acceleration;
    const Vector3 buoyancy = -above.displaced_mass * gravity_W_;
    const Vector3 arm = pose_.way_W + stand_.to_world * above.centre_of_volume;
    return hydrostaticEnergy(stand_.wet, stand_.plane) + waves_.energy() - force.dot(pose_.way_W) -
           buoyancy.dot(arm);
  }
  double energy() const { return 0.5 * kinetic2() + potential(); }

  void boundEnergy(double before) {
    const bool has_wind = model_.loads_above.loads && !wind_W_.isZero(0);
    if (has_wind || !task_.surroundings.applied.torque.isZero(0)) return;
    const double has = kinetic2(), allowed = std::max(0.0, 2 * (before - potential()));
    if (has > allowed) x_ *= std::sqrt(allowed / has);
  }

  SurfaceFlightResult resultOf(double next_substep, bool is_coarse) {
    flight_count_.coarse = is_coarse || lanes_.is_coarse[0] > 0;
    if (flight_count_.coarse) flight_count_.error = lanes_.is_coarse[0] > 0 ? 1 : error_;
    const RigidState state{pose_.orientation, start_.position + pose_.way_W, Twist::fromVector(x_)};
    return {{state, {load_W_, has_load_, next_substep}, flight_count_}, waves_};
  }

  const SurfaceTask& task_;
  const SurfaceModel& model_;
  const FlightMemory& memory_;
  const RigidState& start_;
  const WaveMemory& start_waves_;
  Vector3 gravity_W_, wind_W_;
  SurfacePlane plane_W_;  // from where the step began
  double fall_scale_ = 0;
  FlightLanes lanes_{};

  Pose pose_;
  Vector6 x_;  // in B
  Stand stand_;
  WaveMemory waves_;
  Wrench load_W_;
  bool has_load_ = false;
  double error_ = 0;
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
