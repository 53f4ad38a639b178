#pragma once

#include "bullet_ambient/force/loads/face_loads.h"

namespace ambient {

/// Flow at one face and the resulting forces, in F.
struct FaceFlow {
  bool is_attached = false;
  Vector3 slip = Vector3::Zero();      ///< u_s, fluid relative to the wall [m/s]; 0 if separated
  Vector3 pressure = Vector3::Zero();  ///< force of the dynamic pressure [N]
  Vector3 friction = Vector3::Zero();  ///< force of skin friction [N]
};

/// Computes the flow at one face, for drawing and inspection. The forces of all faces add up to
/// computeFaceLoads(), which has the same arguments, up to rounding. @pre face < faces.size()
FaceFlow computeFaceFlow(const FaceTable& faces, std::size_t face, double reference_length,
                         const Twist& relative_twist, const LoadSettings& settings) noexcept;

}  // namespace ambient
