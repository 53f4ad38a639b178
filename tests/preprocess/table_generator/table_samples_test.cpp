#include "tests/preprocess/table_generator/table_samples.h"

#include <gtest/gtest.h>

#include <cmath>

#include "preprocess/added_mass_tables/known_added_mass.h"
#include "preprocess/added_mass_tables/revolution_inertia.h"
#include "tests/preprocess/table_generator/table_fit.h"

namespace ambient {
namespace {

Matrix6 tabulated(const TableShape& shape) {
  const Vector3& s = shape.sizes;
  if (shape.kind == TableShape::kBox) return boxAddedMass(s).value();
  if (shape.kind == TableShape::kCylinder) return cylinderAddedMass(s[0], s[1]).value();
  if (shape.kind == TableShape::kCapsule) return capsuleAddedMass(s[0], s[1]).value();
  return coneAddedMass(s[0], s[1], s[2]).value();
}

// Moves edges of the range inside; rounding may put these samples outside.
TableShape justInside(TableShape shape) {
  const double ratio = shape.sizes[1] / shape.sizes[0];
  if (shape.kind == TableShape::kBox) {
    shape.sizes[0] /= 1 + 1e-9;
  } else {
    shape.sizes[1] *= ratio > 2 ? 1 - 1e-9 : 1 + 1e-9;
    shape.sizes[2] *= 1 - 1e-6;
  }
  return shape;
}

TEST(TableSamples, AreWhatTheShippedTablesSay) {
  const TableSamples samples(AMBIENT_TABLE_SAMPLES);
  for (const TableShape& shape : tableShapes()) {
    const std::vector<double>* entries = samples.find(shape);
    ASSERT_NE(entries, nullptr) << shape.text();
    const Matrix6 K = tabulated(justInside(shape));
    const std::vector<double>& k = *entries;
    const Matrix6 exact = k.size() == 6 ? Matrix6(Eigen::Map<const Vector6>(k.data()).asDiagonal())
                                        : RevolutionInertia{k[0], k[1], k[2], k[3]}.matrix();
    for (const int block : {0, 3}) {
      const Matrix3 expected = exact.block<3, 3>(block, block);
      const Matrix3 change = K.block<3, 3>(block, block) - expected;
      EXPECT_LT(change.cwiseAbs().maxCoeff(), 2e-3 * expected.maxCoeff()) << shape.text();
    }
    EXPECT_LT(std::abs(K(1, 3) - exact(1, 3)), 1e-3 * std::sqrt(exact(1, 1) * exact(3, 3)))
        << shape.text();
  }
}

TEST(TableFit, HasMoreSamplesThanTermsAndSmallResiduals) {
  const TableSamples samples(AMBIENT_TABLE_SAMPLES);
  for (const auto kind : kTableKinds) {
    for (const FittedSeries& series : fitTable(kind, samples)) {
      EXPECT_EQ(series.coefficients.size(), static_cast<std::size_t>(series.rows * series.columns));
      // Noise of the solver in the smallest entry of long boxes.
      EXPECT_LT(series.largest_residual, 1.2e-3) << series.name;
    }
  }
}

}  // namespace
}  // namespace ambient
