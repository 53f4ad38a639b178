#pragma once

#include "bullet_ambient/force/face_loads.h"

namespace ambient {

/// The flow at one face and what it does there, in F.
struct FaceFlow {
  bool is_attached = false;
  Vector3 slip = Vector3::Zero();      ///< u_s, of the fluid along the wall [m/s]; 0 if separated
  Vector3 pressure = Vector3::Zero();  ///< force of the dynamic pressure [N]
  Vector3 friction = Vector3::Zero();  ///< force of skin friction [N]
};

/// One face of computeFaceLoads(), for drawing and inspection: summed over the faces they are the
/// same forces, to rounding. Arguments as there. @pre face < faces.size().
FaceFlow computeFaceFlow(const FaceTable& faces, std::size_t face, double reference_length,
                         const Twist& relative_twist, const LoadSettings& settings) noexcept;

}  // namespace ambient
