#include "preprocess/mesh/shapes/primitives.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <map>
#include <utility>
#include <vector>

#include "bullet_ambient/base/elementary.h"
#include "bullet_ambient/base/pi.h"
#include "preprocess/mesh/input_error.h"
#include "preprocess/mesh/triangle_mesh.h"

namespace ambient {

namespace {
constexpr int kMostFaces = 1000000;
}

void requirePositiveSize(const std::string& shape, const std::string& what, double value) {
  if (std::isfinite(value) && value > 0) return;
  raiseInputError(shape, what, " = ", value, " m is not positive and finite");
}

void requireFaces(const std::string& shape, int faces, int least) {
  if (faces < least)
    raiseInputError(shape, "faces = ", faces, " is below the least possible number ", least);
  if (faces > kMostFaces)
    raiseInputError(shape, "faces = ", faces, " is above the largest number ", kMostFaces);
}

namespace {

// Even numbers of divisions, proportional to the root of the length (the cell at the end of a
// cosine-graded edge has length L (pi / 2n)^2), the longest edge with `longest` divisions.
int divisions(double length, double longest_length, int longest) {
  const double wanted = longest * std::sqrt(length / longest_length);
  return std::max(2, 2 * static_cast<int>(std::lround(wanted / 2)));
}

std::array<int, 3> boxDivisions(const Eigen::Vector3d& half_sizes, int faces) {
  std::array<int, 3> best{1, 1, 1};
  for (int longest = 2;; longest += 2) {
    std::array<int, 3> n{};
    for (int k = 0; k < 3; ++k) n[k] = divisions(half_sizes[k], half_sizes.maxCoeff(), longest);
    const long long needed = 4LL * (1LL * n[0] * n[1] + 1LL * n[1] * n[2] + 1LL * n[2] * n[0]);
    if (needed > faces) return best;
    best = n;
  }
}

/// Vertices of the box surface, each lattice point once.
class BoxLattice {
 public:
  BoxLattice(const Eigen::Vector3d& half_sizes, const std::array<int, 3>& n) {
    for (int k = 0; k < 3; ++k) coordinates_[k] = cosineSpacing(half_sizes[k], n[k]);
  }

  int point(const std::array<int, 3>& index) {
    const auto [entry, is_new] = indices_.emplace(index, static_cast<int>(points_.size()));
    if (is_new) {
      points_.push_back(
          {coordinates_[0][index[0]], coordinates_[1][index[1]], coordinates_[2][index[2]]});
    }
    return entry->second;
  }

  const std::vector<Eigen::Vector3d>& points() const { return points_; }

 private:
  std::array<std::vector<double>, 3> coordinates_;
  std::map<std::array<int, 3>, int> indices_;
  std::vector<Eigen::Vector3d> points_;
};

}  // namespace

TriangleMesh makeBoxMesh(const Eigen::Vector3d& half_sizes, int faces) {
  for (int k = 0; k < 3; ++k) requirePositiveSize("box", "half size", half_sizes[k]);
  requireFaces("box", faces, 12);
  return makeBoxMesh(half_sizes, boxDivisions(half_sizes, faces));
}

TriangleMesh makeBoxMesh(const Eigen::Vector3d& half_sizes, const std::array<int, 3>& n) {
  BoxLattice lattice(half_sizes, n);
  std::vector<Eigen::Vector3i> triangles;
  for (int axis = 0; axis < 3; ++axis) {
    for (const bool upper : {false, true}) {
      // Seen from outside, columns run along u and rows along v, u x v being the outward normal.
      const int u = (axis + (upper ? 1 : 2)) % 3, v = (axis + (upper ? 2 : 1)) % 3;
      appendGridTriangles(
          n[v], n[u],
          [&](int row, int column) {
            std::array<int, 3> index{};
            index[axis] = upper ? n[axis] : 0;
            index[u] = column;
            index[v] = row;
            return lattice.point(index);
          },
          triangles);
    }
  }
  return makeTriangleMesh(lattice.points(), triangles);
}

TriangleMesh makeRectangularSheetMesh(double size_x, double size_y, int faces) {
  requirePositiveSize("rectangular sheet", "size x", size_x);
  requirePositiveSize("rectangular sheet", "size y", size_y);
  requireFaces("rectangular sheet", faces, 8);
  const double longest_size = std::max(size_x, size_y);
  int nx = 2, ny = 2;
  for (int longest = 4;; longest += 2) {
    const int next_x = divisions(size_x, longest_size, longest);
    const int next_y = divisions(size_y, longest_size, longest);
    if (2LL * next_x * next_y > faces) break;
    nx = next_x;
    ny = next_y;
  }
  std::vector<Eigen::Vector3d> vertices;
  for (const double y : cosineSpacing(size_y / 2, ny)) {
    for (const double x : cosineSpacing(size_x / 2, nx)) vertices.push_back({x, y, 0});
  }
  std::vector<Eigen::Vector3i> triangles;
  appendGridTriangles(
      ny, nx, [nx](int row, int column) { return row * (nx + 1) + column; }, triangles);
  return makeTriangleMesh(vertices, triangles);
}

namespace {

struct Icosahedron {
  std::array<Eigen::Vector3d, 12> corners;
  std::array<std::array<int, 3>, 20> faces;
};

// The orientation with mirror planes x = 0, y = 0 and z = 0: corners (0, +-1, +-phi) and cyclic.
Icosahedron makeIcosahedron() {
  const double phi = (1 + std::sqrt(5.0)) / 2;
  Icosahedron shape;
  int count = 0;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double a : {-1.0, 1.0}) {
      for (const double b : {-phi, phi}) {
        Eigen::Vector3d corner = Eigen::Vector3d::Zero();
        corner[(axis + 1) % 3] = a;
        corner[(axis + 2) % 3] = b;
        shape.corners[count++] = corner;
      }
    }
  }
  int face = 0;
  const auto adjacent = [&shape](int i, int j) {  // edge length 2, the next distance is 2 phi
    return (shape.corners[i] - shape.corners[j]).squaredNorm() < 5;
  };
  for (int i = 0; i < 12; ++i) {
    for (int j = i + 1; j < 12; ++j) {
      for (int k = j + 1; k < 12; ++k) {
        if (!adjacent(i, j) || !adjacent(j, k) || !adjacent(i, k)) continue;
        const Eigen::Vector3d normal =
            (shape.corners[j] - shape.corners[i]).cross(shape.corners[k] - shape.corners[i]);
        const bool outward = normal.dot(shape.corners[i]) > 0;
        shape.faces[face++] = outward ? std::array{i, j, k} : std::array{i, k, j};
      }
    }
  }
  return shape;
}

