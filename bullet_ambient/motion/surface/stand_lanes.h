#pragma once

#include "bullet_ambient/base/instruction_set.h"
#include "bullet_ambient/motion/lanes/surface_lanes.h"
#include "bullet_ambient/motion/surface/surface_stand.h"

namespace ambient {

/// Computes the fields of up to kFlightsTogether SurfaceStands that follow from their
/// SurfacePlaces, side by side. The bits of a stand do not depend on the others.
void completeStands(const SurfaceModel* const* models, SurfaceStand* const* stands,
                    int count) noexcept;
/// Computes the stand of a body for a plane in B, whose density and gravity count. Cost: 1 us for a
/// hull of some hundred triangles.
SurfaceStand standAtSurface(const SurfaceModel& model, const SurfacePlane& plane_B,
                            const VesselWater& water = {}) noexcept;

extern const Kernels<const SurfaceKernel*> kSurfaceKernels;

inline void setLane(FlightLane (&to)[kSymmetricEntries], int body,
                    const SymmetricMatrix& m) noexcept {
  for (int entry = 0; entry < kSymmetricEntries; ++entry) to[entry][body] = m.entries[entry];
}

/// Reads lane `body`.
inline SymmetricMatrix symmetricOf(const FlightLane (&from)[kSymmetricEntries], int body) noexcept {
  SymmetricMatrix m;
  for (int entry = 0; entry < kSymmetricEntries; ++entry) m.entries[entry] = from[entry][body];
  return m;
}

/// Writes a place into lane `body`, as input of computeStands().
void setPlace(StandLanes& lanes, int body, const SurfaceModel& model,
              const SurfacePlace& place) noexcept;
/// Writes into lane `body` the fields of a stand that a flight reads.
void setStand(StandLanes& lanes, int body, const SurfaceModel& model,
              const SurfaceStand& stand) noexcept;
/// Copies the result of computeStands() from lane `body` to a stand.
void readStand(const StandLanes& lanes, int body, SurfaceStand& stand) noexcept;

/// Calls SurfaceKernel::stand() for the active lanes. Replaces a K that is not positive definite by
/// positiveInertia(), in the place of the body, too.
void computeStands(StandLanes& lanes, const SurfaceModel* const* models,
                   SurfacePlace* const* places, int count) noexcept;

}  // namespace ambient
