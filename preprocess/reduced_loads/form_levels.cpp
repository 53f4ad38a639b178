#include "preprocess/reduced_loads/form_levels.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <utility>
#include <vector>

#include "bullet_ambient/base/elementary.h"
#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/fluid_body/packed/packed_shape.h"
#include "bullet_ambient/force/law/form_law.h"
#include "bullet_ambient/force/loads/face_loads.h"
#include "preprocess/base/numerics.h"
#include "preprocess/base/surface_form.h"

namespace ambient {
namespace {

/// Samples a unit vector, uniform over the sphere.
Vector3 sampleDirection(SplitMix64& numbers) {
  for (;;) {
    const double x = 2 * numbers.uniform() - 1, y = 2 * numbers.uniform() - 1,
                 z = 2 * numbers.uniform() - 1;
    const double length_sq = x * x + y * y + z * z;
    if (length_sq <= 1 && length_sq > 1e-4) return Vector3(x, y, z) / std::sqrt(length_sq);
  }
}

/// Samples a motion (w, v) with |w|^2 + |v|^2 = 1 in units of a level: v and w in independent
/// directions, uniform over the sphere, and atan(|w| / |v|) uniform from 0 to pi/2.
Vector6 sampleMotion(SplitMix64& numbers) {
  const double angle = kPi / 2 * numbers.uniform();
  Vector6 x;
  x << portable::sin(angle) * sampleDirection(numbers),
      portable::cos(angle) * sampleDirection(numbers);
  return x;
}

/// Faces relative to the centroid of the surface, in units of their root mean square distance from
/// it.
struct CentredFaces {
  Vector3 centre{0, 0, 0};  ///< in the frame of the source [m]
  double length = 0;        ///< [m]
  FaceTable faces;          ///< with the sharpness of the source, where it has one

  /// @throws std::invalid_argument naming the body, if no faces that are apart have an area.
  CentredFaces(const FluidBody& body, const FaceTable& source) {
    double area = 0, moment = 0;
    for (std::size_t i = 0; i < source.size(); ++i) {
      area += source.area[i];
      centre += source.area[i] * source.centroid(i);
    }
    if (area > 0) centre /= area;
    for (std::size_t i = 0; i < source.size(); ++i)
      moment += source.area[i] * (source.centroid(i) - centre).squaredNorm();
    if (area > 0) length = std::sqrt(moment / area);
    if (!(length > 0)) {
      throw std::invalid_argument("fluid body '" + body.name +
                                  "': reduced loads need faces that are apart and have an area");
    }
    for (std::size_t i = 0; i < source.size(); ++i)
      faces.add(source.normal(i), (source.centroid(i) - centre) / length,
                source.area[i] / (length * length));
    faces.sharpness = source.sharpness;
  }

  /// Converts faces of a level from these units to the frame of the source.
  void moveBack(FaceTable& of_level) const {
    FaceTable moved;
    for (std::size_t i = 0; i < of_level.size(); ++i)
      moved.add(of_level.normal(i), centre + length * of_level.centroid(i),
                length * length * of_level.area[i]);
    moved.sharpness = std::move(of_level.sharpness);
    of_level = std::move(moved);
  }
};

void addImage(const FaceTable& faces, std::size_t i, const Vector3& signs, double area,
              FaceTable& to) {
  to.add(signs.cwiseProduct(faces.normal(i)), signs.cwiseProduct(faces.centroid(i)), area);
  to.sharpness.push_back(faces.sharpness[i]);
}

/// Group of mirrors across planes through the origin, perpendicular to axes of the frame.
class FaceMirrors {
 public:
  /// Bit 0, 1, 2 of `axes`: the mirror that turns x, y, z round.
  explicit FaceMirrors(unsigned axes) {
    for (unsigned image = 0; image < 8; ++image) {
      if ((image & axes) != image) continue;
      signs_.emplace_back((image & 1) ? -1 : 1, (image & 2) ? -1 : 1, (image & 4) ? -1 : 1);
    }
  }

