#include "preprocess/mesh/usual_size.h"

#include <cmath>

#include "preprocess/mesh/input_error.h"
#include "preprocess/mesh/mass_properties.h"

namespace ambient {
namespace {

// As checkMesh() has it; shapes that are made need not have passed it.
void requireUsualWidth(const MeshProperties& properties, double size, bool sheet,
                       const std::string& source) {
  constexpr double kLeastVolume = 1e-6, kLeastArea = 1e-12;
  const double width = properties.area / (size * size);
  if (!(width >= kLeastArea)) {
    raiseInputError(source, "it is too narrow: its area over the square of its size ",
                    "must be at least ", kLeastArea);
  }
  const double thickness = properties.volume / std::pow(properties.area, 1.5);
  if (!sheet && !(thickness >= kLeastVolume)) {
    raiseInputError(source, "it is too thin: its volume over its area^1.5 is ", thickness,
                    ", at least ", kLeastVolume, " needed (a sheet has no thickness)");
  }
}

// Far beyond these sizes areas, volumes and moments leave the range of a double.
constexpr double kSmallestSize = 1e-9, kLargestSize = 1e9;  // [m]

}  // namespace

void requireUsualSize(const TriangleMesh& mesh, bool sheet, const std::string& source) {
  const Eigen::Vector3d extents =
      mesh.vertices.rowwise().maxCoeff() - mesh.vertices.rowwise().minCoeff();
  const double size = extents.norm();
  if (!(size >= kSmallestSize && size <= kLargestSize)) {
    const std::string limits = "; it must be 1e-9 m to 1e9 m";
    const std::string what = "the diagonal of its bounding box is ";
    if (!std::isfinite(size)) raiseInputError(source, what, "not finite", limits);
    raiseInputError(source, what, size, " m", limits);
  }
  requireUsualWidth(sheet ? computeSheetMassProperties(mesh) : computeMassProperties(mesh), size,
                    sheet, source);
}

}  // namespace ambient
