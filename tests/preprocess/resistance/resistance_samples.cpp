// Prints the samples that tables of simple shapes are fitted to by resistance_tables.py: kind and
// sizes [m], and after a colon R, or the numbers of separation.

#include <cmath>
#include <cstdio>
#include <initializer_list>

#include "bullet_ambient/base/pi.h"
#include "preprocess/mesh/mass_properties.h"
#include "preprocess/mesh/shapes/primitives.h"
#include "preprocess/mesh/triangle_mesh.h"
#include "preprocess/potential_flow/results/potential_flow.h"
#include "preprocess/resistance/separation.h"
#include "preprocess/resistance/stokes_resistance.h"

namespace ambient {
namespace {

constexpr double kRatio = 100;          // kLargestRatio of table_places.h
constexpr double kEllipsoidRatio = 20;  // layers of longer ones need finer meshes
constexpr double kCapsuleRatio = 10;
constexpr int kNodes = 12;

void print(std::initializer_list<double> numbers) {
  for (const double number : numbers) std::printf(" %.7g", number);
}

void print(const SeparationWay& way) {
  print({way.wake_laminar, way.wake_bubble, way.wake_turbulent, way.wake_rough, way.thickness,
         way.friction_laminar, way.friction_bubble, way.friction_turbulent});
}

void end() {
  std::printf("\n");
  std::fflush(stdout);
}

Matrix6 resistanceOf(const TriangleMesh& mesh) {
  StokesSettings settings;
  settings.panels = 900;
  return computeStokesResistance(mesh, settings);
}

/// Entries of a body of revolution about z: v_z, v_x, w_z, w_y and [w_y, v_x].
void printRound(const char* kind, double height, const TriangleMesh& mesh) {
  const Matrix6 R = resistanceOf(mesh);
  std::printf("%s 1 %.9g:", kind, height);
  print({R(5, 5), R(3, 3), R(2, 2), R(1, 1), R(1, 3)});
}

TriangleMesh withVolumeAcross(TriangleMesh mesh, double volume) {
  mesh.vertices.topRows<2>() *= std::sqrt(volume / computeMassProperties(mesh).volume);
  return mesh;
}

void printRoundBodies() {
  constexpr int kFaces = 1200;
  for (int i = 0; i <= kNodes; ++i) {
    const double x = -std::cos(kPi * i / kNodes), height = 2 * std::pow(kRatio, x);
    const double tall = 2 * (std::pow(1 + kRatio, (1 + x) / 2) - 1);
    printRound("cylinder", height,
               withVolumeAcross(makeCylinderMesh(1, height, kFaces), kPi * height));
    end();
    printRound("cone", height, withVolumeAcross(makeConeMesh(1, height, kFaces), kPi * height / 3));
    end();
    const TriangleMesh capsule =
        i == 0 ? makeEllipsoidMesh({1, 1, 1}, kFaces) : makeCapsuleMesh(1, tall, kFaces);
    printRound("capsule", tall, withVolume(capsule, kPi * (tall + 4.0 / 3)));
    end();
  }
}

/// Along z and across.
void printCapsuleLayers() {
  constexpr int kFaces = 6000, kSteps = 8;
  for (int i = 0; i <= kSteps; ++i) {
    const double height = 2 * (std::pow(1 + kCapsuleRatio, 1.0 * i / kSteps) - 1);
    const TriangleMesh mesh =
        i == 0 ? makeEllipsoidMesh({1, 1, 1}, kFaces) : makeCapsuleMesh(1, height, kFaces);
    Matrix3 axes;
    axes << 0, 1, 0, 0, 0, 1, 1, 0, 0;
    const Separation separation =
        computeSeparation(mesh, solvePotentialFlow(mesh).potential.rightCols<3>(), axes).separation;
    std::printf("layers 1 %.9g:", height);
    print(separation.ways[0]);
    print(separation.ways[2]);
    end();
  }
}

void printEllipsoid(const Vector3& semi_axes) {
  const Separation separation = ellipsoidSeparation(semi_axes, 8000);
  std::printf("ellipsoid %.9g %.9g %.9g:", semi_axes.x(), semi_axes.y(), semi_axes.z());
  for (int axis = 0; axis < 3; ++axis)  // in the order of the semi-axes
    for (std::size_t j = 0; j < 3; ++j)
      if (std::abs(separation.axes(axis, static_cast<int>(j))) > 0.5) print(separation.ways[2 * j]);
  end();
}

void printBox(const Vector3& half_sizes) {
  const Vector6 R = resistanceOf(makeBoxMesh(half_sizes, 12)).diagonal();
  std::printf("box %.9g %.9g %.9g:", half_sizes.x(), half_sizes.y(), half_sizes.z());
  print({R[0], R[1], R[2], R[3], R[4], R[5]});
  end();
}

/// Bodies of three unequal sizes, longest first, the shortest 1.
template <class Print>
void printThreeSized(int rings, double most, const Print& print_one) {
  for (int ring = 0; ring <= rings; ++ring) {
    const double longest = std::pow(most, std::sin(kPi / 2 * ring / rings));
    const int count = (ring + 1) / 2;
    for (int k = 0; k <= count; ++k)
      print_one(Vector3(
          longest, count == 0 ? 1 : std::pow(longest, (1 - std::cos(kPi * k / count)) / 2), 1));
  }
}

}  // namespace
}  // namespace ambient

int main() {
  ambient::printThreeSized(10, ambient::kEllipsoidRatio, ambient::printEllipsoid);
  ambient::printCapsuleLayers();
  ambient::printRoundBodies();
  ambient::printThreeSized(8, ambient::kRatio, ambient::printBox);
}