  /// Number of images of a face, itself among them: 1, 2, 4 or 8.
  int images() const { return static_cast<int>(signs_.size()); }
  /// Returns the faces on the positive sides of all mirrors, each for all of its images.
  FaceTable folded(const FaceTable& faces) const {
    FaceTable result;
    for (std::size_t i = 0; i < faces.size(); ++i) {
      Vector3 signs = Vector3::Ones();
      for (int axis = 0; axis < 3; ++axis)
        if (faces.centroid(i)[axis] < 0) signs[axis] = signs_.back()[axis];
      addImage(faces, i, signs, faces.area[i], result);
    }
    return result;
  }
  /// Unfolds faces: every face with its images, which share its area.
  FaceTable unfolded(const FaceTable& faces) const {
    FaceTable result;
    for (std::size_t i = 0; i < faces.size(); ++i)
      for (const Vector3& signs : signs_)
        addImage(faces, i, signs, faces.area[i] / images(), result);
    return result;
  }
  /// Returns all faces mirrored by all mirrors at once.
  FaceTable mirrored(const FaceTable& faces) const {
    FaceTable result;
    for (std::size_t i = 0; i < faces.size(); ++i)
      addImage(faces, i, signs_.back(), faces.area[i], result);
    return result;
  }

 private:
  std::vector<Vector3> signs_;  // of coordinates, for each image
};

constexpr std::uint64_t kErrorSeed = 3, kFitSeed = 4;
constexpr int kErrorMotions = 1000, kFitMotions = 200, kFitTranslations = 50;
constexpr double kTranslationWeight = 3;  // of a translation in the fit, over a motion with spin

/// Pressure on the faces; in single precision, which is 1e-6 off.
Vector6 loadOn(const PackedFaces& faces, const ShapeFactors& shape, const Vector6& motion) {
  const LoadSettings settings{1, 0, 0, false, PressureLaw::kForm, &shape};
  return computeFaceLoad(faces, 1, Twist::fromVector(motion), settings).vector();
}

/// 1/2 sum A_i |u_i|^2 as a form of the motion: what errors are compared with.
Matrix6 scaleOf(const FaceTable& faces) {
  Matrix6 form = Matrix6::Zero();
  for (std::size_t i = 0; i < faces.size(); ++i) {
    const Vector3 c = faces.centroid(i);
    Matrix3 moment;  // w x c = moment w
    moment << 0, c.z(), -c.y(), -c.z(), 0, c.x(), c.y(), -c.x(), 0;
    Eigen::Matrix<double, 3, 6> velocity;
    velocity << moment, Matrix3::Identity();
    form += 0.5 * faces.area[i] * velocity.transpose() * velocity;
  }
  return form;
}

/// Motions, and the loads on the faces in them over their scales.
struct LoadSamples {
  /// `form`: scaleOf() the faces.
  LoadSamples(const PackedFaces& packed, const Matrix6& form, const ShapeFactors& of_body,
              std::uint64_t seed, int count, int translations = 0)
      : shape(of_body) {
    SplitMix64 numbers(seed);
    for (int i = 0; i < count; ++i) add(packed, form, sampleMotion(numbers), 1);
    for (int i = 0; i < translations; ++i)
      add(packed, form, stack(Vector3::Zero(), sampleDirection(numbers)), kTranslationWeight);
  }

  /// Error of the loads on other faces in one motion.
  double errorOf(const PackedFaces& others, std::size_t motion) const {
    return (loadOn(others, shape, motions[motion]) / scales[motion] - loads[motion]).norm();
  }

  /// Returns the error of other faces that one motion in a hundred exceeds; infinity once so many
  /// exceed `largest`.
  double p99Error(const FaceTable& others, double largest) const {
    const PackedFaces packed(others, shape.shape);
    const std::size_t rank = motions.size() * 99 / 100;
    std::size_t allowed = motions.size() - rank;
    std::vector<double> errors;
    for (std::size_t i = 0; i < motions.size(); ++i) {
      errors.push_back(errorOf(packed, i));
      if (errors.back() > largest && --allowed == 0) return std::numeric_limits<double>::infinity();
    }
    const auto at = errors.begin() + static_cast<std::ptrdiff_t>(rank);
    std::nth_element(errors.begin(), at, errors.end());
    return *at;
  }

