#include "bullet_ambient/immersed/fluid_reading.h"

#include "bullet_ambient/force/surface/hydrostatics.h"
#include "bullet_ambient/immersed/floating_state.h"
#include "bullet_ambient/immersed/vessel_step.h"
#include "bullet_ambient/motion/surface/stand_lanes.h"
#include "bullet_ambient/motion/surface/surface_stand.h"
#include "bullet_ambient/spatial/rotation.h"

namespace ambient {

namespace {

/// Middle of the way of a flight: twists in B change evenly.
RigidState middleOfFlight(const RigidState& start, const RigidState& end, double h) {
  RigidState middle;
  middle.twist = Twist::fromVector((start.twist.vector() + end.twist.vector()) / 2);
  middle.orientation =
      start.orientation * rotationFromVector(Vector3(h / 2 * middle.twist.angular));
  middle.position = (start.position + end.position) / 2;
  return middle;
}

/// Middle of the way at a constant velocity.
RigidState middleOfWay(const RigidState& start, const Twist& moved_W, double h) {
  RigidState middle;
  middle.orientation = rotationFromVector(Vector3(h / 2 * moved_W.angular)) * start.orientation;
  middle.position = start.position + h / 2 * moved_W.linear;
  middle.twist = turned(middle.orientation.conjugate(), moved_W);
  return middle;
}

}  // namespace

void beginBodyReading(AmbientBody& ambient, const RigidState& start,
                      const Surroundings& surroundings, bool is_locked) noexcept {
  FluidReading& reading = *ambient.reading;
  beginReading(ambient, start, surroundings, reading);
  reading.surroundings.applied -= pushByFlow(ambient, start.orientation);
  reading.model = ambient.model();
  reading.knows_impulse = !is_locked;
}

void readRows(AmbientBody& ambient, const Twist& change_W,
              const std::optional<Matrix6>& settled_inertia, double time_step) noexcept {
  FluidReading& reading = *ambient.reading;
  const RowMotion& rows = ambient.outcome.rows();
  reading.moved_W = rows.velocity_W;
  reading.moved_W.linear += rows.flow_W;
  const Quaternion& q = reading.start.orientation;
  const Twist change_B = turned(q.conjugate(), change_W);
  if (ambient.surface()) reading.model = *StepModel(ambient, time_step);
  const Matrix6& inertia = settled_inertia ? *settled_inertia : reading.model.inertia;
  const Wrench impulse_B = Wrench::fromVector(inertia * change_B.vector());
  reading.impulse_W = {q * impulse_B.torque, q * impulse_B.force};
}

void finishBodyReading(AmbientBody& ambient, Outcome kind, const MotionView& now,
                       const Twist& before_W, double time_step) noexcept {
  FluidReading& reading = *ambient.reading;
  const bool has_flown = kind == Outcome::kFlown;
  RigidState end = now.state;
  Twist end_W = reading.moved_W;
  if (has_flown) {
    end_W = ambient.outcome.flight().left_W;
  } else {
    end_W.angular += now.twist_W.angular - before_W.angular;
    end_W.linear += now.twist_W.linear - before_W.linear;
  }
  end.twist = turned(end.orientation.conjugate(), end_W);
  const RigidState middle = has_flown ? middleOfFlight(reading.start, end, time_step)
                                      : middleOfWay(reading.start, reading.moved_W, time_step);
  finishReading(ambient, {middle, end, reading.model, has_flown, time_step}, reading);
}

namespace {

Wrench turned(const Matrix3& rotation, const Wrench& f) {
  return {rotation * f.torque, rotation * f.force};
}

Wrench without(Wrench all, const Wrench& part) { return all -= part; }

/// Momentum of the dry body in W about its centre of mass, as an impulse [N m s, N s].
Wrench dryMomentum(const AmbientBody& ambient, const RigidState& state) {
  const InverseMass& inverse = ambient.models->inverse_mass;
  return turned(
      state.orientation.toRotationMatrix(),
      {inverse.moments().cwiseProduct(state.twist.angular), state.twist.linear / inverse.mass});
}

Matrix6 addedInertia(const AmbientBody& ambient, const Matrix6& inertia) {
  const InverseMass& inverse = ambient.models->inverse_mass;
  Matrix6 added = inertia;
  added.diagonal() -= stack(inverse.moments(), Vector3::Constant(1 / inverse.mass));
  return added;
}

/// Twist relative to the ambient flow a time after the start.
Twist relativeTwist(const RigidState& state, const Surroundings& s, double time) {
  const Vector3 flow = s.ambient_velocity + time * s.ambient_acceleration;
  return {state.twist.angular, state.twist.linear - state.orientation.conjugate() * flow};
}

/// Impulse of the fluid that moves along, as its momentum A x changes on the way.
Wrench addedMassImpulse(const AmbientBody& ambient, const ReadStep& step,
                        const FluidReading& reading) {
  const Surroundings& s = reading.surroundings;
  const double h = step.duration;
  const Matrix6 added = addedInertia(ambient, step.model.inertia);
  const auto momentum = [&](const RigidState& state, double time) {
    const Vector6 x = relativeTwist(state, s, time).vector();
    return turned(state.orientation.toRotationMatrix(), Wrench::fromVector(added * x));
  };
  const Wrench before = momentum(reading.start, 0), after = momentum(step.end, h);
  const Vector3 way = step.end.position - reading.start.position - h * s.ambient_velocity -
                      h * h / 2 * s.ambient_acceleration;
  Wrench impulse = without(before, after);
  impulse.torque -= way.cross(before.force + after.force) / 2;
  return impulse + reading.passage_W;
}

/// Wrenches in B at the middle of the way.
class MiddleWrenches {
 public:
  MiddleWrenches(const AmbientBody& ambient, const ReadStep& step, const FluidReading& reading)
      : ambient_(ambient),
        step_(step),
        reading_(reading),
        to_world_(step.middle.orientation.toRotationMatrix()),
        seen_(relativeTwist(step.middle, reading.surroundings, step.duration / 2)) {}

