#include "preprocess/added_mass_tables/known_added_mass.h"

#include <cmath>

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/base/elementary.h"
#include "preprocess/added_mass_tables/table_data.h"
#include "preprocess/added_mass_tables/table_places.h"

namespace ambient {
namespace {

std::optional<Matrix6> lookUp(const RoundTable& table, const RoundPlace& round) {
  if (!round.place.isInside()) return std::nullopt;
  const auto [x, y] = round.place;
  RevolutionInertia inertia;
  inertia.v_z = round.scale.v_z * portable::exp(table.v_z(x, y));
  inertia.v_x = round.scale.v_x * portable::exp(table.v_x(x, y));
  inertia.w_y = round.scale.w_y * table.w_y(x, y);
  if (table.coupling.rows > 0) inertia.coupling = round.scale.coupling * table.coupling(x, y);
  return inertia.matrix();
}

}  // namespace

std::string addedMassTablesName() { return "added mass tables " + std::to_string(kTableRevision); }

std::optional<Matrix6> boxAddedMass(const Vector3& half_sizes) {
  AMBIENT_ASSERT(half_sizes.minCoeff() > 0 && half_sizes.allFinite());
  const BoxTable& table = boxTable();
  Matrix6 K = Matrix6::Zero();
  for (int k = 0; k < 3; ++k) {
    const BoxAxis axis{half_sizes[k], half_sizes[(k + 1) % 3], half_sizes[(k + 2) % 3]};
    if (half_sizes[k] > kLargestRatio * half_sizes.minCoeff()) return std::nullopt;
    const auto [x, y] = axis.place();
    K(k, k) = axis.rotationScale() * table.rotation(x, y);
    K(3 + k, 3 + k) = axis.translationScale() * portable::exp(table.translation(x, y));
  }
  return K;
}

std::optional<Matrix6> cylinderAddedMass(double radius, double height) {
  return lookUp(cylinderTable(), cylinderPlace(radius, height));
}

std::optional<Matrix6> capsuleAddedMass(double radius, double height) {
  return lookUp(capsuleTable(), capsulePlace(radius, height));
}

std::optional<Matrix6> coneAddedMass(double radius, double height, double rounding) {
  return lookUp(coneTable(), conePlace(radius, height, rounding));
}

}  // namespace ambient