  /// Returns true if no error of other faces in the first `count` motions exceeds `largest`.
  bool areSame(const FaceTable& others, double largest, std::size_t count) const {
    const PackedFaces packed(others, shape.shape);
    for (std::size_t i = 0; i < count; ++i)
      if (errorOf(packed, i) > largest) return false;
    return true;
  }

  ShapeFactors shape;
  std::vector<Vector6> motions, loads;
  std::vector<double> scales, weights;  ///< weights: in the fit

 private:
  void add(const PackedFaces& faces, const Matrix6& form, const Vector6& motion, double weight) {
    motions.push_back(motion);
    weights.push_back(weight);
    scales.push_back(motion.dot(form * motion));
    loads.push_back(loadOn(faces, shape, motion) / scales.back());
  }
};

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

/// Least squares for x >= 0, drawn a little towards where it begins; by coordinates in turn.
void fitPositive(const Eigen::MatrixXd& A, const Eigen::VectorXd& b, std::vector<double>& x) {
  constexpr int kRounds = 300;
  constexpr double kPull = 1e-4;
  fixBlocksOfLargeProducts();
  const Eigen::MatrixXd G = A.transpose() * A;
  const Eigen::VectorXd g = A.transpose() * b;
  const Eigen::Index n = G.rows();
  const double pull = kPull * G.trace() / static_cast<double>(n);
  Eigen::Map<Eigen::VectorXd> now(x.data(), n);
  const Eigen::VectorXd begin = now;
  for (int round = 0; round < kRounds; ++round)
    for (Eigen::Index k = 0; k < n; ++k) {
      const double rest = g[k] - G.col(k).dot(now) + G(k, k) * now[k];
      now[k] = std::max(0.0, (rest + pull * begin[k]) / (G(k, k) + pull));
    }
}

/// Turns faces about an axis of their frame by an angle that no regular polygon of few corners has.
FaceTable turned(const FaceTable& faces, int axis) {
  const double cosine = portable::cos(1), sine = portable::sin(1);
  const auto turn = [&](const Vector3& v) {
    const int j = (axis + 1) % 3, k = (axis + 2) % 3;
    Vector3 result = v;
    result[j] = cosine * v[j] - sine * v[k];
    result[k] = sine * v[j] + cosine * v[k];
    return result;
  };
  FaceTable result;
  for (std::size_t i = 0; i < faces.size(); ++i)
    result.add(turn(faces.normal(i)), turn(faces.centroid(i)), faces.area[i]);
  result.sharpness = faces.sharpness;
  return result;
}

/// Turns each normal into the plane of the axis and the face's place: pressure on a body of
/// revolution has no moment about its axis.
void alignWithMeridians(FaceTable& faces, int axis) {
  FaceTable aligned;
  for (std::size_t i = 0; i < faces.size(); ++i) {
    Vector3 radius = faces.centroid(i), normal = faces.normal(i);
    radius[axis] = 0;
    const double along = normal[axis], across = radius.norm();
    normal =
        across > 0 ? Vector3(normal.dot(radius) / (across * across) * radius) : Vector3::Zero();
    normal[axis] = along;
    const bool keeps = normal.norm() > 0;
    aligned.add(keeps ? Vector3(normal.normalized()) : faces.normal(i), faces.centroid(i),
                faces.area[i]);
  }
  aligned.sharpness = std::move(faces.sharpness);
  faces = std::move(aligned);
}

class LevelMaker {
 public:
  LevelMaker(const FluidBody& body, const FormShape& shape)
      : centred_(body, formLawFaces(body, shape)),
        shape_(centredShape(shape)),
        packed_(centred_.faces, shape_.shape),
        form_(scaleOf(centred_.faces)),
        for_error_(packed_, form_, shape_, kErrorSeed, kErrorMotions),
        for_fit_(packed_, form_, shape_, kFitSeed, kFitMotions, kFitTranslations),
        mirrors_(findMirrors()),
        axis_(findAxis()),
        folded_(mirrors_.folded(centred_.faces)) {}

  std::size_t size() const { return centred_.faces.size(); }

