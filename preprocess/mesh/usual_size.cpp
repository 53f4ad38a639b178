#include "preprocess/mesh/usual_size.h"

#include <cmath>
#include <sstream>

#include "bullet_ambient/base/elementary.h"
#include "preprocess/mesh/input_error.h"
#include "preprocess/mesh/mass_properties.h"

namespace ambient {
namespace {

// Refuses bodies and sheets that are too narrow, with the limit of checkMesh(); generated shapes do
// not pass through that.
void requireUsualWidth(const MeshProperties& properties, double size, bool sheet,
                       const std::string& source) {
  constexpr double kLeastArea = 1e-12;
  const double width = properties.area / (size * size);
  if (!(width >= kLeastArea)) {
    raiseInputError(source, "it is too narrow: its area over the square of its size ",
                    "must be at least ", kLeastArea);
  }
  const double thickness = properties.volume / portable::pow(properties.area, 1.5);
  if (!sheet && !(thickness >= kLeastVolume)) {
    raiseInputError(source, "it is too thin: its volume over its area^1.5 is ", thickness,
                    ", at least ", kLeastVolume, " needed (a sheet has no thickness)");
  }
}

// Beyond these a file's unit is likelier to be another one than the body to be of that size: no
// ship is larger.
constexpr double kSmallestLikely = 1e-3, kLargestLikely = 500;  // [m]

}  // namespace

std::string extentsText(const Eigen::Vector3d& extents) {
  std::ostringstream text;
  text.precision(4);
  text << extents.x() << " x " << extents.y() << " x " << extents.z() << " m";
  return text.str();
}

std::string unlikelySizeWarning(const TriangleMesh& mesh, bool is_scaled,
                                const std::string& source) {
  const double size = mesh.extents().maxCoeff();
  if (size >= kSmallestLikely && (size <= kLargestLikely || is_scaled)) return {};
  return source + ": its size is " + extentsText(mesh.extents()) +
         (size > kLargestLikely
              ? "; lengths are metres: if the file is in millimetres, --scale 0.001"
              : "; lengths are metres: if the file is in others, --scale FACTOR");
}

void requireUsualSize(const TriangleMesh& mesh, bool sheet, const std::string& source) {
  const double size = mesh.extents().norm();
  if (!(size >= kSmallestSize && size <= kLargestSize)) {
    const std::string limits = "; it must be 1e-9 m to 1e9 m";
    const std::string what = "the diagonal of its bounding box is ";
    if (!std::isfinite(size)) raiseInputError(source, what, "not finite", limits);
    raiseInputError(source, what, size, " m", limits);
  }
  requireUsualWidth(computeMassProperties(mesh, sheet), size, sheet, source);
}

}  // namespace ambient
