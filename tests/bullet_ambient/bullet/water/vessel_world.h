#pragma once

#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/bullet/members/ambient_bodies.h"
#include "bullet_ambient/motion/surface/flotation_lanes.h"
#include "bullet_ambient/spatial/rotation.h"
#include "tests/bullet_ambient/bullet/fluid_world.h"
#include "tests/support/bodies/vessel_bodies.h"

// A barge of 2 x 1 x 0.5 m with walls of 2 cm and 200 kg afloat in water of 1000 kg/m^3.
namespace ambient::test {

constexpr double kAtmosphere = 101325;
constexpr double kWater = 0.2;  // where there is some in the hold [m^3]
constexpr double kBarge = 200, kCapacity = 1.96 * 0.96 * 0.48;
inline const Vector3 kBargeMoments = kBarge * Vector3(0.13, 0.42, 0.5);

struct Start {
  Vector3 position{0, 0, 0.15};  ///< of the middle of the closed box [m]
  Quaternion orientation = Quaternion::Identity();
  Twist twist{};             ///< world axes
  double above_keel = 0.13;  ///< of the centre of mass [m]
  double mass = kBarge;      ///< [kg]
};

struct Sea {
  explicit Sea(std::shared_ptr<const WaterSurface> surface = nullptr)
      : scene(seaUnderVacuum(std::move(surface))) {}
  btRigidBody& add(const OpenBarge& barge, const Start& start, const HoldSettings& holds = {}) {
    const Vector3 centre(0, 0, start.above_keel - 0.25);
    btRigidBody& body = scene.add(
        {start.mass, start.mass / kBarge * kBargeMoments,
         startAt(start.position + start.orientation * centre, start.twist, start.orientation)});
    AttachDef attach{std::make_shared<FluidBody>(openBarge(barge))};
    attach.fluid_frame.translation = -centre;
    attach.holds = holds;
    scene.fluid.add(body, attach);
    return body;
  }
  const AmbientBody& of(const btRigidBody& body) const {
    return *ambientBodiesOf(scene.fluid).find(&body);
  }
  double water(const btRigidBody& body) const { return of(body).vessel->holds[0].volume; }
  /// Energy of the body, the water around and that in its holds, docs/theory.md eq. (64) [J].
  double energy(const btRigidBody& body, double mass = kBarge) const {
    const AmbientBody& ambient = of(body);
    const SurfaceModel& model = ambient.models->surfaces.at(0).model;
    const RigidState state = readState(body);
    const Water water(*this, body);
    const Vector6 x = state.twist.vector();
    return x.dot(water.flotation.inertia.full() * x) / 2 + mass * kGravity * state.position.z() +
           hydrostaticEnergy(wetVolume(model, water.flotation), water.flotation.plane) +
           water.energy().sum() + ambient.floating->waves.energy() + energyOfAirIn(ambient);
  }

  /// Water in the holds of a body in calm water, at its present pose.
  struct Water {
    Water(const Sea& sea, const btRigidBody& body)
        : ambient(sea.of(body)),
          model(ambient.models->surfaces.at(0).model),
          state(readState(body)),
          modes(ambient.vessel->holds.size()),
          flotation(flotationAt(model,
                                seenFrom({{0, 0, 1}, 0, 1000, kGravity},
                                         state.orientation.toRotationMatrix(), state.position),
                                {waterOf(ambient), &inside, modes.data()})),
          at{model, flotation, state.orientation.toRotationMatrix(), state.position},
          sloshing(ambient.vessel->sloshing.now) {
      if (flotation.inside_F) joinVessel(at.sloshing(), state.twist.vector(), sloshing.data());
    }
    SloshingEnergy energy() const {
      return flotation.inside_F ? energyOfSloshing(at.sloshing(), sloshing.data())
                                : SloshingEnergy{};
    }
    /// Of body, fluid and water.
    Vector3 momentum_W() const {
      const Vector6 own = flotation.inertia.full() * state.twist.vector();
      const Vector3 own_W = state.orientation * Vector3(own.tail<3>());
      if (!flotation.inside_F) return own_W;
      return own_W + momentumOfSloshing(at.sloshing(), sloshing.data()).linear;
    }

