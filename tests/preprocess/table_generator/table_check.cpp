#include "tests/preprocess/table_generator/table_check.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>

#include "bullet_ambient/base/elementary.h"
#include "preprocess/added_mass_tables/known_added_mass.h"
#include "preprocess/added_mass_tables/revolution_inertia.h"
#include "preprocess/added_mass_tables/table_places.h"
#include "preprocess/builder/shape_builder.h"

namespace ambient {
namespace {

using Random = std::mt19937;

double uniform(Random& random) { return static_cast<double>(random()) / 4294967296.0; }

double anyRatio(Random& random) { return portable::pow(kLargestRatio, 2 * uniform(random) - 1); }

TableShape randomShape(TableShape::Kind kind, Random& random) {
  const double x = uniform(random), y = uniform(random);
  switch (kind) {
    case TableShape::kBox:
      return {kind, {1, portable::pow(kLargestRatio, x), portable::pow(kLargestRatio, y)}};
    case TableShape::kCylinder:
      return {kind, {1, 2 * anyRatio(random), 0}};
    case TableShape::kCapsule:
      return {kind, {1, 2 * portable::expm1(x * portable::log1p(kLargestRatio)), 0}};
    default:
      break;
  }
  const double height = 2 * anyRatio(random), share = kLargestRounding * x * x;
  return {kind, {1, height, y < 0.5 ? 0 : height / (1 + height) * share / (1 - share)}};
}

Matrix6 tabulated(const TableShape& shape) {
  const Vector3& s = shape.sizes;
  switch (shape.kind) {
    case TableShape::kBox:
      return boxAddedMass(s).value();
    case TableShape::kCylinder:
      return cylinderAddedMass(s[0], s[1]).value();
    case TableShape::kCapsule:
      return capsuleAddedMass(s[0], s[1]).value();
    default:
      return coneAddedMass(s[0], s[1], s[2]).value();
  }
}

Matrix6 accurate(const TableShape& shape) {
  const std::vector<double> K = solveShape(shape);
  if (shape.kind == TableShape::kBox) return Eigen::Map<const Vector6>(K.data()).asDiagonal();
  return RevolutionInertia{K[0], K[1], K[2], K[3]}.matrix();
}

/// Added mass by a user's default build; none for rounded cones, which JSON shapes lack.
std::optional<Matrix6> solvedByDefault(const TableShape& shape) {
  const Vector3& s = shape.sizes;
  ShapeDescription description;
  if (shape.kind == TableShape::kBox) description.geometry = Box{s};
  if (shape.kind == TableShape::kCylinder) description.geometry = Cylinder{s[0], s[1]};
  if (shape.kind == TableShape::kCapsule) description.geometry = Capsule{s[0], s[1]};
  if (shape.kind == TableShape::kCone) description.geometry = Cone{s[0], s[1]};
  if (s[2] > 0 && shape.kind == TableShape::kCone) return std::nullopt;
  ShapeBuildSettings settings;
  settings.tables = false;
  settings.origin = Vector3::Zero();
  return buildShape(description, settings).body.added_mass;
}

struct TableError {
  double rotation = 0, translation = 0;  ///< over the largest entry of the block
  double entry = 0;                      ///< largest relative error of a diagonal entry

  void take(const TableError& other) {
    rotation = std::max(rotation, other.rotation);
    translation = std::max(translation, other.translation);
    entry = std::max(entry, other.entry);
  }
};

TableError errorOf(const Matrix6& K, const Matrix6& exact) {
  const Matrix6 change = (K - exact).cwiseAbs();
  TableError error;
  error.rotation = change.topLeftCorner<3, 3>().maxCoeff() / exact.topLeftCorner<3, 3>().maxCoeff();
  error.translation =
      change.bottomRightCorner<3, 3>().maxCoeff() / exact.bottomRightCorner<3, 3>().maxCoeff();
  for (int i = 0; i < 6; ++i)
    if (K(i, i) > 0) error.entry = std::max(error.entry, change(i, i) / exact(i, i));
  return error;
}

std::string row(const std::string& name, const TableError& made_from,
                const std::optional<TableError>& by_default) {
  char text[200];
  std::snprintf(text, sizeof text, "| %s | %.3f %% | %.3f %% | %.3f %% |", name.c_str(),
                100 * made_from.rotation, 100 * made_from.translation, 100 * made_from.entry);
  std::string line = text;
  if (!by_default) return line + " | |\n";
  std::snprintf(text, sizeof text, " %.2f %% | %.2f %% |\n", 100 * by_default->rotation,
                100 * by_default->translation);
  return line + text;
}

}  // namespace

std::string checkTable(TableShape::Kind kind, int shapes, int seed) {
  Random random(seed);
  std::string table =
      "| shape | rotation | translation | any entry | rotation, default build | translation, "
      "default build |\n|---|---|---|---|---|---|\n";
  TableError largest, largest_by_default;
  for (int i = 0; i < shapes; ++i) {
    const TableShape shape = randomShape(kind, random);
    const Matrix6 K = tabulated(shape);
    const TableError error = errorOf(K, accurate(shape));
    largest.take(error);
    std::optional<TableError> by_default;
    if (const auto solved = solvedByDefault(shape)) {
      by_default = errorOf(K, *solved);
      largest_by_default.take(*by_default);
    }
    table += row(shape.text(), error, by_default);
  }
  return table + row("**largest**", largest, largest_by_default);
}

}  // namespace ambient
