#pragma once

#include <Eigen/Geometry>
#include <sstream>
#include <string>
#include <vector>

#include "preprocess/builder/shape_builder.h"
#include "preprocess/mesh/shapes/primitives.h"
#include "tests/support/temporary_folder.h"

namespace ambient::test {

/// A part of an OBJ file.
struct Named {
  std::string name;
  TriangleMesh mesh;
};

inline TriangleMesh placed(TriangleMesh mesh, const Matrix3& rotation,
                           const Eigen::Vector3d& place) {
  mesh.vertices = (rotation * mesh.vertices).colwise() + place;
  return mesh;
}

inline TriangleMesh box(const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
  return placed(makeBoxMesh((high - low) / 2, 12), Matrix3::Identity(), (low + high) / 2);
}

inline Matrix3 turnAbout(const Eigen::Vector3d& axis, double angle) {
  return Eigen::AngleAxisd(angle, axis.normalized()).toRotationMatrix();
}

inline std::string objOf(const std::vector<Named>& parts) {
  std::ostringstream text;
  text.precision(9);
  Eigen::Index first = 1;
  for (const Named& part : parts) {
    text << "o " << part.name << "\n";
    for (Eigen::Index v = 0; v < part.mesh.vertexCount(); ++v)
      text << "v " << part.mesh.vertices.col(v).transpose() << "\n";
    for (Eigen::Index t = 0; t < part.mesh.triangleCount(); ++t)
      text << "f " << (part.mesh.triangles.col(t).array() + static_cast<int>(first)).transpose()
           << "\n";
    first += part.mesh.vertexCount();
  }
  return text.str();
}

/// Builds a mesh file of these parts with few panels.
inline FluidBody built(const std::vector<Named>& parts, const std::string& wings,
                       int least_faces = 0) {
  const TemporaryFolder folder;
  writeText(folder / "body.obj", objOf(parts));
  ShapeDescription shape;
  shape.geometry = MeshFile{folder / "body.obj"};
  shape.source = "body.obj";
  ShapeBuildSettings settings;
  settings.name = "body";
  settings.origin = Eigen::Vector3d::Zero();
  settings.flow.max_panels = 1500;
  settings.least_faces = least_faces;
  settings.wings = wings;
  return buildShape(shape, settings).body;
}

/// An aeroplane of flat plates, whose lift and moments follow by hand, with a thin hull. The wing's
/// quarter chord is at x = 0, z = 0.
struct PlateAeroplane {
  double chord = 0.15, span = 1.2;           ///< of the wing [m]
  double tail_chord = 0.1, tail_span = 0.4;  ///< [m]
  double tail_arm = 0.54, tail_tilt = 0.05;  ///< between the quarter chords [m]; nose down [rad]

  std::vector<Named> parts() const {
    constexpr double kHalf = 0.0015;  // of the thickness of the plates [m]
    const TriangleMesh wing = box({-0.75 * chord, -span / 2, -kHalf}, {chord / 4, span / 2, kHalf});
    const TriangleMesh tail =
        box({-0.75 * tail_chord, -tail_span / 2, -kHalf}, {tail_chord / 4, tail_span / 2, kHalf});
    const double end = -tail_arm - 0.75 * tail_chord;
    return {
        {"wing", wing},
        {"tail", placed(tail, turnAbout(Eigen::Vector3d::UnitY(), tail_tilt), {-tail_arm, 0, 0})},
        {"fin", box({end, -kHalf, 0}, {end + tail_chord, kHalf, 0.15})},
        {"hull", box({end - 0.02, -0.008, -0.008}, {0.3, 0.008, 0.008})}};
  }
};

}  // namespace ambient::test
