#include "preprocess/shape/shape_limits.h"

#include <sstream>

#include "preprocess/mesh/input_error.h"
#include "preprocess/mesh/usual_size.h"

namespace ambient {
namespace {

/// Half of the sizes of a shape's bounding box along its axes [m]; a sheet has two, a file none.
struct HalfExtents {
  using Sizes = Eigen::VectorXd;

  Sizes operator()(const SphereShape& s) const { return Eigen::Vector3d::Constant(s.radius); }
  Sizes operator()(const BoxShape& s) const { return s.half_sizes; }
  Sizes operator()(const EllipsoidShape& s) const { return s.semi_axes; }
  Sizes operator()(const CylinderShape& s) const { return round(s.radius, s.height / 2); }
  Sizes operator()(const CapsuleShape& s) const { return round(s.radius, s.height / 2 + s.radius); }
  Sizes operator()(const ConeShape& s) const { return round(s.radius, s.height / 2); }
  Sizes operator()(const RectangularSheetShape& s) const { return s.size / 2; }
  Sizes operator()(const EllipticSheetShape& s) const { return s.semi_axes; }
  template <class FromFile>
  Sizes operator()(const FromFile&) const {
    return {};
  }

  static Sizes round(double radius, double half_height) {
    return Eigen::Vector3d(radius, radius, half_height);
  }
};

std::string listOf(const Eigen::VectorXd& sizes) {
  std::ostringstream text;
  text.precision(9);
  for (Eigen::Index k = 0; k < sizes.size(); ++k) text << (k == 0 ? "" : " x ") << sizes[k];
  return text.str();
}

}  // namespace

void requireUsualExtents(const ShapeDescription& shape, double scale) {
  constexpr double kMostSlender = 1e6;
  const Eigen::VectorXd sizes = scale * std::visit(HalfExtents{}, shape.geometry);
  if (sizes.size() == 0) return;
  const double least = sizes.minCoeff(), most = sizes.maxCoeff();
  if (!(most <= kMostSlender * least))
    raiseInputError(shape.source, "its half extents are ", listOf(sizes),
                    " m; the longest must be at most ", kMostSlender, " times the shortest");
  if (!(least >= kSmallestSize && most <= kLargestSize))
    raiseInputError(shape.source, "its half extents are ", listOf(sizes), " m; each must be ",
                    kSmallestSize, " m to ", kLargestSize, " m");
}

}  // namespace ambient
