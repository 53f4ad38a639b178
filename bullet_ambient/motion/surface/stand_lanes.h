#pragma once

#include "bullet_ambient/base/instruction_set.h"
#include "bullet_ambient/motion/lanes/surface_lanes.h"
#include "bullet_ambient/motion/surface/surface_stand.h"

namespace ambient {

/// Computes from the place of a stand what follows from it.
void completeStand(const SurfaceModel& model, SurfaceStand& stand) noexcept;
/// The stand at a place; `plane_B` with the density and gravity that count. Cost: 1 us for a hull
/// of some hundred triangles.
SurfaceStand standAtSurface(const SurfaceModel& model, const SurfacePlane& plane_B) noexcept;

constexpr Kernels<const SurfaceKernel*> kSurfaceKernels{&kSurfaceKernelBaseline,
                                                        &kSurfaceKernelAvx2, &kSurfaceKernelAvx512};

/// Kernel of fastestInstructionSet().
const SurfaceKernel& fastestSurfaceKernel() noexcept;

/// Writes a place into lane `body`, as input of computeStands().
void setPlace(StandLanes& lanes, int body, const SurfaceModel& model,
              const SurfacePlace& place) noexcept;
/// Writes into lane `body` what a flight reads of a stand.
void setStand(StandLanes& lanes, int body, const SurfaceStand& stand) noexcept;
/// Writes into a stand what computeStands() has found at its place.
void readStand(const StandLanes& lanes, int body, SurfaceStand& stand) noexcept;

/// A body in a lane. The place gets another inertia where its own is not positive definite.
struct BodyInLane {
  const SurfaceModel* model;
  SurfacePlace* place;
};
/// SurfaceKernel::stand() for the active lanes. Where K is not positive definite, positiveInertia()
/// takes its place.
void computeStands(StandLanes& lanes, const BodyInLane* bodies, int count) noexcept;

}  // namespace ambient