  FluidWrench find() {
    if (ambient_.surface()) {
      findAtSurface(*ambient_.surface());
    } else {
      findSubmerged();
    }
    for (Wrench* part :
         {&found_.pressure, &found_.friction, &found_.buoyancy, &found_.waves, &found_.wind})
      *part = turned(to_world_, *part);
    return found_;
  }

 private:
  void setBuoyancy(const BodyModel& model) {
    const Surroundings& s = reading_.surroundings;
    found_.buoyancy = buoyancy(model.displaced_mass, model.centre_of_volume,
                               to_world_.transpose() * (s.gravity - s.ambient_acceleration));
    if (!s.flow) return;
    found_.buoyancy.force += model.mass * (to_world_.transpose() * s.flow->lean_W);
    found_.buoyancy += turned(to_world_.transpose(), s.flow->side_push_W + s.flow->layers_W);
  }

  // `all`: less the load at rest in the mean flow.
  void setLoads(const Wrench& all, const Wrench& friction) {
    found_.friction = friction;
    found_.pressure = without(all, friction);
    if (reading_.surroundings.flow) found_.pressure += reading_.surroundings.flow->at_rest_B;
  }

  // Returns the mean of the friction over the stations of the body.
  template <class FrictionFor>
  Wrench frictionAlong(const FrictionFor& frictionFor) {
    FlowAlongBody in_full;
    if (reading_.surroundings.flow) in_full = *reading_.surroundings.flow;
    in_full.at_rest_B = {};
    return loadAlong(&in_full, seen_, nullptr,
                     [&](const Twist& x) -> SurfaceLoad {
                       return {ambient_.load_share * frictionFor(x)};
                     })
        .wrench;
  }

  void findSubmerged() {
    const BodyModel& model = step_.model;
    setBuoyancy(model);
    if (!model.loads) return;
    const FrameOffset& frame = model.load_frame;
    setLoads(wholeLoad(computeSurfaceLoad(model, seen_, reading_.surroundings),
                       model.resistance.get(), seen_),
             frictionAlong([&](const Twist& x) {
               return frame.toB(model.loads->parts(frame.toF(x)).friction);
             }));
  }

