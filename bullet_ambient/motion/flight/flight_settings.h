#pragma once

namespace ambient {

struct FlightMemory;
struct FlightResult;
struct FlightTask;
struct RigidState;

/// Flies one body over the task's duration in place of the passive leapfrog. States are relative to
/// the frame that moves with the ambient flow. Must allocate nothing; runs on any thread.
using OwnFlight = FlightResult (*)(const FlightTask&, const RigidState& start,
                                   const FlightMemory&) noexcept;

/// Free flight of one body over one step of the world.
struct FlightSettings {
  /// Velocity error per substep relative to the motion [1], docs/theory.md eq. (25).
  double tolerance = 1e-3;
  /// Largest number of substeps per step. 0: 16, or 64 for bodies lighter than their added mass; 1:
  /// fast mode, one evaluation per step. Other integrators have their own meaning of 0.
  int max_substeps = 0;
  /// Null: the passive leapfrog, whose energy cannot grow at any step. Not part of saved states.
  OwnFlight own_flight = nullptr;
};

}  // namespace ambient
