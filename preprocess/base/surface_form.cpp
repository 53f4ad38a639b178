#include "preprocess/base/surface_form.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <tuple>

#include "bullet_ambient/base/ambient_assert.h"
#include "preprocess/base/numerics.h"
#include "preprocess/base/surface_triangles.h"

namespace ambient {

std::vector<std::int32_t> fewTriangles(const Surface& surface, int count) {
  const SurfaceTriangles mesh(surface);
  std::vector<std::int32_t> few;
  std::vector<bool> is_replaced(static_cast<std::size_t>(mesh.size()));
  const auto add = [&](int a, int b, int c) {
    for (const int vertex : {a, b, c}) few.push_back(mesh.source(vertex));
  };
  for (const FlatSide& side : findFlatSides(mesh)) {
    const std::vector<int>& c = side.corners;
    const bool stays = *std::max_element(side.triangles.begin(), side.triangles.end()) >= count;
    if (stays || c.size() >= side.triangles.size() + 2) continue;
    for (std::size_t i = 2; i < c.size(); ++i) add(c[0], c[i - 1], c[i]);
    for (const int t : side.triangles) is_replaced[static_cast<std::size_t>(t)] = true;
  }
  for (int t = 0; t < mesh.size(); ++t)
    if (!is_replaced[static_cast<std::size_t>(t)])
      add(mesh.vertex(t, 0), mesh.vertex(t, 1), mesh.vertex(t, 2));
  few.shrink_to_fit();
  return few;
}

void makeSurfaceForm(FluidBody& body, const FormFaces& make_faces) {
  body.form = {};
  if (body.sphere_radius > 0) return;
  body.form.shape = formShapeOf(body);
  body.form.hull = fewTriangles(body.surface, static_cast<int>(body.surface.triangles.size() / 3));
  if (!body.wings.empty()) return makeWingForm(body);
  const FaceTable faces = make_faces ? make_faces(body) : formLawFaces(body, body.form.shape);
  body.form.faces = faces;  // a copy has no room to spare
}

namespace {

using Corners = std::array<Vector3, 3>;  // of a triangle

/// One integration point on a flat side: a face of the form law.
struct Point {
  Vector3 place;
  double area;
};

/// Makes the points of plane quadrilaterals and triangles: four each way, or, with `few_across`,
/// two where they are shorter than a tenth of the body's size, one where shorter than a twentieth.
class PointMaker {
 public:
  /// `size`: of the body [m].
  explicit PointMaker(double size) : size_(size) {}

  static constexpr double kLongest = 0.2;  ///< edge of a triangle with one point, in sizes

  /// Points of a flat side with these corners.
  std::vector<Point> pointsOf(const std::vector<Vector3>& corners, bool few_across) const {
    std::vector<Point> points;
    for (std::size_t i = 1; i + 1 < corners.size(); i += 2)
      if (i + 2 < corners.size())
        add({corners[0], corners[i], corners[i + 1], corners[i + 2]}, {4, few_across}, points);
      else
        add({corners[0], corners[i], corners[i + 1]}, few_across, points);
    return points;
  }

 private:
  struct Rule {
    int most;
    bool few_across;
  };

  int pointsAlong(double length, const Rule& rule) const {
    if (!rule.few_across || length >= 0.1 * size_) return rule.most;
    return length < 0.05 * size_ ? 1 : 2;
  }

  /// Adds the points of a plane quadrilateral.
  void add(const std::array<Vector3, 4>& corners, const Rule& rule,
           std::vector<Point>& points) const {
    const auto& [a, b, c, d] = corners;
    const int across = pointsAlong(std::max((b - a).norm(), (c - d).norm()), rule);
    const int up = pointsAlong(std::max((d - a).norm(), (c - b).norm()), rule);
    const GaussRule &u = kGaussRules[across - 1], &v = kGaussRules[up - 1];
    for (int i = 0; i < across; ++i)
      for (int j = 0; j < up; ++j) {
        const Vector3 low = a + u.place[i] * (b - a), high = d + u.place[i] * (c - d);
        const Vector3 along = (1 - v.place[j]) * (b - a) + v.place[j] * (c - d);
        points.push_back({low + v.place[j] * (high - low),
                          u.weight[i] * v.weight[j] * along.cross(high - low).norm()});
      }
  }

  /// Adds the points of a triangle, as three quadrilaterals that meet in its middle.
  void add(const Corners& corners, bool few_across, std::vector<Point>& points) const {
    const Vector3 middle = (corners[0] + corners[1] + corners[2]) / 3;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vector3 &here = corners[k], &next = corners[(k + 1) % 3], &last = corners[(k + 2) % 3];
      add({middle, (last + here) / 2, here, (here + next) / 2}, {3, few_across}, points);
    }
  }

