#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <cstdlib>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "preprocess/base/parallel_for.h"
#include "preprocess/mesh/shapes/primitives.h"
#include "tests/preprocess/potential_flow/flow_fixtures.h"

namespace ambient {
namespace {

std::string complaint(const TriangleMesh& mesh, const PotentialFlowSettings& settings = {}) {
  return messageOf([&] { solvePotentialFlow(mesh, settings); });
}

TEST(PotentialFlowInput, OpenSurfaceNamesItsEdges) {
  EXPECT_EQ(complaint(withoutTriangle(makeBoxMesh({1, 1, 1}, 48), 5)),
            "potential flow: the surface is open at 3 edges; it must be closed, or be declared a "
            "sheet");
}

TEST(PotentialFlowInput, InsideOutSurfaceIsRefused) {
  EXPECT_EQ(complaint(insideOut(makeBoxMesh({1, 1, 1}, 48))),
            "potential flow: the surface is inside out or encloses no volume; triangles must be "
            "counter-clockwise seen from the fluid");
}

TEST(PotentialFlowInput, TriangleWithoutAreaIsNamed) {
  TriangleMesh mesh = makeBoxMesh({1, 1, 1}, 48);
  mesh.triangles(1, 7) = mesh.triangles(0, 7);
  EXPECT_EQ(complaint(mesh), "potential flow: triangle 7 has no area");
}

TEST(PotentialFlowInput, CoordinateThatIsNotANumberIsRefused) {
  TriangleMesh mesh = makeBoxMesh({1, 1, 1}, 48);
  mesh.vertices(1, 3) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NE(complaint(mesh).find("has no area"), std::string::npos);
}

TEST(PotentialFlowInput, EmptyMeshIsRefused) {
  EXPECT_EQ(complaint({}), "potential flow: the mesh has 0 triangles; it needs at least 1");
}

TEST(PotentialFlowInput, SheetNeedsAVertexInside) {
  PotentialFlowSettings settings;
  settings.sheet = true;
  const TriangleMesh mesh =
      meshOf({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 3}});
  EXPECT_EQ(complaint(mesh, settings),
            "potential flow: the sheet of 2 panels, or a part of it, has no vertex inside its "
            "boundary: it must be divided into more panels");
  EXPECT_EQ(complaint(joined(makeRectangularSheetMesh(1, 1, 50), moved(mesh, {3, 0, 0})), settings)
                .find("potential flow: the sheet of "),
            0u);
}

TEST(PotentialFlowInput, SidesTooCloseForTheTrianglesAreRefused) {
  // A flattened tetrahedron: front and back have different triangles and nearly coincide.
  TriangleMesh mesh = unitTetrahedron();
  mesh.vertices =
      meshOf({{1, 1, 1e-4}, {1, -1, -1e-4}, {-1, 1, -1e-4}, {-1, -1, 1e-4}}, {}).vertices;
  mesh.triangles = insideOut(mesh).triangles;
  EXPECT_NE(complaint(mesh).find("is not positive definite; two sides of the surface"),
            std::string::npos)
      << complaint(mesh);
}

TEST(PotentialFlowInput, VerticesWithoutTrianglesAreIgnored) {
  TriangleMesh mesh = makeBoxMesh({1, 1, 1}, 48);
  const Matrix6 K = test::addedMassOf(mesh);
  mesh.vertices.conservativeResize(3, mesh.vertexCount() + 1);
  mesh.vertices.rightCols<1>() << 50, 60, 70;
  const PotentialFlow flow = solvePotentialFlow(mesh);
  EXPECT_EQ(flow.added_mass, K);
  EXPECT_EQ(flow.potential.bottomRows<1>().norm(), 0);
}

TEST(ParallelFor, VisitsEveryIndexOnce) {
  for (int threads : {1, 2, 5}) {
    std::vector<int> visits(1000, 0);
    parallelFor(threads, 1000, [&](std::ptrdiff_t i) { ++visits[i]; });
    EXPECT_EQ(visits, std::vector<int>(1000, 1));
  }
}

// The address sanitizer needs more memory than the limit allows.
#if defined(__has_feature)
#define AMBIENT_HAS_ADDRESS_SANITIZER __has_feature(address_sanitizer)
#else
#define AMBIENT_HAS_ADDRESS_SANITIZER 0
#endif
#if !AMBIENT_HAS_ADDRESS_SANITIZER
TEST(ParallelFor, DoesItAllWhereNoThreadCanBeStarted) {
  const auto countWithoutThreads = [] {
    std::vector<int> visits(100, 0);
    const rlimit no_more_memory{1, 1};  // [bytes], too few for a thread's stack
    setrlimit(RLIMIT_AS, &no_more_memory);
    parallelFor(8, 100, [&](std::ptrdiff_t i) { ++visits[i]; });
    std::_Exit(std::count(visits.begin(), visits.end(), 1) == 100 ? 0 : 1);
  };
  EXPECT_EXIT(countWithoutThreads(), ::testing::ExitedWithCode(0), "");
}
#endif

TEST(ParallelFor, PassesExceptionsOn) {
  const auto failing = [](std::ptrdiff_t i) {
    if (i == 17) throw std::runtime_error("seventeen");
  };
  EXPECT_EQ(messageOf([&] { parallelFor(3, 100, failing); }), "seventeen");
}

}  // namespace
}  // namespace ambient
