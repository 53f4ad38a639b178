#include "bullet_ambient/fluid_body/octahedral_lattice.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace ambient {

// The nodes of one z lie on a square |x| + |y| = m, m = n - |z|: 4 m nodes, or a pole. Nodes are
// numbered from the highest z down, and on a square from the x axis on counter-clockwise about z.

int OctahedralLattice::nodesAbove(int z) const noexcept {
  const auto cap = [](int layers) { return layers > 0 ? 1 + 2 * layers * (layers - 1) : 0; };
  return z >= 0 ? cap(n_ - z) : size() - cap(n_ + z + 1);
}

int OctahedralLattice::nodeOf(int x, int y, int z) const noexcept {
  const int m = std::abs(x) + std::abs(y);
  int on_square = 0;
  if (x > 0 && y >= 0) on_square = y;
  if (x <= 0 && y > 0) on_square = m - x;
  if (x < 0 && y <= 0) on_square = 2 * m - y;
  if (x >= 0 && y < 0) on_square = 3 * m + x;
  return nodesAbove(z) + on_square;
}

Vector3 OctahedralLattice::direction(int node) const noexcept {
  int z = n_;
  while (node >= nodesAbove(z - 1)) --z;
  const int m = n_ - std::abs(z), on_square = node - nodesAbove(z);
  const int side = m > 0 ? on_square / m : 0, along = m > 0 ? on_square % m : 0;
  int x = m - along, y = along;
  for (int turn = 0; turn < side; ++turn) {
    const int before = x;
    x = -y;
    y = before;
  }
  return Vector3(x, y, z).normalized();
}

OctahedralLattice::Corners OctahedralLattice::cornersAround(
    const Vector3& direction) const noexcept {
  const Vector3 point = direction.cwiseAbs() * (n_ / direction.cwiseAbs().sum());
  const int x = std::min(static_cast<int>(point.x()), n_ - 1);
  const int y = std::min(static_cast<int>(point.y()), n_ - 1 - x);
  const double u = point.x() - x, v = point.y() - y;
  const auto node = [&](int i, int j) {
    const auto signedAs = [](int value, double sign) { return sign < 0 ? -value : value; };
    return nodeOf(signedAs(i, direction.x()), signedAs(j, direction.y()),
                  signedAs(n_ - i - j, direction.z()));
  };
  const bool is_far = u + v > 1 && x + y + 1 < n_;
  if (is_far)
    return {{node(x + 1, y + 1), node(x, y + 1), node(x + 1, y)}, {u + v - 1, 1 - u, 1 - v}};
  return {{node(x, y), node(x + 1, y), node(x, y + 1)}, {1 - u - v, u, v}};
}

}  // namespace ambient
