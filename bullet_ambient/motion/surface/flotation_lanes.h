#pragma once

#include "bullet_ambient/base/instruction_set.h"
#include "bullet_ambient/motion/lanes/surface_lanes.h"
#include "bullet_ambient/motion/surface/flotation.h"

namespace ambient {

/// Computes the fields of up to kFlightsTogether Flotations that follow from their
/// SurfacePlaces, side by side. The bits of a flotation do not depend on the others.
void completeFlotations(const SurfaceModel* const* models, Flotation* const* flotations,
                        int count) noexcept;
/// Computes the flotation of a body for a plane in B, whose density and gravity count. Cost: 1 us
/// for a hull of some hundred triangles.
Flotation flotationAt(const SurfaceModel& model, const SurfacePlane& plane_B,
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

/// Writes a place into lane `body`, as input of computeFlotations().
void setPlace(FlotationLanes& lanes, int body, const SurfaceModel& model,
              const SurfacePlace& place) noexcept;
/// Writes into lane `body` the fields of a flotation that a flight reads.
void setFlotation(FlotationLanes& lanes, int body, const SurfaceModel& model,
                  const Flotation& flotation) noexcept;
/// Writes what water that has moved changes into lane `body`.
void setMoved(WaterLanes& lanes, int body, const WaterMoved& moved) noexcept;
/// Writes the modes of the water in a hold into lane `body`, and keeps them in `own`.
void setSlosh(WaterLanes& lanes, int body, const SloshingAt& at, std::size_t hold, double damping,
              const Sloshing& state, SloshAlong (&own)[2]) noexcept;
/// Moves a state by what the kernel has made of those modes, if there are any.
void moveSlosh(const WaterLanes& lanes, int body, const SloshAlong (&own)[2],
               Sloshing* state) noexcept;
/// Copies the result of computeFlotations() from lane `body` to a flotation.
void readFlotation(const FlotationLanes& lanes, int body, Flotation& flotation) noexcept;

/// Calls SurfaceKernel::computeFlotations() for the active lanes. Replaces a K that is not positive
/// definite by positiveInertia(), in the place of the body, too.
void computeFlotations(FlotationLanes& lanes, const SurfaceModel* const* models,
                       SurfacePlace* const* places, int count) noexcept;

}  // namespace ambient