/// The points i A + j B + k C, i + j + k = n, of all faces, shared along edges and at corners.
class GeodesicLattice {
 public:
  explicit GeodesicLattice(int frequency) : frequency_(frequency) {}

  int point(const std::array<int, 3>& face, int j, int k) {
    // Weights by corner, in the order of the corners: the same key from every face that shares it.
    std::map<int, int> weights;
    const std::array<int, 3> lattice{frequency_ - j - k, j, k};
    for (int c = 0; c < 3; ++c) {
      if (lattice[c] > 0) weights[face[c]] = lattice[c];
    }
    const auto [entry, is_new] = indices_.emplace(weights, static_cast<int>(points_.size()));
    if (is_new) points_.push_back(position(weights));
    return entry->second;
  }

  const std::vector<Eigen::Vector3d>& points() const { return points_; }
  const Icosahedron& icosahedron() const { return icosahedron_; }

 private:
  Eigen::Vector3d position(const std::map<int, int>& weights) const {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (const auto& [corner, weight] : weights) sum += weight * icosahedron_.corners[corner];
    return sum.normalized();
  }

  int frequency_;
  Icosahedron icosahedron_ = makeIcosahedron();
  std::map<std::map<int, int>, int> indices_;
  std::vector<Eigen::Vector3d> points_;
};

}  // namespace

TriangleMesh makeEllipsoidMesh(const Eigen::Vector3d& semi_axes, int faces) {
  for (int k = 0; k < 3; ++k) requirePositiveSize("ellipsoid", "semi-axis", semi_axes[k]);
  requireFaces("ellipsoid", faces, 20);
  int n = static_cast<int>(std::sqrt(faces / 20.0));
  while (20LL * (n + 1) * (n + 1) <= faces) ++n;

  GeodesicLattice lattice(n);
  TriangleMesh mesh;
  mesh.triangles.resize(3, 20 * n * n);
  Eigen::Index t = 0;
  for (const std::array<int, 3>& face : lattice.icosahedron().faces) {
    const auto at = [&](int j, int k) { return lattice.point(face, j, k); };
    for (int j = 0; j < n; ++j) {
      for (int k = 0; j + k < n; ++k) {
        mesh.triangles.col(t++) << at(j, k), at(j + 1, k), at(j, k + 1);
        if (j + k + 1 < n) mesh.triangles.col(t++) << at(j + 1, k), at(j + 1, k + 1), at(j, k + 1);
      }
    }
  }
  mesh.vertices.resize(3, static_cast<Eigen::Index>(lattice.points().size()));
  for (Eigen::Index v = 0; v < mesh.vertexCount(); ++v) {
    mesh.vertices.col(v) = semi_axes.cwiseProduct(lattice.points()[v]);
  }
  return mesh;
}

