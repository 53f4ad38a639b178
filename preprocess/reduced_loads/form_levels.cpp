#include "preprocess/reduced_loads/form_levels.h"

#include <algorithm>
#include <cmath>

#include "bullet_ambient/fluid_body/sharpness.h"
#include "bullet_ambient/force/face_loads.h"
#include "preprocess/reduced_loads/centred_faces.h"
#include "preprocess/reduced_loads/face_clusters.h"
#include "preprocess/reduced_loads/motion_sampler.h"

namespace ambient {
namespace {

constexpr std::uint64_t kFormMotionSeed = 3;
constexpr int kFormSamples = 1000;

/// The mean normal, place and sharpness of each cluster, and the area of all its faces.
FaceTable joined(const FaceTable& faces, const FaceClusters& clusters) {
  FaceTable result;
  for (const std::vector<std::size_t>& cluster : clusters) {
    Vector3 normal = Vector3::Zero(), moment = Vector3::Zero();
    double area = 0, sharpness = 0;
    for (const std::size_t i : cluster) {
      area += faces.area[i];
      normal += faces.area[i] * faces.normal(i);
      moment += faces.area[i] * faces.centroid(i);
      sharpness += faces.area[i] * faces.sharpness[i];
    }
    result.add(normal.norm() > 0 ? Vector3(normal.normalized()) : faces.normal(cluster[0]),
               moment / area, area);
    result.sharpness.push_back(static_cast<double>(static_cast<float>(sharpness / area)));
  }
  return result;
}

/// Of the pressure in one motion, relative to 1/2 rho sum A_i |u_i|^2.
double errorIn(const Vector6& x, const FaceTable& level, const FaceTable& faces) {
  const LoadSettings settings{1, 0, 0, false, PressureLaw::kForm};
  const Twist twist = Twist::fromVector(x);
  double scale = 0;
  for (std::size_t i = 0; i < faces.size(); ++i)
    scale += 0.5 * faces.area[i] * twist.at(faces.centroid(i)).squaredNorm();
  const Wrench difference = computeFaceLoads(level, 1, twist, settings).pressure +
                            -1.0 * computeFaceLoads(faces, 1, twist, settings).pressure;
  return difference.vector().norm() / scale;
}

double p99Error(const FaceTable& level, const FaceTable& faces) {
  ArbitraryNumbers numbers(kFormMotionSeed);
  std::vector<double> errors(kFormSamples);
  for (double& error : errors) error = errorIn(sampleMotion(numbers), level, faces);
  const auto at = errors.begin() + kFormSamples * 99 / 100;
  std::nth_element(errors.begin(), at, errors.end());
  return *at;
}

}  // namespace

std::vector<FormLevel> buildFormLevels(const FluidBody& body, const std::vector<int>& clusters) {
  std::vector<FormLevel> levels;
  if (clusters.empty()) return levels;
  const CentredFaces centred(body, formLawFaces(body));
  for (const int count : clusters) {
    if (static_cast<std::size_t>(count) >= centred.faces.size()) continue;
    FormLevel level;
    level.faces = joined(centred.faces, clusterFaces(centred.faces, count));
    level.p99_error = p99Error(level.faces, centred.faces);
    centred.moveBack(level.faces);
    levels.push_back(std::move(level));
  }
  return levels;
}

}  // namespace ambient
