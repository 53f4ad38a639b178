#include "preprocess/reduced_loads/face_mirrors.h"

namespace ambient {
namespace {

void addImage(const FaceTable& faces, std::size_t i, const Vector3& signs, double area,
              FaceTable& to) {
  to.add(signs.cwiseProduct(faces.normal(i)), signs.cwiseProduct(faces.centroid(i)), area);
  to.sharpness.push_back(faces.sharpness[i]);
}

}  // namespace

FaceMirrors::FaceMirrors(unsigned axes) {
  for (unsigned image = 0; image < 8; ++image) {
    if ((image & axes) != image) continue;
    signs_.emplace_back((image & 1) ? -1 : 1, (image & 2) ? -1 : 1, (image & 4) ? -1 : 1);
  }
}

FaceTable FaceMirrors::folded(const FaceTable& faces) const {
  FaceTable result;
  for (std::size_t i = 0; i < faces.size(); ++i) {
    Vector3 signs = Vector3::Ones();
    for (int axis = 0; axis < 3; ++axis)
      if (faces.centroid(i)[axis] < 0) signs[axis] = signs_.back()[axis];
    addImage(faces, i, signs, faces.area[i], result);
  }
  return result;
}

FaceTable FaceMirrors::unfolded(const FaceTable& faces) const {
  FaceTable result;
  for (std::size_t i = 0; i < faces.size(); ++i)
    for (const Vector3& signs : signs_) addImage(faces, i, signs, faces.area[i] / images(), result);
  return result;
}

FaceTable FaceMirrors::mirrored(const FaceTable& faces) const {
  FaceTable result;
  for (std::size_t i = 0; i < faces.size(); ++i)
    addImage(faces, i, signs_.back(), faces.area[i], result);
  return result;
}

}  // namespace ambient
