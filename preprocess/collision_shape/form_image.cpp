#include "preprocess/collision_shape/form_image.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "bullet_ambient/base/ambient_assert.h"

namespace ambient {
namespace {

constexpr int kImages = 8;

Vector3 signsOf(int turned) {
  return {turned & 1 ? -1.0 : 1.0, turned & 2 ? -1.0 : 1.0, turned & 4 ? -1.0 : 1.0};
}

/// Rounds to 24 binary digits after the point; without -0.
Vector3 rounded(const Vector3& v) {
  return v.unaryExpr([](double x) { return std::ldexp(std::round(std::ldexp(x, 24)), -24) + 0.0; });
}

/// A unit vector, rounded, the one of v and -v whose first number is positive.
Vector3 upward(const Vector3& v) {
  const Vector3 axis = rounded(v).normalized();
  for (const double x : axis)
    if (x != 0) return x < 0 ? Vector3(-axis + Vector3::Zero()) : axis;
  return axis;
}

/// Brings a part with mirrored axes into the pose that its surface alone decides; false: it has
/// none.
struct PoseMaker {
  const Matrix3 axes;
  RigidPose& pose;
  const Vector3 signs;

  bool operator()(Sphere&) const { return setAxes(Matrix3::Identity()); }
  bool operator()(Cylinder&) const { return setAxes(axesAlong(upward(axes.col(2)))); }
  bool operator()(Capsule&) const { return setAxes(axesAlong(upward(axes.col(2)))); }
  bool operator()(Cone&) const { return setAxes(axesAlong(rounded(axes.col(2)).normalized())); }
  bool operator()(Box&) const {
    Matrix3 turned;
    turned.col(0) = upward(axes.col(0));
    const Vector3 second = upward(axes.col(1));
    turned.col(1) = (second - second.dot(turned.col(0)) * turned.col(0)).normalized();
    turned.col(2) = turned.col(0).cross(turned.col(1));
    return setAxes(turned);
  }
  bool operator()(Hull& hull) const {
    for (Eigen::Vector3d& point : hull.points)
      point = rounded(signs.cwiseProduct(Vector3(pose * point)));
    std::sort(hull.points.begin(), hull.points.end(), [](const auto& a, const auto& b) {
      return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end());
    });
    pose = RigidPose::Identity();
    return true;
  }
  template <class Other>
  bool operator()(Other&) const {
    return false;
  }

 private:
  bool setAxes(const Matrix3& turned) const {
    pose.linear() = turned;
    pose.translation() = rounded(signs.cwiseProduct(Vector3(pose.translation())));
    return true;
  }
};

/// The image, parts in poses of their own; false: a part has none.
bool turn(ShapeForm& form, int turned) {
  const Vector3 signs = signsOf(turned);
  return std::all_of(form.parts.begin(), form.parts.end(), [&](PlacedShape& part) {
    const Matrix3 axes = signs.asDiagonal() * Matrix3(part.pose.linear());
    return std::visit(PoseMaker{axes, part.pose, signs}, part.shape);
  });
}

void turn(std::vector<double>& column, double sign) {
  if (sign < 0)
    for (double& value : column) value = 0 - value;
}

void turn(FaceTable& faces, const Vector3& signs) {
  SharedList<double>* normals[] = {&faces.normal_x, &faces.normal_y, &faces.normal_z};
  std::vector<double>* places[] = {&faces.centroid_x, &faces.centroid_y, &faces.centroid_z};
  for (int axis = 0; axis < 3; ++axis) {
    if (signs[axis] > 0) continue;
    turn(normals[axis]->own(), signs[axis]);
    turn(*places[axis], signs[axis]);
  }
}

/// Triangles that are counter-clockwise again.
void reverse(SharedList<std::int32_t>& triangles) {
  std::vector<std::int32_t>& own = triangles.own();
  for (std::size_t t = 0; t + 2 < own.size(); t += 3) std::swap(own[t + 1], own[t + 2]);
}

Matrix6 turned(const Matrix6& inertia, const Vector3& signs) {
  Vector6 both;
  both << signs.prod() * signs, signs;  // a rotation is an axial vector
  return both.asDiagonal() * inertia * both.asDiagonal();
}

Matrix3 turned(const Matrix3& matrix, const Vector3& signs) {
  return signs.asDiagonal() * matrix * signs.asDiagonal();
}

void turn(FormShape& shape, const Vector3& signs) {
  for (Vector3* v : {&shape.facing, &shape.span, &shape.slender, &shape.pitching, &shape.centre})
    *v = v->cwiseProduct(signs);
}

/// Turns the axes of separation to an image; where a mirror makes them left-handed, the last one
/// points the other way.
void turn(Separation& separation, const Vector3& signs) {
  separation.axes = signs.asDiagonal() * separation.axes;
  if (signs.prod() > 0) return;
  separation.axes.col(2) *= -1;
  std::swap(separation.ways[4], separation.ways[5]);
}

void turn(ViscousForm& form, const Vector3& signs) {
  form.resistance = turned(form.resistance, signs);
  form.centre_of_reaction = form.centre_of_reaction.cwiseProduct(signs);
  form.surface.gyration = turned(form.surface.gyration, signs);
  turn(form.separation, signs);
}

}  // namespace

FormImage firstImage(const ShapeForm& form) {
  FormImage first{form, 0};
  std::string least;
  for (int axes = 0; axes < kImages; ++axes) {
    ShapeForm image = form;
    if (!turn(image, axes)) return {form, 0};
    std::string content = contentOf(image.parts);
    if (axes > 0 && !(content < least)) continue;
    least = std::move(content);
    first = {std::move(image), axes};
  }
  return first;
}

FluidBody imageOf(const FluidBody& body, int axes) {
  AMBIENT_ASSERT(body.holds.empty() && body.wings.empty() && body.waterline.empty() &&
                 body.drag.isZero(0) && axes >= 0 && axes < kImages);
  const Vector3 signs = signsOf(axes);
  FluidBody image = body;
  image.added_mass = turned(body.added_mass, signs);
  for (Vector3* place : {&image.centre_of_volume, &image.origin, &image.uniform_mass.centre,
                         &image.surface_mass.centre})
    *place = place->cwiseProduct(signs);
  for (MassDistribution* mass : {&image.uniform_mass, &image.surface_mass})
    mass->inertia = turned(mass->inertia, signs);
  turn(image.faces, signs);
  for (std::size_t i = 0; i < image.surface.vertices.size(); ++i)
    image.surface.vertices[i] *= signs[static_cast<int>(i % 3)];
  turn(image.form.shape, signs);
  turn(image.form.rest, signs);
  turn(image.form.faces, signs);
  if (signs.prod() < 0) {
    reverse(image.surface.triangles);
    reverse(image.form.hull);
  }
  turn(image.viscous, signs);
  for (FormLevel& level : image.form_levels) turn(level.faces, signs);
  std::vector<AddedMassPart> parts = body.added_mass_parts.all();
  for (AddedMassPart& part : parts) part = imageOf(part, axes);
  image.added_mass_parts = parts;
  image.provenance.settings += "; image " + std::to_string(axes);
  return image;
}

}  // namespace ambient
