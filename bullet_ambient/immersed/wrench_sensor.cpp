#include "bullet_ambient/immersed/wrench_sensor.h"

#include "bullet_ambient/force/surface/hydrostatics.h"
#include "bullet_ambient/immersed/floating_state.h"
#include "bullet_ambient/immersed/vessel_step.h"
#include "bullet_ambient/motion/surface/flotation.h"
#include "bullet_ambient/spatial/rotation.h"

namespace ambient {

namespace {

/// Middle of the path of a flight: twists in B change evenly.
RigidState middleOfFlight(const RigidState& start, const RigidState& end, double h) {
  RigidState middle;
  middle.twist = Twist::fromVector((start.twist.vector() + end.twist.vector()) / 2);
  middle.orientation =
      start.orientation * rotationFromVector(Vector3(h / 2 * middle.twist.angular));
  middle.position = (start.position + end.position) / 2;
  return middle;
}

/// Middle of the path at a constant velocity.
RigidState middleOfPath(const RigidState& start, const Twist& moved_W, double h) {
  RigidState middle;
  middle.orientation = rotationFromVector(Vector3(h / 2 * moved_W.angular)) * start.orientation;
  middle.position = start.position + h / 2 * moved_W.linear;
  middle.twist = turned(middle.orientation.conjugate(), moved_W);
  return middle;
}

}  // namespace

void beginBodyReading(AmbientBody& ambient, const RigidState& start,
                      const Surroundings& surroundings, bool is_locked) noexcept {
  WrenchSensor& sensor = *ambient.sensor;
  beginReading(ambient, start, surroundings, sensor);
  sensor.surroundings.applied -= pushByFlow(ambient, start.orientation);
  sensor.model = ambient.model();
  sensor.knows_impulse = !is_locked;
}

void readRows(AmbientBody& ambient, const Twist& change_W,
              const std::optional<Matrix6>& settled_inertia, double time_step) noexcept {
  WrenchSensor& sensor = *ambient.sensor;
  const RowMotion& rows = ambient.outcome.rows();
  sensor.moved_W = rows.velocity_W;
  sensor.moved_W.linear += rows.flow_W;
  const Quaternion& q = sensor.start.orientation;
  const Twist change_B = turned(q.conjugate(), change_W);
  if (ambient.surface()) sensor.model = *StepModel(ambient, time_step);
  const Matrix6& inertia = settled_inertia ? *settled_inertia : sensor.model.inertia;
  sensor.impulse_W = turned(q, Wrench::fromVector(inertia * change_B.vector()));
}

void finishBodyReading(AmbientBody& ambient, Outcome kind, const MotionView& now,
                       const Twist& before_W, double time_step) noexcept {
  WrenchSensor& sensor = *ambient.sensor;
  const bool has_flown = kind == Outcome::kFlown;
  RigidState end = now.state;
  Twist end_W = sensor.moved_W;
  if (has_flown) {
    end_W = ambient.outcome.flight().left_W;
  } else {
    end_W.angular += now.twist_W.angular - before_W.angular;
    end_W.linear += now.twist_W.linear - before_W.linear;
  }
  end.twist = turned(end.orientation.conjugate(), end_W);
  const RigidState middle = has_flown ? middleOfFlight(sensor.start, end, time_step)
                                      : middleOfPath(sensor.start, sensor.moved_W, time_step);
  finishReading(ambient, {middle, end, sensor.model, has_flown, time_step}, sensor);
}

namespace {

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
                        const WrenchSensor& sensor) {
  const Surroundings& s = sensor.surroundings;
  const double h = step.duration;
  const Matrix6 added = addedInertia(ambient, step.model.inertia);
  const auto momentum = [&](const RigidState& state, double time) {
    const Vector6 x = relativeTwist(state, s, time).vector();
    return turned(state.orientation.toRotationMatrix(), Wrench::fromVector(added * x));
  };
  const Wrench before = momentum(sensor.start, 0), after = momentum(step.end, h);
  const Vector3 displacement = step.end.position - sensor.start.position - h * s.ambient_velocity -
                               h * h / 2 * s.ambient_acceleration;
  Wrench impulse = without(before, after);
  impulse.torque -= displacement.cross(before.force + after.force) / 2;
  return impulse + sensor.added_mass_impulse_W;
}

/// Wrenches in B at the middle of the path.
class MiddleWrenches {
 public:
  MiddleWrenches(const AmbientBody& ambient, const ReadStep& step, const WrenchSensor& sensor)
      : ambient_(ambient),
        step_(step),
        sensor_(sensor),
        to_world_(step.middle.orientation.toRotationMatrix()),
        seen_(relativeTwist(step.middle, sensor.surroundings, step.duration / 2)) {}

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
    const Surroundings& s = sensor_.surroundings;
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
    if (sensor_.surroundings.flow) found_.pressure += sensor_.surroundings.flow->at_rest_B;
  }