namespace {

constexpr int kSectors = 8;  // gives every ring the mirror planes x = 0, y = 0 and x = y

/// A circle of 8 m vertices about the z axis; m = 0 is a single point on it.
struct Ring {
  double radius = 0;
  double z = 0;
  int m = 0;
};

/// Surface through a list of rings from top to bottom; neighbours differ in m by at most one, or
/// one of them is a pole. Rings of equal m are joined by plane trapezoids: staggered vertices would
/// tilt the faces of short rows, whatever their number (Schwarz's lantern).
class Lathe {
 public:
  explicit Lathe(const std::vector<Ring>& rings) {
    for (const Ring& ring : rings) {
      first_.push_back(static_cast<int>(vertices_.size()));
      appendVertices(ring);
    }
    for (std::size_t i = 0; i + 1 < rings.size(); ++i) {
      for (int sector = 0; sector < kSectors; ++sector) {
        const Row upper{first_[i], rings[i].m, sector},
            lower{first_[i + 1], rings[i + 1].m, sector};
        joinRows(upper, lower, static_cast<int>(i));
      }
    }
  }

  TriangleMesh mesh() const { return makeTriangleMesh(vertices_, triangles_); }

 private:
  /// The part of a ring in one sector: vertices 0 to m.
  struct Row {
    int first, m, sector;
    int operator[](int j) const {
      return m == 0 ? first : first + (sector * m + j) % (kSectors * m);
    }
  };

  void appendVertices(const Ring& ring) {
    if (ring.m == 0) vertices_.push_back({0, 0, ring.z});
    for (int j = 0; j < kSectors * ring.m; ++j) {
      const double angle = 2 * kPi * j / (kSectors * ring.m);
      vertices_.push_back(
          {ring.radius * portable::cos(angle), ring.radius * portable::sin(angle), ring.z});
    }
  }

  void joinRows(const Row& upper, const Row& lower, int row) {
    const int columns = std::min(upper.m, lower.m);
    for (int j = 0; j < columns; ++j) {
      // Alternating diagonals are symmetric; rings of different m leave no choice.
      const bool falling =
          upper.m < lower.m || (upper.m == lower.m && (row + upper.sector * upper.m + j) % 2 == 0);
      if (falling) {
        triangles_.push_back({upper[j], lower[j], lower[j + 1]});
        triangles_.push_back({upper[j], lower[j + 1], upper[j + 1]});
      } else {
        triangles_.push_back({upper[j], lower[j], upper[j + 1]});
        triangles_.push_back({lower[j], lower[j + 1], upper[j + 1]});
      }
    }
    // One triangle per sector where m grows by one, a fan at a pole.
    for (int j = columns; j < lower.m; ++j) {
      triangles_.push_back({upper[columns], lower[j], lower[j + 1]});
    }
    for (int j = columns; j < upper.m; ++j) {
      triangles_.push_back({upper[j], lower[columns], upper[j + 1]});
    }
  }

