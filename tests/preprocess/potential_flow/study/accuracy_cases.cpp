#include "tests/preprocess/potential_flow/study/accuracy_cases.h"

#include <cmath>
#include <utility>

#include "bullet_ambient/base/pi.h"
#include "preprocess/mesh/shapes/primitives.h"
#include "preprocess/potential_flow/surface/surface_refinement.h"
#include "preprocess/shape/shape_mesh.h"
#include "tests/preprocess/potential_flow/study/known_added_mass.h"
#include "tests/preprocess/potential_flow/study/study_meshes.h"
#include "tests/reference/ellipsoid_added_mass.h"
#include "tests/reference/sheet_added_mass.h"
#include "tests/support/bodies/graded_meshes.h"

namespace ambient::study {
namespace {

// Orders of the error in the panel size. Curved bodies: polyhedra dominate the error; solids of
// flat sides: graded edges.
constexpr double kCurvedOrder = 2, kFlatOrder = 2.6;
// Triangles of the two meshes behind extrapolated references.
constexpr int kCoarseReference = 1800, kFineReference = 4800;

template <class Geometry>
TriangleMesh meshOf(const Geometry& geometry, int faces = ShapeDescription::kDefaultFaces) {
  ShapeDescription shape;
  shape.geometry = geometry;
  shape.faces = faces;
  return makeShapeMesh(shape).mesh;
}

std::function<Reference()> known(const Matrix6& exact) {
  return [exact] { return Reference{exact, 0}; };
}

std::function<Reference()> known(const reference::SheetAddedMass& exact) {
  Vector6 diagonal = Vector6::Zero();
  diagonal[0] = exact.w_x;
  diagonal[1] = exact.w_y;
  diagonal[5] = exact.v_z;
  return known(diagonal.asDiagonal());
}

template <class Make>
std::function<Reference()> extrapolated(const Make& make, double order) {
  return [make, order] {
    return extrapolate(make(kCoarseReference), make(kFineReference), false, order);
  };
}

AccuracyCase ellipsoid(const std::string& name, const Vector3& semi_axes, int faces) {
  return {name, Target::kSmooth, Symmetry::kThreeMirrors, meshOf(Ellipsoid{semi_axes}, faces),
          known(reference::ellipsoidAddedMass(semi_axes).asDiagonal())};
}

void addSmoothBodies(std::vector<AccuracyCase>& cases) {
  for (const int faces : {1300, 3000}) cases.push_back(ellipsoid("sphere", {1, 1, 1}, faces));
  for (const int aspect : {2, 5, 10, 20, 50}) {
    const std::string name = "spheroid " + std::to_string(aspect) + " : 1";
    for (const int faces : {1300, 3000})
      cases.push_back(ellipsoid(name, {1, 1, static_cast<double>(aspect)}, faces));
  }
  for (const int aspect : {2, 10, 50}) {
    const std::string name = "spheroid 1 : " + std::to_string(aspect);
    for (const int faces : {1300, 3000})
      cases.push_back(ellipsoid(name, {1, 1, 1.0 / aspect}, faces));
  }
  const double twisted_volume = 4 * kPi / 3 * 1.2 * 0.6;
  for (const int faces : {1300, 3000}) {
    const TriangleMesh mesh = test::twisted(makeEllipsoidMesh({1.2, 0.6, 1}, faces), 1);
    cases.push_back({"twisted ellipsoid", Target::kSmooth, Symmetry::kThreeTurns,
                     scaledToVolume(mesh, twisted_volume),
                     known(matrixOf(reference::TwistedEllipsoidAddedMass()))});
  }
  for (const int along : {26, 36}) {
    test::TorusShape torus;
    torus.along = torus.around = along;
    cases.push_back({"torus 2 : 1", Target::kSmooth, Symmetry::kThreeMirrors,
                     scaledToVolume(test::makeTorus(torus), 4 * kPi * kPi),
                     known(matrixOf(reference::torusAddedMass()))});
  }
  cases.push_back({"capsule, height 2", Target::kSmooth, Symmetry::kThreeMirrors,
                   meshOf(Capsule{1, 2}), known(matrixOf(reference::capsuleAddedMass()))});
}

void addRoundSharpBodies(std::vector<AccuracyCase>& cases) {
  const auto add = [&](const std::string& name, Symmetry symmetry, TriangleMesh mesh,
                       std::function<Reference()> reference) {
    cases.push_back({name, Target::kSharp, symmetry, std::move(mesh), std::move(reference)});
  };
  const auto cylinder = [](double height) {
    return [height](int faces) { return meshOf(Cylinder{1, height}, faces); };
  };
  constexpr Symmetry kThree = Symmetry::kThreeMirrors, kTwo = Symmetry::kTwoMirrors;
  const auto& default_faces = ShapeDescription::kDefaultFaces;
  add("cylinder, L/D 0.01", kThree, cylinder(0.02)(default_faces),
      extrapolated(cylinder(0.02), kCurvedOrder));
  add("cylinder, L/D 0.1", kThree, cylinder(0.2)(default_faces),
      known(matrixOf(reference::coinAddedMass())));
  add("cylinder, L/D 1", kThree, cylinder(2)(default_faces),
      known(matrixOf(reference::cylinderAddedMass())));
  add("cylinder, L/D 10", kThree, cylinder(20)(default_faces),
      extrapolated(cylinder(20), kCurvedOrder));
  for (const double height : {0.5, 1.0, 4.0}) {
    const auto cone = [height](int faces) { return meshOf(Cone{1, height}, faces); };
    add("cone, height over radius " + std::to_string(height).substr(0, 3), kTwo,
        cone(default_faces), extrapolated(cone, kCurvedOrder));
  }
  const double half_ball = 2 * kPi / 3;
  add("hemisphere", kTwo, scaledToVolume(test::gradedHemisphere(10), half_ball),
      known(matrixOf(reference::hemisphereAddedMass())));
  for (const int percent : {20, 10, 5}) {
    const double thickness = percent / 100.0;
    const auto bowl = [thickness](int rings, int rows, bool graded) {
      return scaledToVolume(makeBowl({thickness, rings, rows, graded}), bowlVolume(thickness));
    };
    add("bowl, thickness " + std::to_string(percent) + " %", kTwo, bowl(10, 1, false),
        [bowl] { return extrapolate(bowl(14, 4, true), bowl(20, 5, true), false, kCurvedOrder); });
  }
}

void addFlatSidedBodies(std::vector<AccuracyCase>& cases) {
  const auto add = [&](const std::string& name, const TriangleMesh& mesh,
                       std::function<Reference()> reference) {
    cases.push_back({name, Target::kSharp, Symmetry::kThreeMirrors, mesh, std::move(reference)});
  };
  add("cube", makeBoxMesh({1, 1, 1}, 12), known(cubeAddedMass()));
  add("cube", meshOf(Box{{1, 1, 1}}), known(cubeAddedMass()));
  add("cube, equal triangles", divideTriangles(makeBoxMesh({1, 1, 1}, 12), 3072),
      known(cubeAddedMass()));
  const auto addBox = [&](const std::string& name, const Eigen::Vector3d& half_sizes) {
    const auto make = [half_sizes](int faces) { return makeBoxMesh(half_sizes, faces); };
    for (const int faces : {12, 1300})
      add(name, makeBoxMesh(half_sizes, faces), extrapolated(make, kFlatOrder));
  };
  addBox("box 1 : 1 : 1/2", {1, 1, 0.5});
  addBox("box 1 : 1 : 1/20", {1, 1, 0.05});
  addBox("box 1 : 1/20 : 1/20", {1, 0.05, 0.05});
  const auto addSolid = [&](const std::string& name, const TriangleMesh& mesh,
                            const TriangleMesh& coarse) {
    add(name, mesh, [coarse] {
      const auto divided = [&](int faces) {
        const double n = std::sqrt(faces / static_cast<double>(coarse.triangleCount()));
        return gradedTowardsEdges(coarse, static_cast<int>(n));
      };
      return extrapolate(divided(kCoarseReference), divided(kFineReference), false, kFlatOrder);
    });
  };
  addSolid("tetrahedron", test::gradedTetrahedron(1), test::gradedTetrahedron(1));
  addSolid("octahedron", makeOctahedron(), makeOctahedron());
  addSolid("dodecahedron", makeDodecahedron(), makeCentredDodecahedron());
  addSolid("icosahedron", makeIcosahedron(), makeIcosahedron());
}

void addSheets(std::vector<AccuracyCase>& cases) {
  const auto add = [&](const std::string& name, const TriangleMesh& mesh,
                       const reference::SheetAddedMass& exact) {
    cases.push_back({name, Target::kSheet, Symmetry::kFlatSheet, mesh, known(exact)});
  };
  add("disc", meshOf(EllipseSheet{{1, 1}}), reference::diskAddedMass(1));
  add("elliptic disc 2 : 1", meshOf(EllipseSheet{{2, 1}}), reference::ellipticDisk21AddedMass());
  for (const int length : {1, 2, 4})
    add("rectangular sheet " + std::to_string(length) + " : 1",
        meshOf(RectangleSheet{{static_cast<double>(length), 1.0}}),
        reference::rectangleAddedMass(length));
}

}  // namespace

std::vector<AccuracyCase> accuracyCases() {
  std::vector<AccuracyCase> cases;
  addSmoothBodies(cases);
  addRoundSharpBodies(cases);
  addFlatSidedBodies(cases);
  addSheets(cases);
  return cases;
}

}  // namespace ambient::study
