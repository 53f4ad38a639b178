#include <Eigen/Geometry>
#include <algorithm>
#include <array>

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/fluid_body/flat_sides.h"
#include "bullet_ambient/fluid_body/form_shape.h"
#include "bullet_ambient/fluid_body/sharpness.h"

namespace ambient {
namespace {

constexpr std::size_t kNodes = 4;  // Gauss points per direction
constexpr std::size_t kPoints = kNodes * kNodes;

struct Node {
  double place, weight;  // abscissa in [0, 1], and weight; weights add up to 1
};

/// Gauss-Legendre rule of 4 points.
constexpr std::array<Node, kNodes> kRule{{{0.06943184420297371, 0.17392742256872693},
                                          {0.33000947820757187, 0.32607257743127307},
                                          {0.6699905217924281, 0.32607257743127307},
                                          {0.9305681557970263, 0.17392742256872693}}};

/// One integration point on a flat side: a face of the form law.
struct Point {
  Vector3 place;
  double area;
};

/// Adds the points of a plane quadrilateral; two equal corners make it a triangle.
void addPoints(const std::array<Vector3, 4>& corners, std::vector<Point>& points) {
  const auto& [a, b, c, d] = corners;
  for (const Node& u : kRule)
    for (const Node& v : kRule) {
      const Vector3 low = a + u.place * (b - a), high = d + u.place * (c - d);
      const Vector3 along = (1 - v.place) * (b - a) + v.place * (c - d);
      points.push_back(
          {low + v.place * (high - low), u.weight * v.weight * along.cross(high - low).norm()});
    }
}

std::vector<Point> pointsOf(const FlatSide& side) {
  std::vector<Point> points;
  const std::vector<Vector3>& corners = side.corners;
  for (std::size_t i = 1; i + 1 < corners.size(); i += 2)
    addPoints(
        {corners[0], corners[i], corners[i + 1], corners[i + 2 < corners.size() ? i + 2 : i + 1]},
        points);
  return points;
}

/// Returns true if points replace the triangles of a side. All its faces must have sharpness 1, and
/// the side must have more triangles than points or at least kLarge of the surface's area.
bool deservesPoints(const FlatSide& side, const FaceTable& faces, double surface_area) {
  constexpr double kLarge = 0.02;
  double area = 0;
  for (const int t : side.triangles) {
    const auto face = static_cast<std::size_t>(t);
    if (faces.sharpness[face] != 1) return false;
    area += faces.area[face];
  }
  const std::size_t points = (side.corners.size() - 1) / 2 * kPoints;
  return points < side.triangles.size() || area >= kLarge * surface_area;
}

/// Sharpness of a flat side, eq. (45): more than 1 if the side is long.
double sharpnessOf(const FlatSide& side) {
  constexpr double kEndless = 1.98 / 1.17 - 1;  // gain of an endless strip: C_D over the square's
  constexpr double kHalf = 40;                  // y of eq. (45) at half of that gain
  const std::vector<Vector3>& corners = side.corners;
  double outline = 0, twice_area = 0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vector3& next = corners[(i + 1) % corners.size()];
    outline += (next - corners[i]).norm();
    twice_area += (corners[i] - corners[0]).cross(next - corners[0]).norm();
  }
  const double length = std::max(outline * outline / (2 * twice_area) - 4, 0.0);
  return static_cast<double>(static_cast<float>(1 + kEndless * length / (length + kHalf)));
}

/// Collects faces with their sharpness.
class FaceCollector {
 public:
  explicit FaceCollector(const FaceTable& faces) : faces_(faces) {}

  void copy(std::size_t face) {
    add(faces_.normal(face), faces_.centroid(face), faces_.area[face], faces_.sharpness[face]);
  }
  void add(const Vector3& normal, const Vector3& place, double area, double sharpness) {
    result.add(normal, place, area);
    result.sharpness.push_back(sharpness);
  }

  FaceTable result;

 private:
  const FaceTable& faces_;
};

FaceTable facesWithPoints(const FluidBody& body) {
  FaceTable faces = body.faces;
  if (faces.sharpness.empty()) faces.sharpness = computeSharpness(body);
  AMBIENT_ASSERT(faces.sharpness.size() == faces.size());
  if (body.surface.triangles.empty()) return faces;
  const SurfaceTriangles mesh(body);
  FaceCollector collector(faces);
  std::vector<bool> is_replaced(static_cast<std::size_t>(mesh.size()));
  for (const FlatSide& side : findFlatSides(mesh)) {
    if (!deservesPoints(side, faces, body.area)) continue;
    const double sharpness = sharpnessOf(side);
    for (const Point& point : pointsOf(side)) {
      collector.add(side.normal, point.place, point.area, sharpness);
      if (mesh.isSheet()) collector.add(-side.normal, point.place, point.area, sharpness);
    }
    for (const int t : side.triangles) is_replaced[static_cast<std::size_t>(t)] = true;
  }
  for (std::size_t face = 0; face < faces.size(); ++face)
    if (!is_replaced[face % is_replaced.size()]) collector.copy(face);
  return std::move(collector.result);
}

}  // namespace

FaceTable formLawFaces(const FluidBody& body, const FormShape& shape) {
  FaceTable faces = facesWithPoints(body);
  for (double& sharpness : faces.sharpness)
    if (sharpness < 1) sharpness += shape.wing * (1 - sharpness);
  return faces;
}

}  // namespace ambient
