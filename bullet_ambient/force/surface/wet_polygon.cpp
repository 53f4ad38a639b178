#include "bullet_ambient/force/surface/wet_polygon.h"

#include "bullet_ambient/base/ambient_assert.h"

namespace ambient {

PoolFrame::PoolFrame(const SurfacePlane& plane) noexcept : plane_(plane), axes_(plane.normal) {
  AMBIENT_ASSERT(plane.sides_F);
  for (int i = 0; i < plane.sides_F->count; ++i) {
    const PoolSides::Side& side = plane.sides_F->of[i];
    const Eigen::Vector2d out(axes_.first.dot(side.normal), axes_.second.dot(side.normal));
    const double length = out.norm();
    if (!(length > 0)) continue;
    out_[count_] = out / length;
    reach_[count_] = out_[count_].dot(seen(side.point).head<2>());
    ++count_;
  }
}

WetPolygon::WetPolygon(const PoolFrame& pool, const Vector3 (&corners_F)[3]) noexcept {
  for (int i = 0; i < 3; ++i) corners_[i] = pool.seen(corners_F[i]);
  cut([](const Vector3& at) { return at.z(); });
  for (int side = 0; side < pool.sides(); ++side)
    cut([&](const Vector3& at) { return pool.inside(side, at); });
}

// Keeps what is not outside of a line (Sutherland and Hodgman 1974).
template <class Inside>
void WetPolygon::cut(const Inside& inside) noexcept {
  if (count_ == 0) return;
  const int before = count_;
  Vector3 old[kMost];
  double depth[kMost];
  bool is_cut = false;
  for (int i = 0; i < before; ++i) {
    old[i] = corners_[i];
    depth[i] = inside(old[i]);
    is_cut = is_cut || !(depth[i] > 0);
  }
  if (!is_cut) return;
  count_ = 0;
  for (int i = 0; i < before; ++i) {
    const int next = i + 1 < before ? i + 1 : 0;
    const double here = depth[i], there = depth[next];
    if (here > 0) corners_[count_++] = old[i];
    if ((here > 0) == (there > 0)) continue;
    AMBIENT_ASSERT(count_ < kMost);
    corners_[count_++] = old[i] + here / (here - there) * (old[next] - old[i]);
  }
}

namespace {

template <class Visit>
void forEachWetTriangle(const HullBlocks& hull, const PoolFrame& pool, const Visit& visit) {
  for (int image = 0; image < hull.symmetry.images(); ++image)
    for (std::size_t block = 0; block < hull.count; ++block)
      for (int lane = 0; lane < HullBlock::kTriangles; ++lane) {
        const auto& from = hull.blocks[block].corner;
        Vector3 corners[3];
        for (int k = 0; k < 3; ++k)
          corners[k] = hull.symmetry.imageOf(
              Vector3(from[k][0][lane], from[k][1][lane], from[k][2][lane]), image);
        WetPolygon(pool, corners).forEachTriangle(visit);
      }
}

// Returns twelve times the mean of a product of two linear functions over a triangle, given at its
// corners.
double meanOfProduct(const Vector3& p, const Vector3& q) { return p.sum() * q.sum() + p.dot(q); }

}  // namespace

HullSums sumBetweenSides(const HullBlocks& hull, const SurfacePlane& plane_F) noexcept {
  HullSums sums{};
  const PoolFrame pool(plane_F);
  forEachWetTriangle(hull, pool, [&](const Vector3& a, const Vector3& b, const Vector3& c) {
    const Vector3 x(a.x(), b.x(), c.x()), y(a.y(), b.y(), c.y()), depth(a.z(), b.z(), c.z());
    const Vector3 ab = b - a, ac = c - a;
    const double flux = -(ab.x() * ac.y() - ab.y() * ac.x()) / 2;  // -s.n A
    sums.volume += flux / 3 * depth.sum();
    sums.depth += flux / 24 * meanOfProduct(depth, depth);
    sums.moment[0] += flux / 12 * meanOfProduct(depth, x);
    sums.moment[1] += flux / 12 * meanOfProduct(depth, y);
    sums.area += flux;
    sums.first[0] += flux / 3 * x.sum();
    sums.first[1] += flux / 3 * y.sum();
    sums.second[0] += flux / 12 * meanOfProduct(x, x);
    sums.second[1] += flux / 12 * meanOfProduct(x, y);
    sums.second[2] += flux / 12 * meanOfProduct(y, y);
  });
  return sums;
}

Wrench sumOverSides(const HullBlocks& hull, const SurfacePlane& plane_F) noexcept {
  const PoolFrame pool(plane_F);
  const double height = plane_F.height;
  Vector3 force(0, 0, 0), torque(0, 0, 0);  // along e_1, e_2, s
  forEachWetTriangle(hull, pool, [&](const Vector3& a, const Vector3& b, const Vector3& c) {
    const auto place = [&](const Vector3& p) { return Vector3(p.x(), p.y(), height - p.z()); };
    const Vector3 x(a.x(), b.x(), c.x()), y(a.y(), b.y(), c.y()), depth(a.z(), b.z(), c.z());
    const Vector3 up = Vector3::Constant(height) - depth;
    Vector3 area = (place(b) - place(a)).cross(place(c) - place(a)) / 2;  // A n, horizontal
    area.z() = 0;
    force -= depth.sum() / 3 * area;
    const Vector3 arm =
        Vector3(meanOfProduct(depth, x), meanOfProduct(depth, y), meanOfProduct(depth, up)) / 12;
    torque -= arm.cross(area);
  });
  const auto inF = [&](const Vector3& v) -> Vector3 {
    return v.x() * pool.axes().first + v.y() * pool.axes().second + v.z() * plane_F.normal;
  };
  return {inF(torque), inF(force)};
}

}  // namespace ambient