    const AmbientBody& ambient;
    const SurfaceModel& model;
    RigidState state;
    std::vector<HoldModes> modes;
    WaterInside inside;
    Flotation flotation;
    WaterAt at;
    std::vector<Sloshing> sloshing;
  };

  /// Energy of the air that water shuts off, docs/theory.md eq. (148) [J].
  static double energyOfAirIn(const AmbientBody& ambient) {
    const VesselState& vessel = *ambient.vessel;
    double energy = 0;
    for (std::size_t i = 0; i < vessel.holds.size(); ++i) {
      const HoldState& hold = vessel.holds[i];
      const double room = vessel.shape->holds[i].volume - hold.volume;
      if (hold.is_sealed) energy += energyOfAir(hold.air, room, kAtmosphere);
    }
    return energy;
  }

  SeaWorld scene;
};

/// Height of the middle of the box [m].
inline double middleOf(const btRigidBody& body, double above_keel = 0.13) {
  return static_cast<double>(body.getWorldTransform().getOrigin().z()) + 0.25 - above_keel;
}

/// A joint that lets a body move up and down, and roll, within limits [m, rad].
struct Rail {
  Rail(Sea& sea, btRigidBody& body, double lift, double roll)
      : world(sea.scene.world), joint(body, btTransform(btQuaternion::getIdentity()), false) {
    joint.setLinearLowerLimit({0, 0, bt(-lift)});
    joint.setLinearUpperLimit({0, 0, bt(lift)});
    joint.setAngularLowerLimit({bt(-roll), 0, 0});
    joint.setAngularUpperLimit({bt(roll), 0, 0});
    world.addConstraint(&joint, true);
  }
  ~Rail() { world.removeConstraint(&joint); }

  btDynamicsWorld& world;
  btGeneric6DofConstraint joint;
};

inline double heelOf(const btRigidBody& body) {
  return std::acos(std::min(1.0, static_cast<double>(body.getWorldTransform().getBasis()[2].z())));
}

/// Steps a barge with a hole of 0.01 m^2 in its floor until its rim dips. Returns the time [s].
inline double timeToDip(Sea& sea, const btRigidBody& body, double hertz) {
  double time = 0;
  while (middleOf(body) > -0.25 && time < 200) {
    sea.scene.step(1 / hertz);
    time += 1 / hertz;
  }
  return time;
}

/// Head D = D0 - c V, c = 1/A_i - 1/A_o: 2 (sqrt D0 - sqrt(D0 - c V)) / (C a sqrt(2g) c), V 0.8
/// m^3.
inline double exactTimeToDip() {
  const double c = 1 / (1.96 * 0.96) - 1 / 2.0, D0 = 0.08;
  return 2 * (std::sqrt(D0) - std::sqrt(D0 - c * 0.8)) / (0.6 * 0.01 * std::sqrt(2 * kGravity) * c);
}

/// Turned over about x.
inline Start capsized() {
  Start start;
  start.orientation = rotationFromVector(Vector3(kPi, 0, 0));
  return start;
}

/// Steps and expects that the energy of a vessel never grows. Returns in how many steps its first
/// hold has air that water shuts off.
inline int expectEnergyNeverGrows(Sea& sea, const btRigidBody& body, double mass, double hertz) {
  int sealed = 0;
  sea.scene.step(1 / hertz);
  double energy = sea.energy(body, mass);
  for (int k = 0; k < 400; ++k) {
    sea.scene.step(1 / hertz);
    const double next = sea.energy(body, mass);
    EXPECT_LT(next - energy, byPrecision(1e-9, 3e-6) * mass * kGravity) << k;
    energy = next;
    sealed += sea.of(body).vessel->holds[0].is_sealed;
  }
  return sealed;
}

}  // namespace ambient::test
