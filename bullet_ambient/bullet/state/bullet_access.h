#pragma once

#include <BulletDynamics/Featherstone/btMultiBody.h>

#include "bullet_ambient/bullet/core/precision_check.h"

AMBIENT_BEGIN

// Getters and setters of stored fields in Bullet's objects, where Bullet has no pair of
// functions for one.

/// Selects the const overload of a getter.
template <class Result, class Object>
constexpr auto constant(Result (Object::*get)() const) {
  return get;
}

/// Setter of a field that is restored together with others, by the named function; does nothing.
struct SetElsewhere {
  template <class Object, class Field>
  void operator()(Object&, const Field&) const {}
};
constexpr SetElsewhere kByRestoreMass{}, kByRestoreForces{}, kByRestoreSleep{};

/// An array of numbers in an object of Bullet.
struct Numbers {
  btScalar* first;
  int count;
};

/// A link of a multibody, or its base.
struct LinkPlace {
  btMultiBody& body;
  btMultibodyLink* link;  ///< null: the base

  LinkPlace(btMultiBody& of, int number)
      : body(of), link(number < 0 ? nullptr : &of.getLink(number)) {}

  /// Returns the first numbers of an array of the joint, as many as the joint uses; none for a
  /// base.
  template <std::size_t kSize>
  Numbers joint(btScalar (btMultibodyLink::*numbers)[kSize], int btMultibodyLink::*count) const {
    return link ? Numbers{link->*numbers, link->*count} : Numbers{nullptr, 0};
  }
};

/// Velocities of base and joints, to be written as Bullet does itself (btMultiBodyDynamicsWorld,
/// RK4).
inline Numbers velocitiesOf(btMultiBody& body) {
  return {const_cast<btScalar*>(body.getVelocityVector()), 6 + body.getNumDofs()};
}

/// Sleep data of a multibody, for which Bullet has no public getters.
struct MultiBodySleep {
  btScalar &timer, &threshold, &timeout;
};
MultiBodySleep sleepOf(btMultiBody& body) noexcept;

AMBIENT_END
