#include "bullet_ambient/motion/surface/surface_flight.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/force/loads/surface_loads.h"
#include "bullet_ambient/motion/flight/flight.h"
#include "bullet_ambient/motion/surface/flotation.h"
#include "bullet_ambient/spatial/inertia.h"

namespace ambient {
namespace {

constexpr int kSurfaceAttempts = 3;
constexpr int kSurfaceSubsteps = 16;
constexpr double kDriftAccuracy = 1e-6;  // of the tolerance
constexpr double kMostSurfaceError = 2;  // of an accepted step, in tolerances

/// Progress of one body through a step, in the frame that moves with the water.
struct Progress {
  SurfaceFlight* flight = nullptr;
  RigidState start;
  Vector3 wind_W;
  FlightCount count;
  int most = 0;                   ///< largest number of substeps
  int substeps = 0;               ///< number of substeps of this attempt
  int made = 0;                   ///< number of them that are made
  bool is_done = false;           ///< an attempt was accepted
  bool has_load = false;          ///< flight.load_W holds a load
  Growth growth;                  ///< of the resistance with it
  bool has_gained = false;        ///< more energy of place than it had in all
  double rounding = 0;            ///< energy at the start less that at the flotation [J]
  double frequency = 0;           ///< the largest natural frequency that was met [1/s]
  double energy = 0;              ///< at the start of the step [J]
  double energy_removed = 0;      ///< by the bound of the energy [J]
  double error = 0;               ///< the largest of the substeps, eq. (25) and (68b)
  SurfacePlace later;             ///< where a substep has come to
  WaterInside inside;             ///< there
  Matrix3 to_world;               ///< B to W there, of a body with water in its holds
  WaterLeft left;                 ///< water in the holds where a substep begins
  SurfacePlace* place = nullptr;  ///< that of now: that of the flotation at the start, or `later`

  const SurfaceModel& model() const { return flight->model; }
  /// True: there is water in the holds.
  bool hasWater() const { return place->inside_F != nullptr; }
  Sloshing* sloshing() const { return flight->water.sloshing->moved.data(); }
};

/// Whether the step may give energy to the body.
bool mayGain(const Progress& progress) {
  const bool has_wind = progress.model().loads_above.loads && !progress.wind_W.isZero(0);
  return has_wind || progress.flight->surroundings.hasTorque();
}

/// Flights of several bodies, one per lane.
class SurfaceFlights {
 public:
  SurfaceFlights(SurfaceFlight* const* flights, int count)
      : kernel_(*kSurfaceKernels.fastest()),
        flight_kernel_(*kFlightKernels.fastest()),
        count_(count) {
    AMBIENT_ASSERT(count > 0 && count <= kFlightLanes);
    lanes_.flight.has_diagonal_inertia = lanes_.flight.has_resistance = false;
    for (int i = 0; i < count; ++i) begin(i, *flights[i]);
  }

  void fly() {
    for (int attempt = 1;; ++attempt) {
      if (!choose([&](int i) { return !progress_[i].is_done; })) return;
      restart();
      for (int i = 0; i < count_; ++i) progress_[i].made = progress_[i].substeps;
      run();
      for (int i = 0; i < count_; ++i)
        if (!progress_[i].is_done) acceptOrRepeat(i, attempt);
    }
  }

 private:
  /// Makes the bodies of a condition the active ones. False: there are none.
  template <class Condition>
  bool choose(const Condition& condition) {
    bool is_any = false;
    for (int i = 0; i < count_; ++i) {
      const bool is_chosen = condition(i);
      lanes_.flight.active[i] = lanes_.flotation.active[i] = is_chosen ? 1 : 0;
      is_any = is_any || is_chosen;
    }
    return is_any;
  }
  bool isActive(int i) const { return lanes_.flight.active[i] > 0; }