  std::vector<int> first_;
  std::vector<Eigen::Vector3d> vertices_;
  std::vector<Eigen::Vector3i> triangles_;
};

// Number of triangles of a list of rings: 8 (m + m') per pair of neighbours.
long long triangleCount(const std::vector<Ring>& rings) {
  long long count = 0;
  for (std::size_t i = 0; i + 1 < rings.size(); ++i)
    count += kSectors * (rings[i].m + rings[i + 1].m);
  return count;
}

// The finest list of rings that stays within `faces`; make(n) has n rings from axis to rim.
template <class MakeRings>
std::vector<Ring> finestRings(int faces, MakeRings make) {
  std::vector<Ring> best = make(1);
  for (int n = 2;; ++n) {
    std::vector<Ring> next = make(n);
    if (triangleCount(next) > faces) return best;
    best = std::move(next);
  }
}

// Radius of ring k of n, graded towards the rim k = n.
double gradedRadius(double radius, int k, int n) {
  return k == n ? radius : radius * portable::sin(kPi * k / (2 * n));
}

// Rows on the side per ring of the base, at equal cell size on both sides of the rim; limited on
// very slender bodies, which would otherwise leave no triangles for the circumference.
double rowsPerRing(double length, double radius) {
  constexpr double kMost = 18;
  return std::min(std::sqrt(length / radius), kMost);
}

int evenNumber(double wanted) { return std::max(2, 2 * static_cast<int>(std::lround(wanted / 2))); }

// Both ends alike: the rings of the upper half are mirrored at z = 0.
std::vector<Ring> mirrored(const std::vector<Ring>& upper_half) {
  std::vector<Ring> rings = upper_half;
  for (std::size_t i = upper_half.size() - 1; i-- > 0;) {
    rings.push_back({upper_half[i].radius, -upper_half[i].z, upper_half[i].m});
  }
  return rings;
}

std::vector<Ring> cylinderRings(double radius, double height, int n) {
  std::vector<Ring> rings;
  for (int k = 0; k <= n; ++k) rings.push_back({gradedRadius(radius, k, n), height / 2, k});
  // The cells on both sides of the rim are equally short: R (pi / 2n)^2 / 2 and H (pi / 2 rows)^2.
  const int rows = evenNumber(n * rowsPerRing(2 * height, radius));
  const std::vector<double> z = cosineSpacing(height / 2, rows);
  for (int i = rows - 1; 2 * i >= rows; --i) rings.push_back({radius, z[i], n});
  return mirrored(rings);
}

std::vector<Ring> capsuleRings(double radius, double height, int n) {
  std::vector<Ring> rings;
  for (int k = 0; k <= n; ++k) {
    const double angle = kPi * k / (2 * n);
    rings.push_back(
        {gradedRadius(radius, k, n), height / 2 + (k == n ? 0 : radius * portable::cos(angle)), k});
  }
  // Rows as high as those of the caps; longer ones on slender capsules, where the flow varies less.
  const double slenderness = height / radius;
  const int rows = evenNumber(n * std::min(2 * slenderness / kPi, rowsPerRing(height, radius)));
  for (int i = 1; 2 * i <= rows; ++i) rings.push_back({radius, height / 2 - height * i / rows, n});
  return mirrored(rings);
}

std::vector<Ring> coneRings(double radius, double height, int n) {
  const double slant = portable::hypot(radius, height);
  const int rows = std::max(n, static_cast<int>(std::lround(n * rowsPerRing(slant, radius))));
  std::vector<Ring> rings{{0, height / 2, 0}};
  for (int k = 1; k <= rows; ++k) {
    const double fraction = gradedRadius(1, k, rows);
    // At least half the full number of sides everywhere: rings that begin with 8 vertices would cut
    // the volume by log(n)/n^2.
    const int m = std::min(n, (n + 1) / 2 + k - 1);
    rings.push_back({radius * fraction, height * (0.5 - fraction), m});
  }
  for (int k = n - 1; k >= 0; --k) rings.push_back({gradedRadius(radius, k, n), -height / 2, k});
  return rings;
}

/// A size of a round shape, by its name in messages [m].
struct NamedSize {
  const char* name;
  double size;
};

/// The finest mesh of a shape through the rings make(n) within `faces` triangles.
template <class MakeRings>
TriangleMesh revolvedMesh(const char* shape, std::initializer_list<NamedSize> sizes, int faces,
                          const MakeRings& make) {
  for (const NamedSize& named : sizes) requirePositiveSize(shape, named.name, named.size);
  requireFaces(shape, faces, static_cast<int>(triangleCount(make(1))));
  return Lathe(finestRings(faces, make)).mesh();
}

}  // namespace

int leastCylinderFaces(double radius, double height) {
  return static_cast<int>(triangleCount(cylinderRings(radius, height, 1)));
}

TriangleMesh makeCylinderMesh(double radius, double height, int faces) {
  return revolvedMesh("cylinder", {{"radius", radius}, {"height", height}}, faces,
                      [&](int n) { return cylinderRings(radius, height, n); });
}

int leastCapsuleFaces(double radius, double height) {
  return static_cast<int>(triangleCount(capsuleRings(radius, height, 1)));
}

TriangleMesh makeCapsuleMesh(double radius, double height, int faces) {
  return revolvedMesh("capsule", {{"radius", radius}, {"height", height}}, faces,
                      [&](int n) { return capsuleRings(radius, height, n); });
}

int leastConeFaces(double radius, double height) {
  return static_cast<int>(triangleCount(coneRings(radius, height, 1)));
}

TriangleMesh makeConeMesh(double radius, double height, int faces) {
  return revolvedMesh("cone", {{"radius", radius}, {"height", height}}, faces,
                      [&](int n) { return coneRings(radius, height, n); });
}

TriangleMesh makeEllipticSheetMesh(double semi_axis_x, double semi_axis_y, int faces) {
  const auto disc = [](int n) {
    std::vector<Ring> rings;
    for (int k = 0; k <= n; ++k) rings.push_back({gradedRadius(1, k, n), 0, k});
    return rings;
  };
  TriangleMesh mesh = revolvedMesh(
      "elliptic sheet", {{"semi-axis x", semi_axis_x}, {"semi-axis y", semi_axis_y}}, faces, disc);
  mesh.vertices.row(0) *= semi_axis_x;
  mesh.vertices.row(1) *= semi_axis_y;
  return mesh;
}

}  // namespace ambient
