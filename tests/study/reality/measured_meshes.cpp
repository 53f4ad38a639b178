#include "tests/study/reality/measured_meshes.h"

#include <algorithm>
#include <cmath>

#include "bullet_ambient/base/elementary.h"
#include "bullet_ambient/base/pi.h"
#include "preprocess/mesh/shapes/convex_hull.h"
#include "preprocess/mesh/shapes/primitives.h"
#include "preprocess/mesh/triangle_mesh.h"

namespace ambient {
namespace {

using Profile = std::vector<std::pair<double, double>>;
using Vector = Eigen::Vector3d;

constexpr int kSegments = 64;  // round the axis
constexpr int kRings = 24;     // along the profile

/// Collects vertices and triangles.
class MeshWriter {
 public:
  int addVertex(const Vector& p) {
    vertices_.push_back(p);
    return static_cast<int>(vertices_.size()) - 1;
  }
  // Adds a triangle unless it is degenerate, as at an axis.
  void addTriangle(int a, int b, int c) {
    if (a != b && b != c && c != a) triangles_.emplace_back(a, b, c);
  }
  void addQuad(int a, int b, int c, int d) {
    addTriangle(a, b, c);
    addTriangle(a, c, d);
  }
  TriangleMesh mesh() const { return makeTriangleMesh(vertices_, triangles_); }

 private:
  std::vector<Vector> vertices_;
  std::vector<Eigen::Vector3i> triangles_;
};

/// Adds the ring of vertices of a profile point; an axis point is one vertex.
std::vector<int> addRing(MeshWriter& writer, double radius, double z) {
  if (radius <= 0) return std::vector<int>(kSegments, writer.addVertex({0, 0, z}));
  std::vector<int> ring;
  for (int i = 0; i < kSegments; ++i) {
    const double angle = 2 * kPi * i / kSegments;
    ring.push_back(
        writer.addVertex({radius * portable::cos(angle), radius * portable::sin(angle), z}));
  }
  return ring;
}

/// Half thickness of the NACA four-digit series over the thickness, closed at the tail; x from the
/// nose, over the chord.
double halfThickness(double x) {
  return 5 * (0.2969 * std::sqrt(x) - 0.126 * x - 0.3516 * x * x + 0.2843 * x * x * x -
              0.1036 * x * x * x * x);
}

}  // namespace

TriangleMesh turnedMesh(const Profile& profile) {
  MeshWriter writer;
  std::vector<int> below;
  for (const auto& [radius, z] : profile) {
    const std::vector<int> ring = addRing(writer, radius, z);
    for (int i = 0; i < kSegments && !below.empty(); ++i) {
      const int next = (i + 1) % kSegments;
      writer.addQuad(below[i], below[next], ring[next], ring[i]);
    }
    below = ring;
  }
  return writer.mesh();
}

TriangleMesh hullMesh(const std::vector<Vector>& points) {
  return makeConvexHull(Eigen::Map<const Eigen::Matrix3Xd>(
                            points.front().data(), 3, static_cast<Eigen::Index>(points.size())),
                        "hull");
}

TriangleMesh prismMesh(const Profile& section, double length) {
  std::vector<Vector> corners;
  for (const double y : {-length / 2, length / 2})
    for (const auto& [x, z] : section) corners.emplace_back(x, y, z);
  return hullMesh(corners);
}

TriangleMesh aerofoilMesh(double thickness, double length) {
  Profile section{{0.5, 0}, {-0.5, 0}};
  constexpr int kPoints = kRings / 2;
  for (int i = 1; i < kPoints; ++i) {
    const double x = (1 - portable::cos(kPi * i / kPoints)) / 2, z = thickness * halfThickness(x);
    section.insert(section.end(), {{0.5 - x, z}, {0.5 - x, -z}});
  }
  return prismMesh(section, length);
}

TriangleMesh deltaMesh(double aspect_ratio, int faces) {
  constexpr double kTip = 0.02;
  TriangleMesh mesh = makeRectangularSheetMesh(1, 1, faces);
  for (Eigen::Index i = 0; i < mesh.vertices.cols(); ++i)
    mesh.vertices(1, i) *= aspect_ratio / 2 * std::max(0.5 - mesh.vertices(0, i), kTip);
  return mesh;
}

TriangleMesh shuttlecockMesh() {
  constexpr double kCork = 0.215, kShaft = 0.2;  // radius; length of its straight part
  Profile profile;
  for (int i = 0; i < kRings; ++i)
    profile.emplace_back(0.5 + (kCork - 0.5) * i / kRings, 1.0 * i / kRings);
  for (int i = 0; i < kRings; ++i) {
    const double angle = kPi / 2 * i / kRings;
    if (i == 0) profile.emplace_back(kCork, 1);
    profile.emplace_back(kCork * portable::cos(angle), 1 + kShaft + kCork * portable::sin(angle));
  }
  profile.emplace_back(0, 1 + kShaft + kCork);
  return turnedMesh(profile);
}

TriangleMesh hemisphereMesh(bool base) {
  Profile profile;
  for (int i = 0; base && i < kRings / 2; ++i) profile.emplace_back(1.0 * i / kRings, 0);
  for (int i = 0; i < kRings; ++i) {
    const double angle = kPi / 2 * i / kRings;
    profile.emplace_back(portable::cos(angle) / 2, portable::sin(angle) / 2);
  }
  profile.emplace_back(0, 0.5);
  return turnedMesh(profile);
}

TriangleMesh halfPipeMesh(double length) {
  MeshWriter writer;
  std::vector<int> before;
  for (int i = 0; i <= kRings; ++i) {
    const double angle = kPi * i / kRings;
    std::vector<int> line;
    for (int k = 0; k <= kSegments; ++k) {
      const double y = length * (1.0 * k / kSegments - 0.5);
      line.push_back(writer.addVertex({portable::cos(angle) / 2, y, portable::sin(angle) / 2}));
    }
    for (int k = 0; k < kSegments && i > 0; ++k)
      writer.addQuad(before[k], before[k + 1], line[k + 1], line[k]);
    before = line;
  }
  return writer.mesh();
}

TriangleMesh dropMesh(double length) {
  constexpr int kPoints = 2 * kRings;
  Profile profile{{0, -length / 2}};
  for (int i = kPoints - 1; i > 0; --i) {
    const double x = (1 - portable::cos(kPi * i / kPoints)) / 2;
    profile.emplace_back(halfThickness(x), length * (0.5 - x));
  }
  profile.emplace_back(0, length / 2);
  return turnedMesh(profile);
}

}  // namespace ambient