  /// Makes a level of about so many faces. An error above `largest` is told as infinity.
  FormLevel level(int count, double largest = std::numeric_limits<double>::infinity()) const {
    const int clusters = std::max(1, count / mirrors_.images());
    FaceTable folded = joined(folded_, clusterFaces(folded_, clusters));
    if (axis_) alignWithMeridians(folded, *axis_);
    fitAreas(folded);
    FormLevel level;
    level.faces = mirrors_.unfolded(withArea(folded));
    level.p99_error = for_error_.p99Error(level.faces, largest);
    centred_.moveBack(level.faces);
    return level;
  }

 private:
  /// The shape in the units of the centred faces.
  ShapeFactors centredShape(FormShape shape) const {
    shape.centre = (shape.centre - centred_.centre) / centred_.length;
    return ShapeFactors(shape);
  }

  /// True if the loads on other faces look the same, up to what the mesh has left.
  bool areSame(const FaceTable& others) const {
    constexpr double kSame = 5e-3;
    constexpr std::size_t kMotions = 64;
    return for_fit_.areSame(others, kSame, kMotions);
  }

  FaceMirrors findMirrors() const {
    unsigned axes = 0;
    for (unsigned axis = 0; axis < 3; ++axis)
      if (areSame(FaceMirrors(1u << axis).mirrored(centred_.faces))) axes |= 1u << axis;
    return FaceMirrors(axes);
  }

  /// Finds the axis through the centroid that the body is one of revolution about; balls have none.
  std::optional<int> findAxis() const {
    std::optional<int> found;
    for (int axis = 0; axis < 3; ++axis) {
      if (!areSame(turned(centred_.faces, axis))) continue;
      if (found) return std::nullopt;
      found = axis;
    }
    return found;
  }

  void fitAreas(FaceTable& folded) const {
    const std::size_t motions = for_fit_.motions.size();
    Eigen::MatrixXd A(6 * motions, folded.size());
    Eigen::VectorXd b(6 * motions);
    for (std::size_t i = 0; i < motions; ++i)
      b.segment<6>(static_cast<Eigen::Index>(6 * i)) = for_fit_.weights[i] * for_fit_.loads[i];
    for (std::size_t k = 0; k < folded.size(); ++k) {
      FaceTable unit;
      unit.add(folded.normal(k), folded.centroid(k), 1);
      unit.sharpness = {folded.sharpness[k]};
      const PackedFaces images(mirrors_.unfolded(unit), shape_.shape);
      for (std::size_t i = 0; i < motions; ++i)
        A.block<6, 1>(static_cast<Eigen::Index>(6 * i), static_cast<Eigen::Index>(k)) =
            for_fit_.weights[i] / for_fit_.scales[i] * loadOn(images, shape_, for_fit_.motions[i]);
    }
    fitPositive(A, b, folded.area);
  }

  static FaceTable withArea(const FaceTable& faces) {
    FaceTable result;
    for (std::size_t i = 0; i < faces.size(); ++i) {
      if (!(faces.area[i] > 0)) continue;
      result.add(faces.normal(i), faces.centroid(i), faces.area[i]);
      result.sharpness.push_back(faces.sharpness[i]);
    }
    return result;
  }

  CentredFaces centred_;
  ShapeFactors shape_;
  PackedFaces packed_;
  Matrix6 form_;
  LoadSamples for_error_, for_fit_;
  FaceMirrors mirrors_;
  std::optional<int> axis_;
  FaceTable folded_;
};

}  // namespace

std::vector<FormLevel> buildFormLevels(const FluidBody& body, const std::vector<int>& faces) {
  std::vector<FormLevel> levels;
  if (faces.empty()) return levels;
  const LevelMaker maker(body, formShapeOf(body));
  for (const int count : faces)
    if (static_cast<std::size_t>(count) < maker.size()) levels.push_back(maker.level(count));
  return levels;
}

std::optional<FormLevel> smallestFormLevel(const FluidBody& body, double p99_error) {
  const LevelMaker maker(body, formShapeOf(body));
  // Whole blocks of those that the loads are summed in.
  for (const std::size_t count : {16, 32, 48, 64, 96, 128, 192, 256}) {
    if (count >= maker.size()) break;
    FormLevel level = maker.level(static_cast<int>(count), p99_error);
    if (level.p99_error <= p99_error) return level;
  }
  return std::nullopt;
}

}  // namespace ambient