  double size_;
};

/// Returns the sharpness that all faces of a side have, but for rounding; none if they differ.
std::optional<double> commonSharpness(const FlatSide& side, const FaceTable& faces) {
  constexpr double kRounding = 1e-6;
  const double first = faces.sharpness[static_cast<std::size_t>(side.triangles.front())];
  for (const int t : side.triangles)
    if (!(std::abs(faces.sharpness[static_cast<std::size_t>(t)] - first) <= kRounding))
      return std::nullopt;
  return first;
}

Corners cornersOf(const SurfaceTriangles& mesh, int triangle) {
  return {mesh.place(mesh.vertex(triangle, 0)), mesh.place(mesh.vertex(triangle, 1)),
          mesh.place(mesh.vertex(triangle, 2))};
}

/// Twice the distance that the surface reaches from the centre of volume [m].
double sizeOf(const FluidBody& body, const SurfaceTriangles& mesh) {
  double reach = 0;
  for (int v = 0; v < mesh.vertexCount(); ++v)
    reach = std::max(reach, (mesh.place(v) - body.centre_of_volume).norm());
  return 2 * reach;
}

bool isLong(const Corners& corners, double longest) {
  for (std::size_t k = 0; k < 3; ++k)
    if ((corners[(k + 1) % 3] - corners[k]).norm() > longest) return true;
  return false;
}

/// Returns true if so many points replace the triangles of a sharp side: it has more triangles, at
/// least kLarge of the surface's area, or edges around it and a triangle too long for one point.
bool deservesPoints(const FlatSide& side, std::size_t points, const SurfaceTriangles& mesh,
                    double whole_area, double longest) {
  constexpr double kLarge = 0.02;
  double area = 0;
  bool has_long = false;
  for (const int t : side.triangles) {
    area += mesh.area(t);
    has_long = has_long || (side.has_sharp_rim && isLong(cornersOf(mesh, t), longest));
  }
  return points < side.triangles.size() || area >= kLarge * whole_area || has_long;
}

/// Returns true for a narrow strip of a round surface with a triangle too long for one point.
bool isLongStrip(const FlatSide& side, const SurfaceTriangles& mesh, double size) {
  constexpr double kNarrow = 0.1;
  if (side.triangles.size() < 2) return false;
  double longest = 0, twice_area = 0;
  bool has_long = false;
  for (const int t : side.triangles) {
    const Corners c = cornersOf(mesh, t);
    twice_area += (c[1] - c[0]).cross(c[2] - c[0]).norm();
    has_long = has_long || isLong(c, PointMaker::kLongest * size);
  }
  for (std::size_t i = 0; i < side.corners.size(); ++i) {
    const int next = side.corners[(i + 1) % side.corners.size()];
    longest = std::max(longest, (mesh.place(next) - mesh.place(side.corners[i])).norm());
  }
  return has_long && twice_area / 2 < kNarrow * size * longest;
}

/// Turns an outline to the first corner of its longest edge, of equal ones to the lowest corner: it
/// does not hang on the numbers of vertices, nor on the frame where one edge is the longest.
void startAtLongestEdge(std::vector<Vector3>& corners) {
  constexpr double kEqual = 1e-5;  // of lengths in single precision
  const auto edgeAt = [&](std::size_t i) {
    return (corners[(i + 1) % corners.size()] - corners[i]).norm();
  };
  const auto place = [&](std::size_t i) {
    return std::tie(corners[i].x(), corners[i].y(), corners[i].z());
  };
  double longest = 0;
  for (std::size_t i = 0; i < corners.size(); ++i) longest = std::max(longest, edgeAt(i));
  std::size_t first = corners.size();
  for (std::size_t i = 0; i < corners.size(); ++i)
    if (edgeAt(i) >= (1 - kEqual) * longest && (first == corners.size() || place(i) < place(first)))
      first = i;
  std::rotate(corners.begin(), corners.begin() + static_cast<std::ptrdiff_t>(first), corners.end());
}

/// Sets the sharpness of the faces of a side; a sheet of as many `triangles` has them on its back,
/// too.
void setSharpness(const FlatSide& side, double sharpness, int triangles, FaceTable& faces) {
  for (const int t : side.triangles)
    for (auto face = static_cast<std::size_t>(t); face < faces.size();
         face += static_cast<std::size_t>(triangles))
      faces.sharpness[face] = sharpness;
}

/// Collects faces with their sharpness.
class FaceCollector {
 public:
  explicit FaceCollector(const FaceTable& faces) : faces_(faces) {}

  void copy(std::size_t face) {
    add(faces_.normal(face), faces_.centroid(face), faces_.area[face], faces_.sharpness[face]);
  }
  /// Adds points of a face in its place.
  void addPointsOf(std::size_t face, const std::vector<Point>& points) {
    for (const Point& point : points)
      add(faces_.normal(face), point.place, point.area, faces_.sharpness[face]);
  }
  void add(const Vector3& normal, const Vector3& place, double area, double sharpness) {
    result.add(normal, place, area);
    result.sharpness.push_back(sharpness);
  }

