#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cmath>

namespace ambient::reference {

/// int_0^1 f by the tanh-sinh rule (Takahasi and Mori 1974): to rounding for smooth f, and nearly
/// so with algebraic or logarithmic singularities at the ends. f(x, 1 - x) gets both distances,
/// exact near either end.
template <typename Function>
double integrateTanhSinh(const Function& f, double step = 0.1) {
  const double half_pi = std::acos(-1.0) / 2;
  double sum = 0;
  for (int k = -static_cast<int>(3.2 / step); k * step <= 3.2; ++k) {
    const double t = k * step;
    const double s = half_pi * std::sinh(t);
    const double x = 1 / (1 + std::exp(-2 * s)), y = 1 / (1 + std::exp(2 * s));
    sum += f(x, y) * 2 * half_pi * std::cosh(t) * x * y;
  }
  return sum * step;
}

using Triangle = std::array<Eigen::Vector3d, 3>;

/// int 1/|x - y| over the triangle by Gauss' theorem: sum_e P_e int_e dl / (R + |d|) over its
/// edges. R: distance from x; d: height of x over the plane; P: distance of the edge's line from
/// the foot of x. Each edge is cut at the point nearest to x.
inline double newtonPotential(const Triangle& triangle, const Eigen::Vector3d& x,
                              double step = 0.1) {
  const Eigen::Vector3d n =
      (triangle[1] - triangle[0]).cross(triangle[2] - triangle[0]).normalized();
  const double d = std::abs((x - triangle[0]).dot(n));
  double sum = 0;
  for (int k = 0; k < 3; ++k) {
    const Eigen::Vector3d a = triangle[k] - x, edge = triangle[(k + 1) % 3] - triangle[k];
    const double length = edge.norm();
    const Eigen::Vector3d along = edge / length;
    const double P = a.dot(along.cross(n));
    if (P == 0) continue;
    const double squared_distance = P * P + d * d;
    // int_0^end dl / (R + |d|), l counted from the nearest point of the line.
    const auto halfLine = [&](double end) {
      return end * integrateTanhSinh(
                       [&](double u, double) {
                         return 1 / (std::sqrt(squared_distance + u * u * end * end) + d);
                       },
                       step);
    };
    const double begin = a.dot(along);
    sum += P * (halfLine(begin + length) - halfLine(begin));
  }
  return sum;
}

/// int f over the triangle; singularities at edges and corners are allowed, the strongest at corner
/// 0.
template <typename Function>
double integrateOverTriangle(const Triangle& triangle, const Function& f, double step = 0.1) {
  const Eigen::Vector3d ab = triangle[1] - triangle[0], bc = triangle[2] - triangle[1];
  const double twice_area = ab.cross(bc).norm();
  return twice_area * integrateTanhSinh(
                          [&](double u, double) {
                            return u *
                                   integrateTanhSinh(
                                       [&](double v, double) -> double {
                                         return f(Eigen::Vector3d(triangle[0] + u * (ab + v * bc)));
                                       },
                                       step);
                          },
                          step);
}

/// int int 1/r over two triangles that may touch.
inline double pairIntegral(const Triangle& t, const Triangle& s, double step = 0.2) {
  return integrateOverTriangle(
      t, [&](const Eigen::Vector3d& x) { return newtonPotential(s, x, step); }, step);
}

}  // namespace ambient::reference
