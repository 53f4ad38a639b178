#include "bullet_ambient/force/face_sums_kernel.h"

namespace ambient {

FaceSums sumFacesAvx2(const FaceColumns& faces, const FaceMotion& motion,
                      bool with_friction) noexcept {
  return sumFaces(faces, motion, with_friction);
}

}  // namespace ambient
