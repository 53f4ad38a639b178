#include "preprocess/builder/body_extents.h"

namespace ambient {

Vector3 extentsOf(const FluidBody& body) {
  const std::vector<double>& v = body.surface.vertices;
  const auto count = static_cast<Eigen::Index>(v.size() / 3);
  if (count == 0) return Vector3::Zero();
  const Eigen::Map<const Eigen::Matrix3Xd> vertices(v.data(), 3, count);
  return vertices.rowwise().maxCoeff() - vertices.rowwise().minCoeff();
}

}  // namespace ambient
