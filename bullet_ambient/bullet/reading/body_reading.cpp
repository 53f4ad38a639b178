#include "bullet_ambient/bullet/reading/body_reading.h"

#include "bullet_ambient/immersed/surface_encounter.h"
#include "bullet_ambient/spatial/rotation.h"

AMBIENT_BEGIN
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

void beginBodyReading(AmbientBody& ambient, bool is_locked) noexcept {
  FluidReading& reading = *ambient.reading;
  beginReading(ambient, readState(*ambient.body), readSurroundings(ambient), reading);
  reading.model = ambient.model();
  reading.knows_impulse = !is_locked;
}

void readRows(AmbientBody& ambient, btSolverBody& solver_body, double time_step) noexcept {
  FluidReading& reading = *ambient.reading;
  const RowMotion& rows = ambient.outcome.rows();
  reading.moved_W = rows.velocity_W;
  reading.moved_W.linear += rows.flow_W;
  const Quaternion& q = reading.start.orientation;
  const Twist change_B =
      turned(q.conjugate(), {toVector3(solver_body.internalGetDeltaAngularVelocity()),
                             toVector3(solver_body.internalGetDeltaLinearVelocity())});
  if (ambient.surface()) {
    reading.model = *StepModel(ambient, time_step);
    reading.model.loads = nullptr;  // which the StepModel holds
  }
  const Wrench impulse_B = Wrench::fromVector(reading.model.inertia * change_B.vector());
  reading.impulse_W = {q * impulse_B.torque, q * impulse_B.force};
}

void finishBodyReading(AmbientBody& ambient, Outcome kind, const Twist& before_W,
                       double time_step) noexcept {
  FluidReading& reading = *ambient.reading;
  const bool has_flown = kind == Outcome::kFlown;
  RigidState end = readState(*ambient.body);
  Twist end_W = reading.moved_W;
  if (has_flown) {
    end_W = ambient.outcome.flight().left_W;
  } else {
    const Twist after_W = velocityOf(*ambient.body);
    end_W.angular += after_W.angular - before_W.angular;
    end_W.linear += after_W.linear - before_W.linear;
  }
  end.twist = turned(end.orientation.conjugate(), end_W);
  const RigidState middle = has_flown ? middleOfFlight(reading.start, end, time_step)
                                      : middleOfWay(reading.start, reading.moved_W, time_step);
  finishReading(ambient, {middle, end, reading.model, has_flown, time_step}, reading);
}

AMBIENT_END