  // Returns the mean of the friction over the stations of the body.
  template <class FrictionFor>
  Wrench frictionAlong(const FrictionFor& frictionFor) {
    FlowAlongBody in_full;
    if (sensor_.surroundings.flow) in_full = *sensor_.surroundings.flow;
    in_full.at_rest_B = {};
    return loadAlong(&in_full, seen_, nullptr,
                     [&](const Twist& x) -> SurfaceLoad {
                       return {ambient_.load_scale * frictionFor(x)};
                     })
        .wrench;
  }

  void findSubmerged() {
    const BodyModel& model = step_.model;
    setBuoyancy(model);
    if (!model.loads) return;
    const FrameOffset& frame = model.load_frame;
    setLoads(wholeLoad(computeSurfaceLoad(model, seen_, sensor_.surroundings),
                       model.resistance.get(), seen_),
             frictionAlong([&](const Twist& x) {
               return frame.toB(model.loads->parts(frame.toF(x)).friction);
             }));
  }

  void findAtSurface(const SurfaceModel& model) {
    const Surroundings& s = sensor_.surroundings;
    const double time = step_.duration / 2;
    SurfacePlane plane_W = sensor_.plane_W;
    plane_W.height +=
        plane_W.normal.dot(time * s.ambient_velocity + time * time / 2 * s.ambient_acceleration);
    WaterInside inside;
    const Flotation flotation = flotationAt(
        model, seenFrom(plane_W, to_world_, step_.middle.position), {waterOf(ambient_), &inside});
    setBuoyancy(step_.has_flown ? frozenAt(model, flotation) : step_.model);
    if (model.loads_below.loads)
      setLoads(wholeLoad(loadBelow(model, flotation, seen_, s.load_scale, s.flow),
                         model.loads_below.resistance.get(), seen_),
               frictionAlong([&](const Twist& x) { return frictionBelow(model, flotation, x); }));
    found_.waves = waveWrench(flotation.modes, to_world_, sensor_.waves, ambient_.floating->waves);
    if (!model.loads_above.loads) return;
    Twist seen_above = step_.middle.twist;
    seen_above.linear -= to_world_.transpose() * ambient_.floating->velocity_above;
    found_.wind = loadAbove(model, flotation, seen_above);
  }

  const AmbientBody& ambient_;
  const ReadStep& step_;
  const WrenchSensor& sensor_;
  const Matrix3 to_world_;
  const Twist seen_;  // relative to the flow
  FluidWrench found_;
};

}  // namespace

void beginReading(const AmbientBody& ambient, const RigidState& start,
                  const Surroundings& surroundings, WrenchSensor& sensor) noexcept {
  sensor = {};
  sensor.start = start;
  sensor.surroundings = surroundings;
  if (ambient.surface()) {
    sensor.plane_W = ambient.floating->plane_W;
    sensor.waves = ambient.floating->waves;
  }
  sensor.moved_W = turned(start.orientation, start.twist);
}

void finishReading(const AmbientBody& ambient, const ReadStep& step,
                   WrenchSensor& sensor) noexcept {
  FluidWrench& wrench = sensor.wrench;
  const double rate = 1 / step.duration;
  const Wrench change = without(dryMomentum(ambient, step.end), dryMomentum(ambient, sensor.start));
  const Wrench unapplied = without(rate * change, sensor.surroundings.applied);
  wrench = MiddleWrenches(ambient, step, sensor).find();
  if (sensor.knows_impulse) {
    wrench.constraints = rate * sensor.impulse_W;
    wrench.added_mass = without(unapplied, wrench.total() + wrench.constraints);
  } else {
    wrench.added_mass = rate * addedMassImpulse(ambient, step, sensor);
    if (const FlowAlongBody* flow = sensor.surroundings.flow)
      wrench.added_mass +=
          turned(sensor.start.orientation.toRotationMatrix(), flow->push_B) + flow->growth_W;
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
  WrenchSensor sensor;
  beginReading(ambient, now.state, surroundings, sensor);
  return MiddleWrenches(ambient, {now.state, now.state, ambient.model(), true, 0}, sensor).find();
}

}  // namespace ambient
