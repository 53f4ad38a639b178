#include "preprocess/mesh/editable_mesh.h"

#include <algorithm>
#include <queue>
#include <vector>

#include "bullet_ambient/base/ambient_assert.h"
#include "preprocess/mesh/triangle_mesh.h"

namespace ambient {

EditableMesh::EditableMesh(const TriangleMesh& mesh)
    : vertices(mesh.vertices), triangles(columnsOf(mesh.triangles)), around(mesh.vertexCount()) {
  for (std::size_t t = 0; t < triangles.size(); ++t)
    for (const int v : triangles[t]) around[v].push_back(static_cast<int>(t));
}

double EditableMesh::shapeOf(const Corners& t) const {
  double longest = 0;  // squared
  for (int k = 0; k < 3; ++k)
    longest = std::max(longest, (point(t[(k + 1) % 3]) - point(t[k])).squaredNorm());
  return longest > 0 ? crossOf(t).norm() / longest : 0;
}

std::vector<int> EditableMesh::trianglesAt(int a, int b) const {
  const bool fewer_at_b = around[b].size() < around[a].size();
  std::vector<int> result;
  result.reserve(2);
  for (const int t : around[fewer_at_b ? b : a])
    if (holds(triangles[t], fewer_at_b ? a : b)) result.push_back(t);
  return result;
}

std::vector<int> EditableMesh::neighboursOf(int v) const {
  std::vector<int> result;
  result.reserve(2 * around[v].size());
  for (const int t : around[v])
    for (const int corner : triangles[t])
      if (corner != v) result.push_back(corner);
  std::sort(result.begin(), result.end());
  result.erase(std::unique(result.begin(), result.end()), result.end());
  return result;
}

std::size_t EditableMesh::commonNeighbours(int a, int b) const {
  const std::vector<int> of_a = neighboursOf(a), of_b = neighboursOf(b);
  return static_cast<std::size_t>(std::count_if(of_a.begin(), of_a.end(), [&](int v) {
    return std::binary_search(of_b.begin(), of_b.end(), v);
  }));
}

int EditableMesh::contract(int v, int target) {
  int removed = 0;
  for (const int t : around[v]) {
    Corners& corners = triangles[t];
    if (holds(corners, target)) {
      for (const int corner : corners) {
        std::vector<int>& list = around[corner];
        if (corner != v) list.erase(std::find(list.begin(), list.end(), t));
      }
      corners.setConstant(-1);
      ++removed;
      continue;
    }
    std::replace(corners.data(), corners.data() + 3, v, target);
    around[target].push_back(t);
  }
  around[v].clear();
  return removed;
}

std::vector<EditableMesh::Corners> EditableMesh::trianglesLeft() const {
  std::vector<Corners> left;
  for (const Corners& t : triangles)
    if (t[0] >= 0) left.push_back(t);
  return left;
}

namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// Sum over planes of area times squared distance: x^T A x - 2 b x + c, about a point near by.
struct Quadric {
  Matrix3d A = Matrix3d::Zero();
  Vector3d b = Vector3d::Zero();
  double c = 0, area = 0;

  void add(const Quadric& other) {
    A += other.A;
    b += other.b;
    c += other.c;
    area += other.area;
  }
  double at(const Vector3d& x) const { return std::max(0.0, x.dot(A * x) - 2 * b.dot(x) + c); }
};

struct Contraction {
  double cost = 0;
  int kept = 0, removed = 0;
  int age = 0;  // of both vertices when it was found
  double error = 0;
  Vector3d place = Vector3d::Zero();

  bool operator<(const Contraction& other) const {  // the cheapest on top of the queue
    if (cost != other.cost) return cost > other.cost;
    return kept != other.kept ? kept > other.kept : removed > other.removed;
  }
};

class MeshCoarsener {
 public:
  explicit MeshCoarsener(const TriangleMesh& mesh)
      : middle_(mesh.bounds().center()),
        mesh_(mesh),
        quadrics_(mesh.vertexCount()),
        ages_(mesh.vertexCount(), 0),
        faces_(mesh.triangleCount()) {
    mesh_.vertices.colwise() -= middle_;
    for (const EditableMesh::Corners& t : mesh_.triangles) addPlane(t);
    for (int v = 0; v < static_cast<int>(mesh.vertexCount()); ++v) {
      for (const int other : mesh_.neighboursOf(v))
        if (v < other) queue_.push(contractionOf(v, other));
    }
  }