  void findAtSurface(const SurfaceModel& model) {
    const Surroundings& s = reading_.surroundings;
    const double time = step_.duration / 2;
    SurfacePlane plane_W = reading_.plane_W;
    plane_W.height +=
        plane_W.normal.dot(time * s.ambient_velocity + time * time / 2 * s.ambient_acceleration);
    WaterInside inside;
    const SurfaceStand stand = standAtSurface(
        model, seenFrom(plane_W, to_world_, step_.middle.position), {waterOf(ambient_), &inside});
    setBuoyancy(step_.has_flown ? frozenAt(model, stand) : step_.model);
    if (model.loads_below.loads)
      setLoads(wholeLoad(loadBelow(model, stand, seen_, s.load_share, s.flow),
                         model.loads_below.resistance.get(), seen_),
               frictionAlong([&](const Twist& x) { return frictionBelow(model, stand, x); }));
    found_.waves = waveWrench(stand.modes, to_world_, reading_.waves, ambient_.floating->waves);
    if (!model.loads_above.loads) return;
    Twist seen_above = step_.middle.twist;
    seen_above.linear -= to_world_.transpose() * ambient_.floating->velocity_above;
    found_.wind = loadAbove(model, stand, seen_above);
  }

  const AmbientBody& ambient_;
  const ReadStep& step_;
  const FluidReading& reading_;
  const Matrix3 to_world_;
  const Twist seen_;  // relative to the flow
  FluidWrench found_;
};

}  // namespace

void beginReading(const AmbientBody& ambient, const RigidState& start,
                  const Surroundings& surroundings, FluidReading& reading) noexcept {
  reading = {};
  reading.start = start;
  reading.surroundings = surroundings;
  if (ambient.surface()) {
    reading.plane_W = ambient.floating->plane_W;
    reading.waves = ambient.floating->waves;
  }
  reading.moved_W = turned(start.orientation, start.twist);
}

void finishReading(const AmbientBody& ambient, const ReadStep& step,
                   FluidReading& reading) noexcept {
  FluidWrench& wrench = reading.wrench;
  const double rate = 1 / step.duration;
  const Wrench change =
      without(dryMomentum(ambient, step.end), dryMomentum(ambient, reading.start));
  const Wrench unapplied = without(rate * change, reading.surroundings.applied);
  wrench = MiddleWrenches(ambient, step, reading).find();
  if (reading.knows_impulse) {
    wrench.constraints = rate * reading.impulse_W;
    wrench.added_mass = without(unapplied, wrench.total() + wrench.constraints);
  } else {
    wrench.added_mass = rate * addedMassImpulse(ambient, step, reading);
    if (const FlowAlongBody* flow = reading.surroundings.flow)
      wrench.added_mass +=
          turned(reading.start.orientation.toRotationMatrix(), flow->push_B) + flow->growth_W;
    wrench.constraints = without(unapplied, wrench.total());
  }
}

double kineticEnergyNow(const AmbientBody& ambient, const MotionView& now) noexcept {
  const Matrix6 inertia = modelNow(ambient, now).inertia;
  const Matrix6 added = addedInertia(ambient, inertia);
  const Vector6 x = now.state.twist.vector();
  const Surroundings surroundings = surroundingsOf(ambient, now.gravity, {});
  const Vector6 relative = relativeTwist(now.state, surroundings, 0).vector();
  return (x.dot((inertia - added) * x) + relative.dot(added * relative)) / 2 +
         sloshingEnergyNow(ambient, now);
}

FluidWrench wrenchNow(const AmbientBody& ambient, const MotionView& now) noexcept {
  if (!ambient.isInFluid()) return {};
  Surroundings surroundings = surroundingsOf(ambient, now.gravity, {});
  addFlowAlong(ambient, now.state.orientation, surroundings);
  FluidReading reading;
  beginReading(ambient, now.state, surroundings, reading);
  return MiddleWrenches(ambient, {now.state, now.state, ambient.model(), true, 0}, reading).find();
}

}  // namespace ambient