  void begin(int i, SurfaceFlight& flight) {
    const Surroundings& s = flight.surroundings;
    const FlightTask above{flight.model.above, s, flight.settings, flight.duration};
    Progress& p = progress_[i];
    p.flight = &flight;
    p.start = flight.body.state;
    enterFrame(s, p.start);
    p.wind_W = s.ambient_velocity - flight.velocity_above;
    setSurroundings(lanes_.flight, i, above);
    lanes_.flight.velocity_scale[i] =
        velocityScale({flight.model.below, s, flight.settings, flight.duration});
    lanes_.flight.precision[i] = kDriftAccuracy * flight.settings.tolerance;
    setLane(lanes_.flight.centre_of_volume_B, i, flight.model.above.centre_of_volume);
    setLane(lanes_.normal_W, i, flight.plane_W.normal);
    const SurfacePlane plane_B =
        seenFrom(flight.plane_W, p.start.orientation.toRotationMatrix(), p.start.position);
    lanes_.height_W[i] = plane_B.height;
    p.rounding = energyOfRounding(flight.model, flight.flotation, plane_B);
    setLane(lanes_.wind_W, i, p.wind_W);
    AMBIENT_ASSERT(flight.duration > 0 && isUnit(flight.plane_W.normal));
    has_loads_below_ = has_loads_below_ || flight.model.loads_below.loads;
    lanes_.flight.has_resistance =
        lanes_.flight.has_resistance || flight.model.loads_below.resistance;
    has_loads_above_ = has_loads_above_ || flight.model.loads_above.loads;
    has_still_axis_ = has_still_axis_ || !flight.model.still_axis_B.isZero(0);
    p.most = flight.settings.max_substeps > 0 ? flight.settings.max_substeps : kSurfaceSubsteps;
    p.frequency = flight.flotation.frequency;
    const double remembered =
        flight.body.memory.substep > 0 ? flight.body.memory.substep : flight.duration;
    p.substeps =
        substepsFor(flight.duration, std::min(remembered, kLongestPhase / p.frequency), p.most);
  }

  void restartBody(int i) {
    Progress& p = progress_[i];
    const SurfaceFlight& flight = *p.flight;
    const double h = flight.duration / p.substeps;
    lanes_.flight.kick_time[i] = lanes_.flight.drift_time[i] = h;
    lanes_.is_stiff[i] = h * p.frequency > kLongestPhase * (1 + 1e-9) ? 1 : 0;
    setLane(lanes_.flight.orientation, i, p.start.orientation);
    setLane(lanes_.flight.displacement_W, i, Vector3(0, 0, 0));
    setLane(lanes_.flight.twist_B, i, p.start.twist);
    setLane(lanes_.flight.inertia, i, flight.flotation.inertia);
    setLane(lanes_.flight.inverse_inertia, i, flight.flotation.inverse);
    setFlotation(lanes_.flotation, i, p.model(), flight.flotation);
    p.place = &flight.flotation;
    forEachNumber(lanes_.waves, flight.waves,
                  [&](FlightLane& to, const double& from) { to[i] = from; });
    const FlightMemory& memory = flight.body.memory;
    p.has_load = memory.has_load && p.model().loads_below.loads;
    setLane(lanes_.flight.load_W, i, p.has_load ? memory.load_W : Wrench{});
    setResistance(lanes_.flight, i, p.model().loads_below.resistance.get());
    setGrowth(i, p.has_load ? memory.growth : kCreeping);
    lanes_.flight.is_coarse[i] = lanes_.flight.energy_removed[i] = 0;
    p.error = p.energy_removed = 0;
    p.has_gained = false;
    if (!p.hasWater()) return;
    turnWater(i);
    VesselSloshing& sloshing = *flight.water.sloshing;
    sloshing.moved = sloshing.now;
    const SloshingAt at = waterAt(i).sloshing();
    joinVessel(at, p.start.twist.vector(), p.sloshing());
    lanes_.slosh_energy[i] = energyOfSloshing(at, p.sloshing()).sum();
  }

  /// The water in the holds of a body that has some, where it is now.
  WaterAt waterAt(int i) const {
    const Progress& p = progress_[i];
    return {p.model(), *p.place, p.to_world, vectorOf(lanes_.flight.displacement_W, i)};
  }
  /// Notes the attitude in which it is.
  void turnWater(int i) {
    progress_[i].to_world = orientationOf(lanes_.flight.orientation, i).toRotationMatrix();
  }

  /// Lets the water in the holds slosh for half of a kick.
  void slosh() {
    for (int i = 0; i < count_; ++i) {
      Progress& p = progress_[i];
      if (!isActive(i) || !p.hasWater()) continue;
      const Sloshed end =
          exchangeSloshing(waterAt(i).sloshing(), symmetricOf(lanes_.flight.inverse_inertia, i),
                           p.flight->water.damping, 0.5 * lanes_.flight.kick_time[i],
                           twistOf(lanes_.flight.twist_B, i).vector(), p.sloshing());
      setLane(lanes_.flight.twist_B, i, Twist::fromVector(end.twist));
      lanes_.slosh_energy[i] = end.energy;
    }
  }