  FaceTable result;

 private:
  const FaceTable& faces_;
};

/// Faces of whole flat sides with the sharpness of their parts, first those of `whole`, and then
/// of a sheet those of its back.
FaceTable facesOf(const WholeSides& whole, const FaceTable& parts) {
  const SurfaceTriangles& mesh = whole.mesh;
  std::vector<double> sharpness(static_cast<std::size_t>(whole.count));
  FaceTable faces;
  faces.reserve(whole.face.size());
  const std::size_t count = whole.parts.size();
  for (std::size_t back = 0; back < parts.size(); back += count) {
    for (std::size_t t = 0; t < count; ++t)
      sharpness[static_cast<std::size_t>(whole.parts[t])] = parts.sharpness[back + t];
    for (int i = 0; i < mesh.size(); ++i) {
      const auto at = static_cast<std::size_t>(i);
      if (whole.face[at] != WholeSides::kOfFan) {
        const std::size_t face = back + static_cast<std::size_t>(whole.face[at]);
        faces.add(parts.normal(face), parts.centroid(face), parts.area[face]);
        faces.sharpness.push_back(parts.sharpness[face]);
      } else {
        const Corners c = cornersOf(mesh, i);
        faces.add((back > 0 ? -1 : 1) * mesh.normal(i), (c[0] + c[1] + c[2]) / 3, mesh.area(i));
        faces.sharpness.push_back(sharpness[static_cast<std::size_t>(whole.side[at])]);
      }
    }
  }
  return faces;
}

FaceTable facesWithPoints(const FluidBody& body) {
  FaceTable parts = body.faces;
  if (parts.sharpness.empty()) parts.sharpness = computeSharpness(body);
  AMBIENT_ASSERT(parts.sharpness.size() == parts.size());
  if (body.surface.triangles.empty()) return parts;
  const WholeSides whole(body);
  const SurfaceTriangles& mesh = whole.mesh;
  FaceTable faces = facesOf(whole, parts);
  const double size = sizeOf(body, mesh), longest = PointMaker::kLongest * size;
  const PointMaker maker(size);
  FaceCollector collector(faces);
  std::vector<bool> is_replaced(static_cast<std::size_t>(mesh.size()));
  for (const FlatSide& side : findFlatSides(mesh)) {
    const std::optional<double> common = commonSharpness(side, faces);
    if (!common) continue;
    const bool is_sharp = *common == 1;
    if (!is_sharp && !isLongStrip(side, mesh, size)) continue;
    std::vector<Vector3> corners = mesh.places(side.corners);
    if (corners.size() > 4) startAtLongestEdge(corners);
    constexpr std::size_t kDisc = 12;  // corners of a side with a round outline
    const std::vector<Point> points = maker.pointsOf(corners, !is_sharp || corners.size() >= kDisc);
    const double sharpness = is_sharp ? sharpnessOfSide(corners) : *common;
    if (is_sharp && !deservesPoints(side, points.size(), mesh, body.area, longest)) {
      if (side.has_sharp_rim) setSharpness(side, sharpness, mesh.size(), faces);
      continue;
    }
    for (const Point& point : points) {
      collector.add(side.normal, point.place, point.area, sharpness);
      if (mesh.isSheet()) collector.add(-side.normal, point.place, point.area, sharpness);
    }
    for (const int t : side.triangles) is_replaced[static_cast<std::size_t>(t)] = true;
  }
  for (std::size_t face = 0; face < faces.size(); ++face) {
    const std::size_t t = face % is_replaced.size();
    if (is_replaced[t]) continue;
    const Corners corners = cornersOf(mesh, static_cast<int>(t));
    if (isLong(corners, longest))
      collector.addPointsOf(face, maker.pointsOf({corners.begin(), corners.end()}, false));
    else
      collector.copy(face);
  }
  return std::move(collector.result);
}

}  // namespace

double sharpnessOfSide(const std::vector<Vector3>& corners) {
  constexpr double kEndless = 1.98 / 1.17 - 1;  // gain of an endless strip: C_D over the square's
  constexpr double kHalf = 40;                  // y of eq. (45) at half of that gain
  double outline = 0, twice_area = 0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vector3& next = corners[(i + 1) % corners.size()];
    outline += (next - corners[i]).norm();
    twice_area += (corners[i] - corners[0]).cross(next - corners[0]).norm();
  }
  const double length = std::max(outline * outline / (2 * twice_area) - 4, 0.0);
  return static_cast<double>(static_cast<float>(1 + kEndless * length / (length + kHalf)));
}

FaceTable formLawFaces(const FluidBody& body, const FormShape& shape) {
  FaceTable faces = facesWithPoints(body);
  for (double& sharpness : faces.sharpness)
    if (sharpness < 1) sharpness += shape.wing * (1 - sharpness);
  return faces;
}

}  // namespace ambient
