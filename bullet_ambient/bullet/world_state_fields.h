#pragma once

#include "bullet_ambient/bullet/byte_stream.h"
#include "bullet_ambient/bullet/multibody_fields.h"
#include "bullet_ambient/bullet/precision_check.h"
#include "bullet_ambient/bullet/world_state.h"

namespace ambient {
inline namespace BULLET_AMBIENT_PRECISION_NAMESPACE {

// The fields of a saved state in the order of their bytes, once for writing and reading. The sizes
// are the least that entries take in the precision of less bytes; they bound lengths that are read.
inline constexpr std::size_t kPairSize = 8, kContactSize = 16, kJointSize = 5, kPointSize = 100,
                             kMultiBodyJointSize = 4;

template <class Stream, class State>
void transferMedium(Stream& s, State& medium) {
  s.number(medium.density);
  s.number(medium.viscosity);
  transferMatrix(s, medium.velocity);
  transferMatrix(s, medium.acceleration);
}

template <class Stream, class State>
void transferSettings(Stream& s, State& def) {
  transferMedium(s, def.medium);
  transferFlag(s, def.follow_regions);
  s.number(def.wave_damping);
  s.number(def.flow.separation_angle);
  transferEnum(s, def.flow.law, kPressureLawNames);
  transferFlag(s, def.flow.skin_friction);
  s.number(def.flow.stall_lag);
  transferEnum(s, def.flow.precision, kLoadPrecisionNames);
  s.number(def.flow.maximum_load_error);
  transferEnum(s, def.flight.integrator, kIntegratorNames);
  s.number(def.flight.tolerance);
  s.number(def.flight.max_substeps);
  transferMatrix(s, def.fluid_frame.rotation);
  transferMatrix(s, def.fluid_frame.translation);
}

template <class Stream, class Plane>
void transferPlane(Stream& s, Plane& plane) {
  if (!transferPresence(s, plane)) return;
  transferMatrix(s, plane->normal);
  s.number(plane->height);
  s.number(plane->density);
  s.number(plane->gravity);
}

template <class Stream, class State>
void transferFlight(Stream& s, State& state) {
  transferMedium(s, state.medium);
  auto region = static_cast<std::int32_t>(state.place.region);
  s.number(region);
  if constexpr (Stream::kReads) state.place.region = static_cast<RegionId>(region);
  transferFlag(s, state.place.is_above);
  transferFlag(s, state.place.is_at_surface);
  for (int i = 0; i < 2; ++i) {
    s.number(state.waves.heave[i]);
    transferMatrix(s, state.waves.tilt_W[i]);
  }
  s.number(state.waves.heave_energy);
  s.number(state.waves.tilt_energy);
  transferPlane(s, state.met_B);
  transferMatrix(s, state.memory.load_W.torque);
  transferMatrix(s, state.memory.load_W.force);
  transferFlag(s, state.memory.has_load);
  s.number(state.memory.substep);
  transferMatrix(s, state.left_W.angular);
  transferMatrix(s, state.left_W.linear);
  s.number(state.counters.substeps);
  s.number(state.counters.load_evaluations);
  s.number(state.counters.faces);
  s.number(state.counters.guarded);
  s.number(state.counters.coarse);
  s.number(state.counters.halted);
  s.number(state.counters.energy_removed);
  s.number(state.counters.rows);
  s.number(state.counters.joint_rows);
  s.number(state.counters.rejected);
  s.number(state.counters.regions_asked);
  s.number(state.counters.medium_changes);
  s.number(state.counters.too_long);
}

template <class Stream, class State>
void transferBody(Stream& s, State& body) {
  transferObject(s, body);
  for (auto* v :
       {&body.linear_velocity, &body.angular_velocity, &body.total_force, &body.total_torque,
        &body.gravity, &body.inverse_inertia, &body.linear_factor, &body.angular_factor}) {
    transferVector(s, *v);
  }
  for (auto* number : {&body.inverse_mass, &body.linear_damping, &body.angular_damping,
                       &body.linear_sleeping_threshold, &body.angular_sleeping_threshold}) {
    s.number(*number);
  }
  s.number(body.flags);
}

template <class Stream, class State>
void transferPoint(Stream& s, State& point) {
  for (auto* v : {&point.m_localPointA, &point.m_localPointB, &point.m_positionWorldOnB,
                  &point.m_positionWorldOnA, &point.m_normalWorldOnB, &point.m_lateralFrictionDir1,
                  &point.m_lateralFrictionDir2}) {
    transferVector(s, *v);
  }
  for (auto* number :
       {&point.m_distance1, &point.m_combinedFriction, &point.m_combinedRollingFriction,
        &point.m_combinedSpinningFriction, &point.m_combinedRestitution, &point.m_appliedImpulse,
        &point.m_prevRHS, &point.m_appliedImpulseLateral1, &point.m_appliedImpulseLateral2,
        &point.m_contactMotion1, &point.m_contactMotion2, &point.m_contactCFM, &point.m_contactERP,
        &point.m_frictionCFM}) {
    s.number(*number);
  }
  for (auto* number : {&point.m_partId0, &point.m_partId1, &point.m_index0, &point.m_index1,
                       &point.m_contactPointFlags, &point.m_lifeTime}) {
    s.number(*number);
  }
}

template <class Stream, class State>
void transferPair(Stream& s, State& pair) {
  s.number(pair.object_a);
  s.number(pair.object_b);
}

template <class Stream, class State>
void transferContact(Stream& s, State& contact) {
  transferPair(s, contact.pair);
  s.number(contact.part);
  transferSize(s, contact.points, kPointSize);
  for (auto& point : contact.points) transferPoint(s, point);
}

template <class Stream, class State>
void transferContactsAndJoints(Stream& s, State& state) {
  transferSize(s, state.pairs, kPairSize);
  for (auto& pair : state.pairs) transferPair(s, pair);
  transferSize(s, state.contacts, kContactSize);
  for (auto& contact : state.contacts) transferContact(s, contact);
  transferSize(s, state.joints, kJointSize);
  for (auto& joint : state.joints) {
    transferFlag(s, joint.is_enabled);
    s.number(joint.applied_impulse);
  }
  transferSize(s, state.multi_body_joints, kMultiBodyJointSize);
  for (auto& joint : state.multi_body_joints) transferNumbers(s, joint.applied_impulses);
  auto seed = static_cast<std::uint64_t>(state.random_seed);
  s.number(seed);
  s.number(state.time);
  if constexpr (Stream::kReads) state.random_seed = static_cast<unsigned long>(seed);
}

}  // namespace BULLET_AMBIENT_PRECISION_NAMESPACE
}  // namespace ambient
