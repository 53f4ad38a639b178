#pragma once

#include "bullet_ambient/fluid_body/packed_faces.h"
#include "bullet_ambient/force/face_loads.h"

namespace ambient {

/// The total of computeFaceLoads() in single precision: on large meshes 0.45 ns per face with AVX2,
/// 0.7 with friction. At alpha = pi/2 blocks of faces in the lee are left out. Arguments as there.
/// Rounding errors grow with the velocity of the faces, not with their slip: about 1e-6 of 1/2 rho
/// sum A_i |u_s,i| |u_i|, and a face at the separation angle may fall on the other side of it. No
/// range is lost: the motion is scaled before it is rounded. The same bits on every machine.
Wrench computeFaceLoad(const PackedFaces& faces, double reference_length,
                       const Twist& relative_twist, const LoadSettings& settings) noexcept;

}  // namespace ambient