  /// Brings the water in the holds of a body to the place where it has come to.
  void shiftWater(int i) {
    Progress& p = progress_[i];
    turnWater(i);
    SymmetricMatrix inertia = symmetricOf(lanes_.flight.inertia, i);
    const Vector6 x = ambient::shiftWater(
        p.left, waterAt(i), twistOf(lanes_.flight.twist_B, i).vector(), inertia, p.sloshing());
    setLane(lanes_.flight.twist_B, i, Twist::fromVector(x));
    setLane(lanes_.flight.inertia, i, inertia);
  }

  /// Brings the active bodies back to the start of the step.
  void restart() {
    for (int i = 0; i < count_; ++i)
      if (isActive(i)) restartBody(i);
    kernel_.measure(lanes_);
    for (int i = 0; i < count_; ++i)
      if (isActive(i))
        progress_[i].energy =
            0.5 * lanes_.kinetic2[i] + lanes_.potential[i] + progress_[i].rounding;
  }

  /// Makes the substeps of the active bodies, and bounds their energy.
  void run() {
    bool is_run[kFlightLanes];
    int most = 0;
    for (int i = 0; i < count_; ++i) {
      is_run[i] = isActive(i);
      if (is_run[i]) most = std::max(most, progress_[i].made);
    }
    for (int substep = 0; substep < most; ++substep) {
      choose([&](int i) { return is_run[i] && substep < progress_[i].made; });
      advance();
    }
    choose([&](int i) { return is_run[i]; });
    kernel_.measure(lanes_);
    for (int i = 0; i < count_; ++i)
      if (is_run[i]) boundEnergy(i);
  }

  void advance() {
    beginKick();
    keepingSpins([&] { move(); });
    endKick();
    for (int i = 0; i < count_; ++i)
      if (isActive(i)) ++progress_[i].count.substeps;
  }

  /// Makes a step that leaves bodies of revolution their spin about their axis, as eq. (66a) says.
  template <class Step>
  void keepingSpins(const Step& step) {
    if (!has_still_axis_) return step();
    const auto spinOf = [&](int i) {
      return progress_[i].model().still_axis_B.dot(twistOf(lanes_.flight.twist_B, i).angular);
    };
    double spins[kFlightLanes];
    for (int i = 0; i < count_; ++i) spins[i] = spinOf(i);
    step();
    for (int i = 0; i < count_; ++i) {
      const Vector3& axis = progress_[i].model().still_axis_B;
      if (!isActive(i) || axis.isZero(0)) continue;
      Twist x = twistOf(lanes_.flight.twist_B, i);
      x.angular += (spins[i] - spinOf(i)) * axis;
      setLane(lanes_.flight.twist_B, i, x);
    }
  }

  /// The second half of a kick, in reversed order: loads are still those of the first half.
  void beginKick() {
    if (has_loads_below_) {
      for (int i = 0; i < count_; ++i) {
        Progress& p = progress_[i];
        if (isActive(i) && !p.has_load && p.model().loads_below.loads) findFirstLoad(i);
      }
      kernel_.applyLastLoad(lanes_);
    }
    if (has_loads_above_) kickByWind();
    slosh();
    keepingSpins([&] { kernel_.exchangeWaves(lanes_); });
    kernel_.kickByGravity(lanes_);
  }

  /// The flow with the inertia frozen in body axes, eq. (22), and then its change.
  void move() {
    for (int i = 0; i < count_; ++i) {
      if (!isActive(i)) continue;
      Progress& p = progress_[i];
      const Twist x = twistOf(lanes_.flight.twist_B, i);
      setLane(lanes_.gradient, i, gradientAt(p.model(), *p.place, x));
      if (p.hasWater()) p.left = WaterLeft(waterAt(i), p.sloshing(), lanes_.slosh_energy[i]);
    }
    flight_kernel_.drift(lanes_.flight);
    kernel_.see(lanes_);
    const SurfaceModel* models[kFlightLanes];
    SurfacePlace* places[kFlightLanes];
    for (int i = 0; i < count_; ++i) {
      Progress& p = progress_[i];
      models[i] = &p.model();
      places[i] = &p.later;
      if (isActive(i)) findPlace(i);
    }
    computeFlotations(lanes_.flotation, models, places, count_);
    kernel_.changeInertia(lanes_);
    for (int i = 0; i < count_; ++i)
      if (isActive(i)) noteError(i, lanes_.change_error[i]);
  }

