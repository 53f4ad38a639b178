#include "preprocess/reduced_loads/level_fit.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/force/loads/face_loads.h"
#include "bullet_ambient/spatial/large_products.h"
#include "bullet_ambient/spatial/symmetric_eigen.h"
#include "preprocess/reduced_loads/motion_sampler.h"

namespace ambient {
namespace {

constexpr std::uint64_t kSeed = 1;
constexpr int kLeastSamples = 3000;
constexpr int kSamplesPerUnknown = 15;
/// Pulls the wrenches of clusters towards those that their faces suggest, relative to the mean
/// square of the fitted functions.
constexpr double kRidge = 1e-4;
constexpr double kDensity = 2;  // pressure is the plain sum then, but for its sign

Vector6 momentOf(const FaceTable& faces, std::size_t i) {
  Vector6 moment;
  moment << faces.centroid(i).cross(faces.normal(i)), faces.normal(i);
  return moment;
}

// A share of what all faces would do if all were attached: it needs no terminator.
Eigen::Matrix<double, 6, 21> evenPart(const FaceTable& faces, double share) {
  Eigen::Matrix<double, 6, 21> even = Eigen::Matrix<double, 6, 21>::Zero();
  for (std::size_t i = 0; i < faces.size(); ++i) {
    FaceTable face;
    face.add(faces.normal(i), faces.centroid(i), faces.area[i]);
    const Eigen::Matrix<double, 3, 6> slip = computeSlipMatrix(face);
    const Matrix6 square = slip.transpose() * slip;
    Eigen::Matrix<double, 1, 21> products;
    int next = 0;
    for (int a = 0; a < 6; ++a)
      for (int b = a; b < 6; ++b) products[next++] = (a == b ? 1 : 2) * square(a, b);
    even += share * faces.area[i] * momentOf(faces, i) * products;
  }
  return even;
}

struct Cluster {
  double area = 0;
  Vector6 switching = Vector6::Zero();  // g
  Vector3 centroid = Vector3::Zero();
  Eigen::Matrix<double, 2, 6> spread;  // j_1, j_2
  double curvature = 0;                // standard deviation of the normal: 0 if flat
};

Cluster describe(const FaceTable& faces, const std::vector<std::size_t>& members) {
  Cluster cluster;
  Matrix6 square = Matrix6::Zero();
  for (const std::size_t i : members) {
    const Vector6 moment = momentOf(faces, i);
    cluster.area += faces.area[i];
    cluster.switching += faces.area[i] * moment;
    cluster.centroid += faces.area[i] * faces.centroid(i);
  }
  cluster.switching /= cluster.area;
  cluster.centroid /= cluster.area;
  for (const std::size_t i : members) {
    const Vector6 deviation = momentOf(faces, i) - cluster.switching;
    square += faces.area[i] / cluster.area * deviation * deviation.transpose();
  }
  const SymmetricEigen<6> axes = symmetricEigen<6>(square);
  for (int j = 0; j < 2; ++j)
    cluster.spread.row(j) = std::sqrt(std::max(0.0, axes.values[5 - j])) * axes.vectors.col(5 - j);
  cluster.curvature = std::sqrt(std::max(0.0, square.diagonal().tail<3>().sum()));
  return cluster;
}

// The two functions of a cluster, as level_sums_kernel.h evaluates them.
Eigen::Vector2d functionsOf(const Cluster& cluster, const Vector6& x, double cosine) {
  const double a = cluster.switching.dot(x);
  const double spread_sq = (cluster.spread * x).squaredNorm() + 1e-14;
  const Vector3 u = x.tail<3>() + x.head<3>().cross(cluster.centroid);
  const double z = std::clamp((a - cosine * u.norm()) / (2 * std::sqrt(spread_sq)), -1.0, 1.0);
  const double excess = z * (0.63661977 - 0.13661977 * z * z) - (cosine == 0 ? 0 : 0.5);
  const Vector3 n = cluster.switching.tail<3>();
  const Vector3 t = u - n.dot(u) * n;
  return excess * Eigen::Vector2d(t.squaredNorm(), cluster.curvature * (a * a + spread_sq));
}

// Square root of S over the sampled motions, eq. (36), as a quadratic form.
Matrix6 slipSquare(const FaceTable& faces) {
  const auto slip = computeSlipMatrix(faces);
  Matrix6 square = Matrix6::Zero();
  for (std::size_t i = 0; i < faces.size(); ++i) {
    const Eigen::Matrix<double, 3, 6> rows = slip.middleRows<3>(static_cast<Eigen::Index>(3 * i));
    square += faces.area[i] * rows.transpose() * rows;
  }
  return square;
}

using Wrenches = Eigen::Matrix<double, Eigen::Dynamic, 6>;

// Rows 2k and 2k + 1: h_A and h_B of cluster k if each face did what the mean of its cluster does.
Wrenches suggestedWrenches(const std::vector<Cluster>& clusters) {
  Wrenches wrenches(2 * static_cast<Eigen::Index>(clusters.size()), 6);
  for (std::size_t k = 0; k < clusters.size(); ++k) {
    const auto row = static_cast<Eigen::Index>(2 * k);
    wrenches.row(row) = clusters[k].area * clusters[k].switching.transpose();
    wrenches.row(row + 1).setZero();
  }
  return wrenches;
}

Wrenches fitWrenches(const FaceTable& faces, const LoadLevel& even,
                     const std::vector<Cluster>& clusters, double cosine) {
  fixBlocksOfLargeProducts();
  const auto unknowns = static_cast<Eigen::Index>(2 * clusters.size());
  const Eigen::Index samples = std::max<Eigen::Index>(kLeastSamples, kSamplesPerUnknown * unknowns);
  Eigen::MatrixXd functions(samples, unknowns);
  Wrenches rest(samples, 6);
  const Matrix6 slip_square = slipSquare(faces);
  const LoadSettings settings{kDensity, 0, cosine, false};
  ArbitraryNumbers numbers(kSeed);
  for (Eigen::Index s = 0; s < samples; ++s) {
    const Vector6 x = sampleMotion(numbers);
    const double weight = 1 / x.dot(slip_square * x);
    for (std::size_t k = 0; k < clusters.size(); ++k)
      functions.row(s).segment<2>(static_cast<Eigen::Index>(2 * k)) =
          weight * functionsOf(clusters[k], x, cosine);
    const Twist twist = Twist::fromVector(x);
    rest.row(s) = -weight * (computeFaceLoads(faces, 1, twist, settings).pressure.vector() -
                             computeLevelLoad(even, 1, twist, settings).vector());
  }
  const Wrenches suggested = suggestedWrenches(clusters);
  rest -= functions * suggested;
  Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(unknowns, unknowns);
  normal.selfadjointView<Eigen::Lower>().rankUpdate(functions.transpose());
  normal.diagonal().array() += kRidge * normal.diagonal().mean();
  return suggested +
         normal.selfadjointView<Eigen::Lower>().ldlt().solve(functions.transpose() * rest);
}

void setRows(float (&rows)[6][ClusterBlock::kClusters], std::size_t lane, const Vector6& values) {
  for (int row = 0; row < 6; ++row) rows[row][lane] = static_cast<float>(values[row]);
}

void store(const Cluster& cluster, const Vector6& by_slip, const Vector6& by_normal,
           std::size_t lane, ClusterBlock& block) {
  setRows(block.switching, lane, cluster.switching);
  for (int j = 0; j < 2; ++j) setRows(block.spread[j], lane, cluster.spread.row(j).transpose());
  for (int axis = 0; axis < 3; ++axis)
    block.centroid[axis][lane] = static_cast<float>(cluster.centroid[axis]);
  block.area[lane] = static_cast<float>(cluster.area);
  setRows(block.by_slip, lane, by_slip);
  setRows(block.by_normal, lane, by_normal);
}

}  // namespace

LoadLevel fitLevel(const FaceTable& faces, const FaceClusters& face_clusters,
                   double separation_angle) {
  const double cosine = separationCosine(separation_angle);
  AMBIENT_ASSERT(!face_clusters.empty() && cosine >= -1 && cosine <= 0);
  LoadLevel level;
  level.separation_angle = separation_angle;
  level.clusters = static_cast<int>(face_clusters.size());
  level.even = evenPart(faces, cosine == 0 ? 0.5 : 1);
  std::vector<Cluster> clusters;
  for (const std::vector<std::size_t>& members : face_clusters)
    clusters.push_back(describe(faces, members));
  const Wrenches wrenches = fitWrenches(faces, level, clusters, cosine);
  constexpr std::size_t kBlock = ClusterBlock::kClusters;
  level.blocks.resize((clusters.size() + kBlock - 1) / kBlock);
  for (std::size_t k = 0; k < clusters.size(); ++k) {
    const auto row = static_cast<Eigen::Index>(2 * k);
    store(clusters[k], wrenches.row(row), clusters[k].curvature * wrenches.row(row + 1), k % kBlock,
          level.blocks[k / kBlock]);
  }
  return level;
}

}  // namespace ambient
