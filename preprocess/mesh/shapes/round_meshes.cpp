#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <vector>

#include "bullet_ambient/base/elementary.h"
#include "bullet_ambient/base/pi.h"
#include "preprocess/mesh/graded_grid.h"
#include "preprocess/mesh/shapes/primitive_limits.h"
#include "preprocess/mesh/shapes/primitives.h"

namespace ambient {
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
TriangleMesh latheMesh(const char* shape, std::initializer_list<NamedSize> sizes, int faces,
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
  return latheMesh("cylinder", {{"radius", radius}, {"height", height}}, faces,
                   [&](int n) { return cylinderRings(radius, height, n); });
}

int leastCapsuleFaces(double radius, double height) {
  return static_cast<int>(triangleCount(capsuleRings(radius, height, 1)));
}

TriangleMesh makeCapsuleMesh(double radius, double height, int faces) {
  return latheMesh("capsule", {{"radius", radius}, {"height", height}}, faces,
                   [&](int n) { return capsuleRings(radius, height, n); });
}

int leastConeFaces(double radius, double height) {
  return static_cast<int>(triangleCount(coneRings(radius, height, 1)));
}

TriangleMesh makeConeMesh(double radius, double height, int faces) {
  return latheMesh("cone", {{"radius", radius}, {"height", height}}, faces,
                   [&](int n) { return coneRings(radius, height, n); });
}

TriangleMesh makeEllipticSheetMesh(double semi_axis_x, double semi_axis_y, int faces) {
  const auto disc = [](int n) {
    std::vector<Ring> rings;
    for (int k = 0; k <= n; ++k) rings.push_back({gradedRadius(1, k, n), 0, k});
    return rings;
  };
  TriangleMesh mesh = latheMesh(
      "elliptic sheet", {{"semi-axis x", semi_axis_x}, {"semi-axis y", semi_axis_y}}, faces, disc);
  mesh.vertices.row(0) *= semi_axis_x;
  mesh.vertices.row(1) *= semi_axis_y;
  return mesh;
}

}  // namespace ambient