  void noteError(int i, double error) { progress_[i].error = std::max(progress_[i].error, error); }

  void findPlace(int i) {
    Progress& p = progress_[i];
    const SurfacePlane& plane = p.place->plane;
    const SurfacePlane plane_B{vectorOf(lanes_.flotation.normal, i), lanes_.flotation.height[i],
                               plane.density, plane.gravity, plane.sides_F};
    const Immersion before = p.place->immersion_F;
    const bool has_water = p.hasWater();
    const VesselWater& at_start = p.flight->water;
    VesselWater water;
    if (has_water) water = {at_start.states, &p.inside, at_start.sloshing->later.data()};
    p.later = placeAt(p.model(), plane_B, water);
    p.place = &p.later;
    if (has_water) shiftWater(i);
    setPlace(lanes_.flotation, i, p.model(), p.later);
    setLane(lanes_.centre_of_buoyancy, i, centreOfBuoyancy(p.model(), p.later));
    const MeanDepths depths = meanDepths(before, p.later.immersion_F);
    lanes_.draught[i] = depths.draught;
    lanes_.submergence[i] = depths.submergence;
  }

  /// The first half of a kick, at the pose where the flow has come to.
  void endKick() {
    for (int i = 0; i < count_; ++i)
      if (isActive(i))
        progress_[i].frequency = std::max(progress_[i].frequency, lanes_.flotation.frequency[i]);
    kernel_.kickByGravity(lanes_);
    keepingSpins([&] { kernel_.exchangeWaves(lanes_); });
    slosh();
    if (has_loads_above_) kickByWind();
    if (has_loads_below_) applyLoads();
  }

  void setGrowth(int i, const Growth& growth) {
    progress_[i].growth = growth;
    const bool is_met = progress_[i].model().loads_below.resistance != nullptr;
    ambient::setGrowth(lanes_.flight, i, is_met ? growth : Growth{});
  }

  Wrench loadAt(int i, const Twist& x) {
    Progress& p = progress_[i];
    const Surroundings& s = p.flight->surroundings;
    const SurfaceLoad load = loadBelow(p.model(), *p.place, x, s.load_scale, s.flow);
    setGrowth(i, load.growth);
    ++p.count.load_evaluations;
    p.count.guarded += load.guarded;
    return load.wrench;
  }

  void findFirstLoad(int i) {
    const Wrench load = loadAt(i, twistOf(lanes_.flight.twist_B, i));
    const Quaternion to_world = orientationOf(lanes_.flight.orientation, i);
    setLane(lanes_.flight.load_W, i, Wrench{to_world * load.torque, to_world * load.force});
    progress_[i].has_load = true;
  }

  /// Half of a kick, with the load in the middle of the whole, eq. (23) to (25).
  void applyLoads() {
    kernel_.sampleLoad(lanes_);
    for (int i = 0; i < count_; ++i) {
      const bool has_load = isActive(i) && progress_[i].model().loads_below.loads;
      setLane(lanes_.flight.load_B, i,
              has_load ? loadAt(i, twistOf(lanes_.flight.sample_twist, i)) : Wrench{});
    }
    kernel_.applyLoad(lanes_);
    for (int i = 0; i < count_; ++i) {
      Progress& p = progress_[i];
      if (!isActive(i) || !p.model().loads_below.loads) continue;
      p.has_load = true;
      noteError(i, lanes_.flight.error[i]);
    }
  }

  void kickByWind() {
    kernel_.sampleWind(lanes_);
    for (int i = 0; i < count_; ++i) {
      Progress& p = progress_[i];
      const bool has_wind = isActive(i) && p.model().loads_above.loads;
      p.count.load_evaluations += has_wind;
      const Twist seen = twistOf(lanes_.flight.sample_twist, i);
      setLane(lanes_.flight.load_B, i, has_wind ? loadAbove(p.model(), *p.place, seen) : Wrench{});
    }
    kernel_.kickByWind(lanes_);
  }

  /// Energy of which it is not known whether the body had it, docs/theory.md eq. (64): negative if
  /// the energy of place alone is more than all that there was before.
  double energyLeft(int i) const { return progress_[i].energy - lanes_.potential[i]; }
  bool isGain(int i) const {
    constexpr double kRounding = 1e-13;
    const double fall = lanes_.flight.velocity_scale[i];
    return energyLeft(i) < -kRounding * (fall * fall + std::abs(progress_[i].energy));
  }

