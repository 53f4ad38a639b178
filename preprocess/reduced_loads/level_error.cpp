#include "preprocess/reduced_loads/level_error.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/base/elementary.h"
#include "bullet_ambient/force/law/skin_friction.h"
#include "bullet_ambient/force/loads/face_loads.h"
#include "bullet_ambient/spatial/symmetric_eigen.h"
#include "preprocess/reduced_loads/motion_sampler.h"

namespace ambient {
namespace {

constexpr std::uint64_t kMotionSeed = 2;
constexpr int kSamples = 4000, kFrictionSamples = 400, kBroadsideSamples = 200;
constexpr std::size_t kAscents = 24;
constexpr int kAscentSteps = 120;
constexpr double kFirstStride = 0.2, kLastStride = 1e-3;
constexpr double kBroadsideAngle = 0.1;  // [rad]

struct Sample {
  Vector6 motion;
  double error;
};

class Comparison {
 public:
  Comparison(const LoadLevel& level, const FaceTable& faces)
      : level_(level), faces_(faces), cosine_(separationCosine(level.separation_angle)) {}

  /// Error of the pressure, relative to S.
  double error(const Vector6& x) const {
    const LoadSettings settings{1, 0, cosine_, false};
    double scale = 0;
    for (std::size_t i = 0; i < faces_.size(); ++i) scale += faces_.area[i] * slipSquared(x, i);
    return ratio(difference(x, settings), 0.5 * scale);
  }

  /// Error of the pressure, relative to itself.
  double relativeError(const Vector6& x) const {
    const LoadSettings settings{1, 0, cosine_, false};
    const FaceLoads exact = computeFaceLoads(faces_, 1, Twist::fromVector(x), settings);
    return ratio(difference(x, settings), exact.pressure.vector().norm());
  }

  /// Error of the friction, relative to that on all faces together.
  double frictionError(const Vector6& x) const {
    const LoadSettings without{1, 0, cosine_, false}, with{1, 1, cosine_, true};
    double scale = 0;
    for (std::size_t i = 0; i < faces_.size(); ++i)
      scale += faces_.area[i] * portable::pow(slipSquared(x, i), 1 + kReynoldsExponent / 2);
    return ratio(difference(x, with) + -1.0 * difference(x, without),
                 0.5 * kFrictionCoefficient * scale);
  }

 private:
  static double ratio(const Wrench& error, double scale) {
    return scale > 0 ? error.vector().norm() / scale : 0;
  }

  double slipSquared(const Vector6& x, std::size_t i) const {
    const Vector3 n = faces_.normal(i);
    const Vector3 u = x.tail<3>() + x.head<3>().cross(faces_.centroid(i));
    return (u - n.dot(u) * n).squaredNorm();
  }

  Wrench difference(const Vector6& x, const LoadSettings& settings) const {
    const Twist twist = Twist::fromVector(x);
    return computeLevelLoad(level_, 1, twist, settings) +
           -1.0 * computeFaceLoads(faces_, 1, twist, settings).total();
  }

  const LoadLevel& level_;
  const FaceTable& faces_;
  double cosine_;
};

double percentile99(std::vector<Sample>& samples) {
  std::sort(samples.begin(), samples.end(),
            [](const Sample& a, const Sample& b) { return a.error > b.error; });
  return samples[samples.size() / 100].error;
}

// Random steps that shrink; each that makes the error larger is kept.
double climb(const Comparison& comparison, Sample sample, ArbitraryNumbers& numbers) {
  for (int step = 0; step < kAscentSteps; ++step) {
    const double progress = static_cast<double>(step) / kAscentSteps;
    const double stride = kFirstStride * portable::pow(kLastStride / kFirstStride, progress);
    const Vector6 motion = (sample.motion + stride * sampleMotion(numbers)).normalized();
    const double error = comparison.error(motion);
    if (error > sample.error) sample = {motion, error};
  }
  return sample.error;
}

Vector3 broadsideDirection(const FaceTable& faces) {
  Matrix3 square = Matrix3::Zero();
  for (std::size_t i = 0; i < faces.size(); ++i)
    square += faces.area[i] * faces.normal(i) * faces.normal(i).transpose();
  return symmetricEigen<3>(square).vectors.col(2);
}

double broadsideError(const Comparison& comparison, const FaceTable& faces,
                      ArbitraryNumbers& numbers) {
  const Vector3 broadside = broadsideDirection(faces);
  double largest = 0;
  for (int i = 0; i < kBroadsideSamples; ++i) {
    const Vector3 aside = numbers.direction().cross(broadside);
    Vector6 x = Vector6::Zero();
    x.tail<3>() = ((i % 2 ? 1 : -1) * broadside + kBroadsideAngle * aside).normalized();
    largest = std::max(largest, comparison.relativeError(x));
  }
  return largest;
}

}  // namespace

LoadLevelError measureError(const LoadLevel& level, const FaceTable& faces) {
  const Comparison comparison(level, faces);
  ArbitraryNumbers numbers(kMotionSeed);
  std::vector<Sample> samples(kSamples);
  LoadLevelError error;
  double square = 0;
  for (Sample& sample : samples) {
    sample.motion = sampleMotion(numbers);
    sample.error = comparison.error(sample.motion);
    square += sample.error * sample.error;
  }
  error.rms = std::sqrt(square / kSamples);
  error.p99 = percentile99(samples);
  for (std::size_t i = 0; i < kAscents; ++i)
    error.maximum = std::max(error.maximum, climb(comparison, samples[i], numbers));
  error.broadside = broadsideError(comparison, faces, numbers);
  samples.resize(kFrictionSamples);
  for (Sample& sample : samples) {
    sample.motion = sampleMotion(numbers);
    sample.error = comparison.frictionError(sample.motion);
  }
  error.friction = percentile99(samples);
  AMBIENT_ASSERT(error.p99 >= 0 && error.p99 <= error.maximum && error.friction >= 0);
  return error;
}

}  // namespace ambient
