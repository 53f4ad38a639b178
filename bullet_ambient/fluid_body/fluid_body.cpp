#include "bullet_ambient/fluid_body/fluid_body.h"

#include "bullet_ambient/spatial/inertia.h"

namespace ambient {

void FaceTable::reserve(std::size_t faces) {
  for (std::vector<double>* column :
       {&normal_x, &normal_y, &normal_z, &centroid_x, &centroid_y, &centroid_z, &area})
    column->reserve(faces);
}

void FaceTable::add(const Vector3& face_normal, const Vector3& face_centroid, double face_area) {
  normal_x.push_back(face_normal.x());
  normal_y.push_back(face_normal.y());
  normal_z.push_back(face_normal.z());
  centroid_x.push_back(face_centroid.x());
  centroid_y.push_back(face_centroid.y());
  centroid_z.push_back(face_centroid.z());
  area.push_back(face_area);
}

Eigen::Matrix<double, Eigen::Dynamic, 6> computeSlipMatrix(const FaceTable& faces) {
  const auto face_count = static_cast<Eigen::Index>(faces.size());
  Eigen::Matrix<double, Eigen::Dynamic, 6> slip(3 * face_count, 6);
  for (Eigen::Index i = 0; i < face_count; ++i) {
    const Vector3 n = faces.normal(static_cast<std::size_t>(i));
    const Vector3 c = faces.centroid(static_cast<std::size_t>(i));
    const Matrix3 tangential = Matrix3::Identity() - n * n.transpose();
    slip.block<3, 3>(3 * i, 0) = tangential * crossMatrix(c);  // u_s = -P (v + w x c)
    slip.block<3, 3>(3 * i, 3) = -tangential;
  }
  return slip;
}

}  // namespace ambient
