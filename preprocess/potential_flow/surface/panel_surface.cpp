#include "preprocess/potential_flow/surface/panel_surface.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

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

bool areSmooth(const std::vector<FaceBulge>& bulges) {
  const auto flat = std::count(bulges.begin(), bulges.end(), FaceBulge{0, 0, 0});
  return 20 * static_cast<std::size_t>(flat) < bulges.size();
}

namespace {

struct Centroids {
  Vector3d of_area = Vector3d::Zero(), of_volume = Vector3d::Zero();
  double volume = 0;
};

/// Centroids of the surface and of the space it encloses, relative to `origin`.
Centroids computeCentroids(const TriangleMesh& mesh, const Vector3d& origin) {
  Centroids sums;
  double area = 0;
  for (Index t = 0; t < mesh.triangleCount(); ++t) {
    const Vector3d a = mesh.corner(t, 0) - origin;
    const Vector3d b = mesh.corner(t, 1) - origin;
    const Vector3d c = mesh.corner(t, 2) - origin;
    const Vector3d twice_area = (b - a).cross(c - a);
    const double tetrahedron = a.dot(twice_area) / 6;
    area += twice_area.norm() / 2;
    sums.of_area += (a + b + c) * (twice_area.norm() / 6);
    sums.volume += tetrahedron;
    sums.of_volume += (a + b + c) * (tetrahedron / 4);
  }
  if (area > 0) sums.of_area /= area;
  if (sums.volume != 0) sums.of_volume /= sums.volume;
  return sums;
}

/// The reference point: summed about the area centroid, so that an origin far away costs no digits.
void placeAndScale(const TriangleMesh& mesh, bool sheet, PanelSurface& surface) {
  const Vector3d corner = mesh.corner(0, 0);
  const Vector3d near = corner + computeCentroids(mesh, corner).of_area;
  const Centroids centroids = computeCentroids(mesh, near);
  surface.centre = sheet ? near : Vector3d(near + centroids.of_volume);
  for (Index t = 0; t < mesh.triangleCount(); ++t)
    for (int k = 0; k < 3; ++k)
      surface.length = std::max(surface.length, (mesh.corner(t, k) - surface.centre).norm());
  surface.volume = sheet ? 0 : centroids.volume / portable::pow(surface.length, 3);
}

/// Boundary edges, and components of the vertices: those that touch in one vertex share their
/// constant, so triangles are joined through vertices, not edges.
void findConnectivity(const TriangleMesh& mesh, PanelSurface& surface) {
  surface.boundary_vertex.assign(mesh.vertexCount(), false);
  const MeshEdges edges = computeMeshEdges(mesh);
  DisjointSets sets(mesh.vertexCount());
  std::vector<bool> used(mesh.vertexCount(), false);
  for (const EdgeGroup& edge : edges.edges) {
    const HalfEdge& side = edges.half_edges[edge.first];
    sets.join(side.low, side.high);
    used[side.low] = used[side.high] = true;
    if (edge.size() != 1) continue;
    ++surface.boundary_edge_count;
    surface.boundary_vertex[side.low] = surface.boundary_vertex[side.high] = true;
  }
  surface.component.assign(mesh.vertexCount(), -1);
  std::vector<int> number(mesh.vertexCount(), -1);
  for (int v = 0; v < static_cast<int>(mesh.vertexCount()); ++v) {
    if (!used[v]) continue;
    int& of_root = number[sets.find(v)];
    if (of_root < 0) of_root = surface.component_count++;
    surface.component[v] = of_root;
  }
}

}  // namespace

void fillFromPanels(PanelSurface& surface) {
  surface.numbers.clear();
  surface.nodes.clear();
  for (const Panel& panel : surface.panels) {
    surface.numbers.push_back(numbersOf(panel));
    surface.nodes.push_back(nodesOf(panel));
  }
  const Index n = surface.panelCount();
  PanelArrays& a = surface.arrays;
  for (Eigen::ArrayXd* array : {&a.x, &a.y, &a.z, &a.normal_x, &a.normal_y, &a.normal_z, &a.area,
                                &a.radius, &a.xx, &a.yy, &a.zz, &a.xy, &a.xz, &a.yz})
    array->resize(n);
  for (Index t = 0; t < n; ++t) {
    const Panel& p = surface.panels[t];
    Eigen::Matrix3d moment = Eigen::Matrix3d::Zero();
    for (const Vector3d& corner : p.corner)
      moment += (corner - p.centroid) * (corner - p.centroid).transpose() / 12;
    a.x[t] = p.centroid.x(), a.y[t] = p.centroid.y(), a.z[t] = p.centroid.z();
    a.normal_x[t] = p.normal.x(), a.normal_y[t] = p.normal.y(), a.normal_z[t] = p.normal.z();
    a.area[t] = p.area, a.radius[t] = p.radius;
    a.xx[t] = moment(0, 0), a.yy[t] = moment(1, 1), a.zz[t] = moment(2, 2);
    a.xy[t] = moment(0, 1), a.xz[t] = moment(0, 2), a.yz[t] = moment(1, 2);
  }
}

PanelSurface makePanelSurface(const TriangleMesh& mesh, bool sheet) {
  PanelSurface surface;
  surface.triangles = mesh.triangles;
  placeAndScale(mesh, sheet, surface);
  surface.panels.reserve(mesh.triangleCount());
  for (Index t = 0; t < mesh.triangleCount(); ++t) {
    std::array<Vector3d, 3> p;
    for (int k = 0; k < 3; ++k) p[k] = (mesh.corner(t, k) - surface.centre) / surface.length;
    surface.panels.push_back(makePanel(p[0], p[1], p[2]));
    if (!(surface.panels.back().area > 0))
      throw std::runtime_error("potential flow: triangle " + std::to_string(t) + " has no area");
  }
  AMBIENT_ASSERT(surface.length > 0 && std::isfinite(surface.length));
  fillFromPanels(surface);
  findConnectivity(mesh, surface);
  return surface;
}

}  // namespace ambient