  TriangleMesh coarsenTo(const CoarseningSettings& settings) {
    const double most_error = settings.tolerance * settings.tolerance;
    while (faces_ > settings.least_faces && !queue_.empty()) {
      const Contraction next = queue_.top();
      queue_.pop();
      if (next.age != ages_[next.kept] + ages_[next.removed]) continue;
      if (mesh_.around[next.kept].empty() || mesh_.around[next.removed].empty()) continue;
      if (next.error > most_error && faces_ <= settings.most_faces) continue;
      if (isAllowed(next)) contract(next);
    }
    TriangleMesh result = withUsedVertices(mesh_.vertices, mesh_.trianglesLeft());
    result.vertices.colwise() += middle_;
    return result;
  }

 private:
  void addPlane(const EditableMesh::Corners& t) {
    const Vector3d cross = mesh_.crossOf(t);
    const double area = cross.norm() / 2;
    const Vector3d normal = cross.stableNormalized();
    const double offset = normal.dot(mesh_.point(t[0]));
    const Quadric plane{area * normal * normal.transpose(), area * offset * normal,
                        area * offset * offset, area};
    for (const int v : t) quadrics_[v].add(plane);
  }

  /// To the point of least error; where planes do not determine it, the middle. Among equals, short
  /// edges go first.
  Contraction contractionOf(int v, int w) const {
    constexpr double kUndetermined = 1e-3, kLength = 1e-4;
    Quadric sum = quadrics_[v];
    sum.add(quadrics_[w]);
    const Vector3d middle = (mesh_.point(v) + mesh_.point(w)) / 2;
    const double length = (mesh_.point(v) - mesh_.point(w)).norm();
    const double weight = kUndetermined * sum.area;
    Contraction found;
    found.kept = v;
    found.removed = w;
    found.age = ages_[v] + ages_[w];
    const Matrix3d A = sum.A + weight * Matrix3d::Identity();
    found.place = A.inverse() * (sum.b + weight * middle);
    if (!found.place.allFinite() || (found.place - middle).norm() > length) found.place = middle;
    const double error = sum.at(found.place);
    found.error = sum.area > 0 ? error / sum.area : 0;
    found.cost = error + kLength * sum.area * length * length;
    return found;
  }

  bool isAllowed(const Contraction& c) {
    return mesh_.commonNeighbours(c.kept, c.removed) == 2 &&
           mesh_.neighboursOf(c.kept).size() + mesh_.neighboursOf(c.removed).size() >= 8 &&
           staysInShape(c, c.kept, c.removed) && staysInShape(c, c.removed, c.kept);
  }

  /// Whether the triangles at `v` but not at `other` neither turn nor become slivers. Slivers may
  /// become a little worse: else fans around a pole could not be contracted.
  bool staysInShape(const Contraction& c, int v, int other) {
    constexpr double kLeastCosine = 0.3, kLeastHeightOfTriangle = 0.05, kLeastOfSliver = 0.9;
    const Vector3d own_place = mesh_.point(v);
    for (const int t : mesh_.around[v]) {
      const EditableMesh::Corners& own = mesh_.triangles[t];
      if (holds(own, other)) continue;
      const Vector3d before = mesh_.crossOf(own);
      const double shape_before = mesh_.shapeOf(own);
      mesh_.vertices.col(v) = c.place;
      const Vector3d after = mesh_.crossOf(own);
      const double shape = mesh_.shapeOf(own);
      mesh_.vertices.col(v) = own_place;
      if (before.dot(after) < kLeastCosine * before.norm() * after.norm()) return false;
      if (shape < std::min(kLeastHeightOfTriangle, kLeastOfSliver * shape_before)) return false;
    }
    return true;
  }

  void contract(const Contraction& c) {
    mesh_.vertices.col(c.kept) = c.place;
    quadrics_[c.kept].add(quadrics_[c.removed]);
    faces_ -= mesh_.contract(c.removed, c.kept);
    ++ages_[c.kept];
    for (const int v : mesh_.neighboursOf(c.kept))
      queue_.push(contractionOf(std::min(v, c.kept), std::max(v, c.kept)));
  }

  Vector3d middle_;
  EditableMesh mesh_;  // about the middle
  std::vector<Quadric> quadrics_;
  std::vector<int> ages_;
  Eigen::Index faces_;
  std::priority_queue<Contraction> queue_;
};

}  // namespace

TriangleMesh coarsened(const TriangleMesh& mesh, const CoarseningSettings& settings) {
  AMBIENT_ASSERT(isClosed(computeMeshEdges(mesh)));
  return MeshCoarsener(mesh).coarsenTo(settings);
}

}  // namespace ambient
