#include "preprocess/potential_flow/surface/face_bulges.h"

#include <algorithm>
#include <cmath>

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/base/elementary.h"
#include "preprocess/mesh/triangle_mesh.h"
#include "preprocess/potential_flow/surface/surface_refinement.h"

namespace ambient {
namespace {

using Eigen::Index;
using Eigen::Vector3d;

// The normal at a vertex is believed up to such multiples of the largest turn around it.
constexpr double kMostDisagreement = 0.5;  // between two ways to weight it
constexpr double kMostTilt = 1.6;          // from a triangle; the tip of a cone has more
constexpr double kMostUneven = 4;          // slopes at the two ends of an edge, ratio

double angleBetween(const Vector3d& a, const Vector3d& b) {
  return portable::atan2(a.cross(b).norm(), a.dot(b));
}

struct VertexNormal {
  Vector3d as_on_sphere = Vector3d::Zero();  ///< exact where the vertices lie on one (Max 1999)
  Vector3d by_area = Vector3d::Zero();
  double largest_turn = 0;  ///< between triangles that meet in an edge here [rad]
};

/// Writes the largest turns; false if an edge is sharp or the surface is not of one piece.
bool findTurns(const TriangleMesh& mesh, std::vector<VertexNormal>& normals) {
  const MeshEdges edges = computeMeshEdges(mesh);
  for (const EdgeGroup& edge : edges.edges) {
    const HalfEdge& side = edges.half_edges[edge.first];
    const Vector3d a = normalOf(mesh, side.triangle);
    const Vector3d b = normalOf(mesh, edges.half_edges[edge.last - 1].triangle);
    if (a.dot(b) <= kSharpCosine) return false;
    for (const int end : {side.low, side.high})
      normals[end].largest_turn = std::max(normals[end].largest_turn, angleBetween(a, b));
  }
  return computeMeshComponents(mesh, edges).count == 1;
}

void sumNormals(const TriangleMesh& mesh, std::vector<VertexNormal>& normals) {
  for (Index t = 0; t < mesh.triangleCount(); ++t)
    for (int k = 0; k < 3; ++k) {
      const Vector3d a = mesh.corner(t, (k + 1) % 3) - mesh.corner(t, k);
      const Vector3d b = mesh.corner(t, (k + 2) % 3) - mesh.corner(t, k);
      VertexNormal& normal = normals[mesh.triangles(k, t)];
      normal.as_on_sphere += a.cross(b) / (a.squaredNorm() * b.squaredNorm());
      normal.by_area += a.cross(b);
    }
  for (VertexNormal& normal : normals) normal.as_on_sphere.normalize();
}

bool isBelieved(const VertexNormal& normal, const Vector3d& of_face) {
  return angleBetween(normal.as_on_sphere, normal.by_area) <=
             kMostDisagreement * normal.largest_turn &&
         angleBetween(normal.as_on_sphere, of_face) <= kMostTilt * normal.largest_turn;
}

/// Sum of two slopes that a smooth surface would have alike; less where one is far smaller.
double evenSum(double p, double q) {
  if (p * q <= 0) return 0;
  const double smaller = std::min(std::abs(p), std::abs(q));
  return std::copysign(std::min(std::abs(p + q), (1 + kMostUneven) * smaller), p);
}

}  // namespace

std::vector<FaceBulge> estimateBulges(const TriangleMesh& mesh) {
  AMBIENT_ASSERT(isClosed(computeMeshEdges(mesh)));
  std::vector<VertexNormal> normals(mesh.vertexCount());
  if (!findTurns(mesh, normals)) return {};
  sumNormals(mesh, normals);
  std::vector<FaceBulge> bulges(mesh.triangleCount());
  for (Index t = 0; t < mesh.triangleCount(); ++t) {
    const Vector3d of_face = normalOf(mesh, t);
    for (int k = 0; k < 3; ++k) {
      const int next = (k + 1) % 3;
      const Vector3d along = mesh.corner(t, next) - mesh.corner(t, k);
      // Returns the slope of the tangent plane at a corner against the face, along the edge.
      const auto rise = [&](int corner) {
        const VertexNormal& normal = normals[mesh.triangles(corner, t)];
        if (!isBelieved(normal, of_face)) return 0.0;
        return -normal.as_on_sphere.dot(along) / normal.as_on_sphere.dot(of_face);
      };
      bulges[t][k] = evenSum(rise(k), -rise(next)) / 8;
    }
  }
  return bulges;
}

}  // namespace ambient
