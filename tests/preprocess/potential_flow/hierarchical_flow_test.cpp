#include <gtest/gtest.h>

#include <cmath>
#include <ostream>
#include <string>

#include "preprocess/mesh/shapes/primitives.h"
#include "tests/preprocess/potential_flow/flow_fixtures.h"

namespace ambient {
namespace {

using test::relativeError;
using test::skewBody;

PotentialFlow solveWith(FlowSolverKind solver, const TriangleMesh& mesh, bool sheet,
                        int threads = 0) {
  PotentialFlowSettings settings;
  settings.solver = solver;
  settings.sheet = sheet;
  settings.threads = threads;
  return solvePotentialFlow(mesh, settings);
}

/// Largest difference of a block over its largest entry. A coupling that vanishes by symmetry is
/// relative to the geometric mean of its neighbours.
double blockError(const Matrix6& a, const Matrix6& b, int row, int column) {
  const auto largest = [&](int i, int j) { return b.block<3, 3>(i, j).cwiseAbs().maxCoeff(); };
  double scale = largest(row, column);
  const double mean = std::sqrt(largest(row, row) * largest(column, column));
  if (scale < 1e-3 * mean) scale = mean;
  return (a - b).block<3, 3>(row, column).cwiseAbs().maxCoeff() / scale;
}

struct Case {
  const char* name;
  TriangleMesh (*make)();
  bool sheet;
};

std::ostream& operator<<(std::ostream& out, const Case& c) { return out << c.name; }

const Case kCases[] = {
    {"Sphere",
     [] {
       return makeEllipsoidMesh({1, 1, 1}, 980);
     },
     false},
    {"FlatBox",
     [] {
       return makeBoxMesh({1, 1, 0.1}, 1000);
     },
     false},
    {"ThinOblate",
     [] {
       return makeEllipsoidMesh({1, 1, 0.02}, 980);
     },
     false},
    {"SkewBody",
     [] {
       return skewBody(makeBoxMesh({1, 0.6, 0.8}, 900));
     },
     false},
    {"Sheet", [] { return makeRectangularSheetMesh(1, 0.7, 1000); }, true},
    {"TwoBodies",
     [] {
       return joined(skewBody(makeBoxMesh({1, 0.6, 0.8}, 500)),
                     moved(makeEllipsoidMesh({0.5, 0.3, 0.2}, 320), {1.1, 0.9, 1}));
     },
     false},
};

class HierarchicalFlow : public testing::TestWithParam<Case> {};

TEST_P(HierarchicalFlow, AgreesWithTheDenseSolver) {
  const TriangleMesh mesh = GetParam().make();
  const PotentialFlow flow = solveWith(FlowSolverKind::Hierarchical, mesh, GetParam().sheet);
  const PotentialFlow dense = solveWith(FlowSolverKind::Dense, mesh, GetParam().sheet);
  EXPECT_GT(flow.iterations, 0);
  EXPECT_EQ(dense.iterations, 0);
  // Requirement: 1e-3; measured 3e-5 at most for these sizes.
  for (const int row : {0, 3})
    for (const int column : {0, 3})
      EXPECT_LT(blockError(flow.added_mass, dense.added_mass, row, column), 1e-4)
          << row << " " << column;
  // Measured 2.5e-5 at most; a far field with an error of 5 % fails here first.
  EXPECT_LT((flow.potential - dense.potential).norm(), 1e-4 * dense.potential.norm());
}

INSTANTIATE_TEST_SUITE_P(Shapes, HierarchicalFlow, testing::ValuesIn(kCases),
                         [](const auto& test) { return std::string(test.param.name); });

TEST(HierarchicalSolver, ThreadsDoNotChangeABit) {
  const TriangleMesh mesh = skewBody(makeBoxMesh({1, 0.6, 0.8}, 600));
  const PotentialFlow one = solveWith(FlowSolverKind::Hierarchical, mesh, false, 1);
  const PotentialFlow three = solveWith(FlowSolverKind::Hierarchical, mesh, false, 3);
  EXPECT_EQ(one.added_mass, three.added_mass);
  EXPECT_EQ(one.potential, three.potential);
}

// Lamb: a sphere has half its volume as added mass.
TEST(HierarchicalSolver, TakesOverAboveALimit) {
  const double volume = 4.0 / 3 * std::acos(-1.0);
  const PotentialFlow flow =
      solvePotentialFlow(withVolume(makeEllipsoidMesh({1, 1, 1}, 4500), volume));
  ASSERT_GT(flow.panels, kMostDensePanels);
  EXPECT_GT(flow.iterations, 0);
  // Error of the facets, measured 4e-6.
  for (int k = 3; k < 6; ++k) EXPECT_LT(relativeError(flow.added_mass(k, k), volume / 2), 2e-5);
}

TEST(HierarchicalSolver, SaysHowMuchMemoryItNeedsBeforeItTakesIt) {
  PotentialFlowSettings settings;
  settings.memory_limit = 1e6;
  settings.solver = FlowSolverKind::Hierarchical;
  const TriangleMesh mesh = makeEllipsoidMesh({1, 1, 1}, 980);
  EXPECT_EQ(messageOf([&] { solvePotentialFlow(mesh, settings); }),
            "potential flow: 980 panels need 0.0042 GB of memory, more than the 0.001 GB that may "
            "be used: use fewer panels or allow more memory");
  settings.solver = FlowSolverKind::Dense;
  EXPECT_EQ(messageOf([&] {
              solvePotentialFlow(mesh, settings);
            }).find("potential flow: 980 panels need 0.017 GB of memory, more than "),
            0U);
  settings.memory_limit = 1e9;
  EXPECT_NO_THROW(solvePotentialFlow(mesh, settings));
}

}  // namespace
}  // namespace ambient
