#pragma once

#include <BulletDynamics/Featherstone/btMultiBody.h>

#include "bullet_ambient/bullet/core/precision_check.h"

AMBIENT_BEGIN

// Getters and setters of stored fields in Bullet's objects, where Bullet has no pair of
// functions for one.

/// Picks the const one of two functions of a name.
template <class Result, class Object>
constexpr auto constant(Result (Object::*get)() const) {
  return get;
}

/// Leaves a field to the function that restores it together with others.
struct SetElsewhere {
  template <class Object, class Field>
  void operator()(Object&, const Field&) const {}
};
constexpr SetElsewhere kByRestoreMass{}, kByRestoreForces{}, kByRestoreSleep{};

/// Numbers as Bullet keeps them.
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

  /// Numbers of the joint, of which it uses the first; a base has none.
  template <std::size_t kSize>
  Numbers joint(btScalar (btMultibodyLink::*numbers)[kSize], int btMultibodyLink::*count) const {
    return link ? Numbers{link->*numbers, link->*count} : Numbers{nullptr, 0};
  }
};

/// Velocities of base and joints. Bullet writes there itself (btMultiBodyDynamicsWorld, RK4).
inline Numbers velocitiesOf(btMultiBody& body) {
  return {const_cast<btScalar*>(body.getVelocityVector()), 6 + body.getNumDofs()};
}

/// Memory of the sleep of a multibody, which has no public getters.
struct MultiBodySleep {
  btScalar &timer, &threshold, &timeout;
};
MultiBodySleep sleepOf(btMultiBody& body) noexcept;

AMBIENT_END
