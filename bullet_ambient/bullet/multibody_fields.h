#pragma once

#include "bullet_ambient/bullet/byte_stream.h"
#include "bullet_ambient/bullet/precision_check.h"

namespace ambient {
inline namespace BULLET_AMBIENT_PRECISION_NAMESPACE {

// As world_state_fields.h, of what is in a world besides rigid bodies.
inline constexpr std::size_t kLinkSize = 160, kLinkFluidSize = 100;

template <class Stream, class State>
void transferObject(Stream& s, State& object) {
  transferPose(s, object.pose);
  transferPose(s, object.interpolation_pose);
  transferVector(s, object.interpolation_linear_velocity);
  transferVector(s, object.interpolation_angular_velocity);
  for (auto* number : {&object.friction, &object.rolling_friction, &object.spinning_friction,
                       &object.restitution, &object.ccd_radius, &object.ccd_threshold,
                       &object.contact_processing_threshold, &object.deactivation_time}) {
    s.number(*number);
  }
  s.number(object.activation_state);
  s.number(object.collision_flags);
}

template <class Stream, class Numbers>
void transferNumbers(Stream& s, Numbers& numbers) {
  transferSize(s, numbers, sizeof numbers.front());
  for (auto& number : numbers) s.number(number);
}

template <class Stream, class Turn>
void transferTurn(Stream& s, Turn& q) {
  for (int i = 0; i < 4; ++i) s.number(q[i]);
}

/// Whether the optional field is there; makes it if it is read.
template <class Stream, class Optional>
bool transferPresence(Stream& s, Optional& field) {
  bool is_there = field.has_value();
  transferFlag(s, is_there);
  if constexpr (Stream::kReads) {
    if (is_there) field.emplace();
  }
  return is_there;
}

template <class Stream, class State>
void transferLink(Stream& s, State& link) {
  s.number(link.mass);
  transferVector(s, link.inertia);
  transferVector(s, link.force);
  transferVector(s, link.torque);
  for (auto& number : link.joint_position) s.number(number);
  for (auto& number : link.interpolation_position) s.number(number);
  for (auto& number : link.joint_force) s.number(number);
  transferPose(s, link.pose);
  if (transferPresence(s, link.collider)) transferObject(s, *link.collider);
}

/// All but its fluids.
template <class Stream, class State>
void transferMultiBody(Stream& s, State& body) {
  transferVector(s, body.position);
  transferVector(s, body.interpolation_position);
  transferTurn(s, body.orientation);
  transferTurn(s, body.interpolation_orientation);
  transferNumbers(s, body.velocity);
  transferSize(s, body.links, kLinkSize);
  for (auto& link : body.links) transferLink(s, link);
  for (auto* number : {&body.linear_damping, &body.angular_damping, &body.velocity_limit,
                       &body.sleep_timer, &body.sleep_threshold, &body.sleep_timeout})
    s.number(*number);
  for (auto* flag : {&body.is_awake, &body.can_sleep, &body.can_wake_up, &body.has_gyroscopic_term})
    transferFlag(s, *flag);
  s.number(body.turn_reserve);
}

/// All but the fluid itself.
template <class Stream, class State>
void transferLinkFluid(Stream& s, State& fluid) {
  s.number(fluid.link);
  if (transferPresence(s, fluid.flow)) transferMatrix(s, *fluid.flow);
}

}  // namespace BULLET_AMBIENT_PRECISION_NAMESPACE
}  // namespace ambient