  /// Scales the motion down to an energy.
  void scaleWithin(int i, double allowed2) {
    const Vector6 x = twistOf(lanes_.flight.twist_B, i).vector();
    const BoundedTwist bounded = scaledWithin(x, lanes_.kinetic2[i], allowed2);
    setLane(lanes_.flight.twist_B, i, Twist::fromVector(bounded.twist));
    progress_[i].energy_removed += bounded.energy_removed;
  }

  void boundEnergy(int i) {
    if (mayGain(progress_[i])) return;
    progress_[i].has_gained = isGain(i);
    scaleWithin(i, std::max(0.0, 2 * energyLeft(i)));
  }

  /// Accepts the attempt, or sets a larger number of substeps for the next one.
  void acceptOrRepeat(int i, int attempt) {
    Progress& p = progress_[i];
    const SurfaceFlight& task = *p.flight;
    const double ratio = p.error / task.settings.tolerance, h = task.duration / p.substeps;
    const double next = ratio > 0 ? std::min(4 * h, 0.9 * h / std::sqrt(ratio)) : 4 * h;
    const int needed = substepsFor(task.duration, kLongestPhase / p.frequency, p.most);
    const bool is_coarse = ratio > kMostSurfaceError || p.has_gained;
    const bool is_fine = !is_coarse && needed <= p.substeps;
    const bool is_last = p.substeps == p.most || (attempt >= kSurfaceAttempts && !p.has_gained);
    if (!is_fine && !is_last) {
      const int more = p.has_gained ? 2 * p.substeps : p.substeps + 1;
      p.substeps =
          std::min(p.most, std::max({more, needed, substepsFor(task.duration, next, p.most)}));
      return;
    }
    if (p.has_gained) halt(i);
    finish(i, p.count.halted ? h : next, is_coarse);
  }

  /// Ends the motion after the last substep that ends where the energy reaches. Where there is no
  /// such one, the body stays where it is, at rest.
  void halt(int i) {
    Progress& p = progress_[i];
    choose([&](int other) { return other == i; });
    restart();
    int reached = 0;
    for (int substep = 1; substep <= p.substeps; ++substep) {
      advance();
      kernel_.measure(lanes_);
      if (!isGain(i)) reached = substep;
    }
    restart();
    p.made = reached;
    run();
    if (reached == 0) scaleWithin(i, 0);
    p.count.halted = true;
  }

  void finish(int i, double next_substep, bool is_coarse) {
    Progress& p = progress_[i];
    SurfaceFlight& flight = *p.flight;
    const bool is_drift_coarse = lanes_.flight.is_coarse[i] > 0;
    p.count.coarse = is_coarse || is_drift_coarse;
    if (p.count.coarse) p.count.error = is_drift_coarse || p.count.halted ? 1 : p.error;
    p.count.energy_removed = p.energy_removed + lanes_.flight.energy_removed[i];
    FlightResult& body = flight.body;
    body.count = p.count;
    body.memory = {wrenchOf(lanes_.flight.load_W, i), p.growth, p.has_load, next_substep};
    body.state = stateOf(lanes_.flight, i, p.start.position);
    leaveFrame(flight.surroundings, flight.duration, body.state);
    forEachNumber(flight.waves, lanes_.waves,
                  [&](double& to, const FlightLane& from) { to = from[i]; });
    if (p.place == &p.later) {
      static_cast<SurfacePlace&>(flight.flotation) = p.later;
      if (p.later.inside_F) {
        VesselSloshing& sloshing = *flight.water.sloshing;
        *flight.water.inside = p.inside;  // with the modes, which change places
        std::swap(sloshing.modes, sloshing.later);
        std::swap(sloshing.now, sloshing.moved);
        flight.flotation.inside_F = flight.water.inside;
      }
      readFlotation(lanes_.flotation, i, flight.flotation);
    }
    p.is_done = true;
  }

  const SurfaceKernel& kernel_;
  const FlightKernel& flight_kernel_;
  int count_;
  bool has_loads_below_ = false, has_loads_above_ = false, has_still_axis_ = false;
  SurfaceLanes lanes_{};
  Progress progress_[kFlightLanes];
};

}  // namespace

void flyAtSurface(SurfaceFlight* const* flights, int count) noexcept {
  SurfaceFlights(flights, count).fly();
}

}  // namespace ambient
