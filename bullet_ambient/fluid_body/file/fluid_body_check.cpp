#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>

#include "bullet_ambient/base/elementary.h"
#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/base/plain_text.h"
#include "bullet_ambient/fluid_body/body_parts.h"
#include "bullet_ambient/fluid_body/file/fluid_body_file.h"
#include "bullet_ambient/fluid_body/octahedral_lattice.h"
#include "bullet_ambient/fluid_body/packed/packed_shape.h"
#include "bullet_ambient/spatial/symmetric_eigen.h"

namespace ambient {
namespace {

// Tolerance for conditions that hold exactly but for the rounding of some thousand operations.
constexpr double kRounding = 1e-9;

// Rounding error of the volume inside triangles far from the origin, relative to it.
constexpr double kHoldRounding = 1e-6;

// Largest distance from the origin in sizes of the body: the preprocessor's own limit. Beyond,
// rounding of the coordinates would exceed the details of the shape.
constexpr double kFarthest = 1e12;

class Checker {
 public:
  explicit Checker(std::string source) : source_(std::move(source)) {}

  template <class... Parts>
  [[noreturn]] void fail(const Parts&... parts) const {
    std::ostringstream message;
    message.precision(9);
    message << source_ << ": ";
    (message << ... << parts);
    throw std::runtime_error(plainLine(message.str()));
  }

  void finite(double value, const char* what) const {
    if (!std::isfinite(value)) fail(what, " is ", value, ", but must be finite");
  }

  void notNegative(double value, const char* what) const {
    finite(value, what);
    if (value < 0) fail(what, " is ", value, ", but must not be negative");
  }

  void share(double value, const char* what) const {
    if (!(value >= 0) || !(value <= 1 + kRounding))
      fail(what, " is ", value, ", but must be between 0 and 1");
  }

  /// Fails if a number exceeds what a body can have, but for the errors of panels.
  void atMost(double value, double limit, const char* what, const char* limit_of) const {
    constexpr double kErrors = 1.02;
    if (!(value <= kErrors * limit))
      fail(what, " is ", value, ", but must be at most ", limit, ", ", limit_of);
  }

  /// Fails if a point is farther from the origin than kFarthest sizes; size 0: no check.
  void near(const Vector3& point, double size, const char* what) const {
    const double distance = point.stableNorm();
    if (size > 0 && !(distance / size <= kFarthest))
      fail(what, " lies ", distance, " m from the origin, limit ", kFarthest,
           " times the size of the body of ", size, " m");
  }

  template <class Matrix>
  void finiteMatrix(const Matrix& matrix, const char* what) const {
    for (Eigen::Index i = 0; i < matrix.size(); ++i) finite(matrix.data()[i], what);
  }

  void finiteColumn(const std::vector<double>& column, const char* what) const {
    for (std::size_t i = 0; i < column.size(); ++i)
      if (!std::isfinite(column[i]))
        fail(what, " of entry ", i, " is ", column[i], ", but must be finite");
  }

  /// Fails unless the matrix is symmetric and positive semi-definite up to rounding.
  /// @pre all entries are finite and of one unit.
  template <class Matrix>
  void positiveSemiDefinite(const Matrix& matrix, const char* what) const {
    const double largest = matrix.cwiseAbs().maxCoeff();
    if (largest == 0) return;
    using Aligned = Eigen::Matrix<double, Matrix::RowsAtCompileTime, Matrix::ColsAtCompileTime>;
    const Aligned scaled = matrix / largest;
    const double asymmetry = (scaled - scaled.transpose()).cwiseAbs().maxCoeff();
    if (!(asymmetry <= kRounding))
      fail(what, " is not symmetric: off by ", asymmetry, " of its largest entry, limit ",
           kRounding);
    const double lowest = symmetricEigen(scaled).values[0];
    if (!(lowest >= -kRounding))
      fail(what, " is not positive semi-definite: lowest eigenvalue ", lowest,
           " of its largest entry, limit ", -kRounding);
  }

 private:
  std::string source_;
};

/// Checks a matrix of rotations and translations, which is symmetric and positive semi-definite.
void checkMotionMatrix(const Matrix6& matrix, const Checker& check, const char* what) {
  check.finiteMatrix(matrix, what);
  // With the body's size as unit of length all entries have one unit and one tolerance.
  const double translation = matrix.diagonal().tail<3>().cwiseAbs().maxCoeff();
  const double rotation = matrix.diagonal().head<3>().cwiseAbs().maxCoeff();
  const double length = rotation > 0 && translation > 0 ? std::sqrt(rotation / translation) : 1;
  Vector6 units;
  units << Vector3::Constant(1 / length), Vector3::Ones();
  const Matrix6 scaled = units.asDiagonal() * matrix * units.asDiagonal();
  check.finiteMatrix(scaled, (std::string(what) + " over its own length scale").c_str());
  check.positiveSemiDefinite(scaled, what);
}

void checkMassDistribution(const MassDistribution& mass, const Checker& check, const char* centre,
                           const char* inertia) {
  check.finiteMatrix(mass.centre, centre);
  check.finiteMatrix(mass.inertia, inertia);
  check.positiveSemiDefinite(mass.inertia, inertia);
}

/// Characteristic length of the body [m]: the larger of sqrt(area) and cbrt(volume).
double sizeOf(const FluidBody& body) {
  return std::max(std::sqrt(body.area), portable::cbrt(body.volume));
}

void checkPlaces(const FluidBody& body, const Checker& check) {
  const double size = sizeOf(body);
  check.near(body.centre_of_volume, size, "centre of volume");
  check.near(body.uniform_mass.centre, size, "centre of uniform mass");
  check.near(body.surface_mass.centre, size, "centre of surface mass");
  for (std::size_t i = 0; i < body.faces.size(); ++i)
    check.near(body.faces.centroid(i), size, "centroid of a face");
  for (std::size_t i = 0; i < body.form.faces.size(); ++i)
    check.near(body.form.faces.centroid(i), size, "centroid of a face of the form law");
}

void checkFaces(const FaceTable& faces, const Checker& check) {
  constexpr std::array kNames{"face normal x",   "face normal y",   "face normal z",
                              "face centroid x", "face centroid y", "face centroid z",
                              "face area"};
  const std::size_t count = faces.size();
  for (std::size_t k = 0; k < kNames.size(); ++k) {
    const std::vector<double>& column = *faces.columns()[k];
    if (column.size() != count)
      check.fail(kNames[k], " has ", column.size(), " entries, but there are ", count,
                 " face areas");
    check.finiteColumn(column, kNames[k]);
  }
  if (!faces.sharpness.empty() && faces.sharpness.size() != count)
    check.fail("face sharpness has ", faces.sharpness.size(), " entries, but there are ", count,
               " face areas");
  for (std::size_t i = 0; i < faces.sharpness.size(); ++i)
    if (!(faces.sharpness[i] >= 0) || !(faces.sharpness[i] <= 2))
      check.fail("sharpness of face ", i, " is ", faces.sharpness[i],
                 ", but must be between 0 and 2");
  for (std::size_t i = 0; i < count; ++i) {
    if (faces.area[i] < 0)
      check.fail("area of face ", i, " is ", faces.area[i], " m^2, but must not be negative");
    const double length = faces.normal(i).norm();
    if (!(std::abs(length - 1) <= kRounding))
      check.fail("normal of face ", i, " has length ", length, ", but must be 1 within ",
                 kRounding);
  }
}

/// Fails unless the entries are vertices of the surface, three for each triangle.
void checkTriangles(const std::vector<std::int32_t>& triangles, const Surface& surface,
                    const char* what, const Checker& check) {
  if (triangles.size() % 3 != 0)
    check.fail("there are ", triangles.size(), " ", what,
               " indices, but their number must be a multiple of 3");
  const std::size_t vertex_count = surface.vertices.size() / 3;
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    const std::int32_t index = triangles[i];
    if (index < 0 || static_cast<std::size_t>(index) >= vertex_count)
      check.fail(what, " ", i / 3, " refers to vertex ", index, ", but there are ", vertex_count,
                 " vertices");
  }
}

void checkSurface(const Surface& surface, const Checker& check) {
  check.finiteColumn(surface.vertices, "vertex coordinate");
  if (surface.vertices.size() % 3 != 0)
    check.fail("there are ", surface.vertices.size(),
               " vertex coordinates, but their number must be a multiple of 3");
  checkTriangles(surface.triangles, surface, "triangle", check);
}

/// Volume inside triangles, by tetrahedra from a point [m^3].
double volumeInside(const Surface& surface, const Vector3& from) {
  const auto corner = [&](std::size_t i) -> Vector3 {
    return vertexOf(surface, surface.triangles[i]) - from;
  };
  double volume = 0;
  for (std::size_t i = 0; i < surface.triangles.size(); i += 3)
    volume += corner(i).dot(corner(i + 1).cross(corner(i + 2))) / 6;
  return volume;
}

void checkFormShape(const FormShape& shape, const Checker& check) {
  constexpr double kLongest = 1 + kRounding;  // of directions and of lengths of at most 1
  for (const double* number : shape.numbers()) check.finite(*number, "a number of the form");
  for (const double share : {shape.wing, shape.edges}) check.share(share, "a share of the form");
  if (!(shape.aspect >= 1 - kRounding))
    check.fail("aspect of the form is ", shape.aspect, ", but must be at least 1");
  check.notNegative(shape.chord, "chord of the form");
  for (const Vector3& axis : {shape.facing, shape.span, shape.slender, shape.pitching})
    if (!(axis.stableNorm() <= kLongest))
      check.fail("an axis of the form has length ", axis.stableNorm(), ", but must be at most 1");
}

/// Checks the form for what loads and hydrostatics rely on, of a body that is prepared.
void checkForm(const FluidBody& body, const Checker& check) {
  checkFormShape(body.form.shape, check);
  checkFaces(body.form.faces, check);
  if (body.form.faces.sharpness.size() != body.form.faces.size())
    check.fail("the faces of the form law have no sharpness");
  checkTriangles(body.form.hull, body.surface, "hull triangle", check);
}

/// Fails unless there is a label for each of `count` things, that of an existing part.
void checkLabels(const std::vector<std::uint8_t>& labels, std::size_t count, std::size_t wings,
                 const char* what, const Checker& check) {
  if (labels.size() != count)
    check.fail("there are parts of ", labels.size(), " ", what, ", but ", count, " ", what);
  for (const std::uint8_t label : labels)
    if (label > wings)
      check.fail("a part has number ", int{label}, ", but there are ", wings, " wings");
}

void checkWing(const Wing& wing, double size, const Checker& check) {
  for (const double* number : wing.numbers()) check.finite(*number, "a number of a wing");
  check.near(wing.centre, size, "centre of a wing");
  const double off =
      std::max({std::abs(wing.facing.norm() - 1), std::abs(wing.span_axis.norm() - 1),
                std::abs(wing.facing.dot(wing.span_axis))});
  if (!(off <= kRounding))
    check.fail("the axes of a wing are off orthonormal by ", off, ", limit ", kRounding);
  for (const double length : {wing.span, wing.chord})
    if (!(length > 0) || !(length <= kFarthest * size))
      check.fail("span or chord of a wing is ", length, " m, but must be above 0 and at most ",
                 kFarthest, " times the size of the body of ", size, " m");
  if (!(wing.thickness >= 0) || !(wing.thickness <= kFarthest * size))
    check.fail("thickness of a wing is ", wing.thickness, " m");
  if (!(wing.aspect >= 1 / kFarthest) || !(wing.aspect <= kFarthest))
    check.fail("aspect ratio of a wing is ", wing.aspect, ", but must be 1e-12 to 1e12");
  if (!(wing.body_lift >= 1) || !(wing.body_lift <= 2))
    check.fail("body lift of a wing is ", wing.body_lift, ", but must be 1 to 2");
  if (!(std::abs(wing.camber) <= kMostCamber))
    check.fail("camber of a wing is ", wing.camber, ", but must be from ", -kMostCamber, " to ",
               kMostCamber);
  if (wing.nose != 0 && std::abs(wing.nose) != 1 && wing.nose != kRoundAtBothEnds)
    check.fail("nose of a wing is ", wing.nose, ", but must be -1, 0, 1 or 2");
}

/// Checks that each face is a side of a triangle of the surface, whose part is its own.
void checkWingedSurface(const FluidBody& body, const Checker& check) {
  if (body.wings.empty()) return;
  if (body.sphere_radius > 0) check.fail("a sphere has wings");
  const std::size_t triangles = body.surface.triangles.size() / 3, faces = body.faces.size();
  const bool fits =
      faces == triangles || faces == 2 * triangles || (faces == 0 && body.omits_faces);
  if (triangles == 0 || !fits)
    check.fail("a body with wings has ", triangles, " triangles and ", faces,
               " faces, but must have one or two faces a triangle");
}

void checkWings(const FluidBody& body, double size, const Checker& check) {
  const std::size_t wings = body.wings.size();
  if (wings > kMostWings) check.fail("there are ", wings, " wings, but at most ", kMostWings);
  for (const Wing& wing : body.wings) checkWing(wing, size, check);
  const auto labelled = [wings](std::size_t count) { return wings > 0 ? count : 0; };
  checkLabels(body.part_of_triangle, labelled(body.surface.triangles.size() / 3), wings,
              "triangles", check);
  checkWingedSurface(body, check);
  if (body.form.faces.size() == 0 && body.form.part_of_face.empty()) return;
  checkLabels(body.form.part_of_face, labelled(body.form.faces.size()), wings,
              "faces of the form law", check);
  checkFormShape(body.form.rest, check);
  if (body.form.wing_shares.size() != wings)
    check.fail("there are ", body.form.wing_shares.size(), " shares of wings, but ", wings,
               " wings");
  for (const double share : body.form.wing_shares) check.share(share, "a share of a wing");
}

/// Checks that a body has no more resistance than a ball that holds it (Hill and Power 1956), its
/// centre of reaction and its sizes within, and layers of a flow that may be along a surface, also
/// at the edges of fine meshes.
void checkViscousLimits(const FluidBody& body, const Checker& check) {
  const ViscousForm& form = body.viscous;
  const Eigen::Map<const Eigen::Matrix3Xd> vertices(
      body.surface.vertices.data(), 3, static_cast<Eigen::Index>(body.surface.vertices.size() / 3));
  const Vector3 middle = (vertices.rowwise().minCoeff() + vertices.rowwise().maxCoeff()) / 2;
  const double radius = (vertices.colwise() - middle).colwise().norm().maxCoeff();
  const double reach = vertices.colwise().norm().maxCoeff();
  const auto largest = [](const Matrix3& block) { return symmetricEigen<3>(block).values[2]; };
  const Matrix6& R = form.resistance;
  check.atMost(largest(R.bottomRightCorner<3, 3>()), 6 * kPi * radius,
               "resistance to translation [m]", "that of the ball around the body");
  check.atMost(largest(R.topLeftCorner<3, 3>()), 8 * kPi * reach * reach * reach,
               "resistance to rotation [m^3]", "that of the ball around its origin that holds it");
  check.atMost((form.centre_of_reaction - middle).norm(), radius,
               "distance of the centre of reaction from the middle of the body [m]",
               "the radius of the ball around it");
  const SurfaceNumbers& surface = form.surface;
  check.atMost(surface.diameter, std::sqrt(2 * body.area / kPi),
               "diameter of the ball with the area of the surface [m]", "that of twice the area");
  check.atMost(surface.frontal.maxCoeff(), body.area / 2, "a frontal area [m^2]",
               "half of the area");
  const double farthest = 4 * radius * radius;
  check.atMost(surface.moments.maxCoeff(), farthest, "a mean square of the surface [m^2]",
               "that of the farthest points of the body");
  check.atMost(surface.gyration.trace(), 2 * farthest, "trace of the gyration of the surface [m^2]",
               "that of the farthest points of the body");
  constexpr double kFastest = 100;  // over the body's speed
  const double thickest = 2 * std::sqrt(2 * radius / surface.diameter);
  for (std::size_t i = 0; i < form.separation.ways.size(); ++i) {
    const SeparationWay& way = form.separation.ways[i];
    for (const double wake :
         {way.wake_laminar, way.wake_bubble, way.wake_turbulent, way.wake_rough})
      check.atMost(wake, kFastest * kFastest, "wake of a separation",
                   "the square of the fastest flow's speed over the body's");
    check.atMost(way.thickness, thickest, "thickness of a separation",
                 "three times that of a plate as long as the body");
    for (const double friction :
         {way.friction_laminar, way.friction_bubble, way.friction_turbulent})
      check.atMost(friction * surface.frontal[static_cast<Eigen::Index>(i / 2)],
                   kFastest * body.area, "friction of a separation on its frontal area [m^2]",
                   "that of the fastest flow");
  }
}

void checkViscousForm(const FluidBody& body, const Checker& check) {
  const ViscousForm& form = body.viscous;
  checkMotionMatrix(form.resistance, check, "resistance in creeping flow");
  for (const double* number : form.numbers()) check.finite(*number, "a number of the viscous form");
  const Separation& separation = form.separation;
  const double turn =
      (separation.axes.transpose() * separation.axes - Matrix3::Identity()).cwiseAbs().maxCoeff();
  if (!(turn <= kRounding))
    check.fail("the axes of separation are off orthonormal by ", turn, ", limit ", kRounding);
  for (const SeparationWay& way : separation.ways) {
    for (const double wake :
         {way.wake_laminar, way.wake_bubble, way.wake_turbulent, way.wake_rough})
      check.notNegative(wake, "wake of a separation");
    check.notNegative(way.thickness, "thickness of a separation");
    for (const double friction :
         {way.friction_laminar, way.friction_bubble, way.friction_turbulent})
      check.notNegative(friction, "friction of a separation");
  }
  for (const double base : separation.smooth_base) check.share(base, "smooth share of a base");
  check.share(form.sharp_share, "sharp share");
  for (const double area : form.surface.frontal) check.notNegative(area, "a frontal area");
  for (const double moment : form.surface.moments)
    check.notNegative(moment, "a mean square of the surface");
  check.positiveSemiDefinite(form.surface.gyration, "gyration of the surface");
  if (form.isKnown() && !(form.surface.diameter > 0))
    check.fail("diameter of the ball with the area of the surface is ", form.surface.diameter,
               " m, but must be above 0 where the resistance is known");
  if (!form.isKnown()) return;
  if (body.surface.vertices.empty())
    check.near(form.centre_of_reaction, sizeOf(body), "centre of reaction");
  else
    checkViscousLimits(body, check);
}

void checkFormLevel(const FormLevel& level, const Checker& check) {
  checkFaces(level.faces, check);
  if (level.faces.sharpness.size() != level.faces.size())
    check.fail("a level of the form law has no sharpness");
  check.notNegative(level.p99_error, "error of a level");
}

void checkPart(const AddedMassPart& part, double size, const Checker& check) {
  check.finiteMatrix(part.centre, "centre of a part of the added mass");
  check.near(part.centre, size, "centre of a part of the added mass");
  check.finiteMatrix(part.spread, "spread of a part of the added mass");
  check.finiteMatrix(part.inertia, "a part of the added mass");
}

void checkWaterline(const FluidBody& body, const Checker& check) {
  const WaterlineTable& table = body.waterline;
  constexpr int kMostSubdivisions = 64;
  if (table.subdivisions < 0 || table.subdivisions > kMostSubdivisions)
    check.fail("the waterline table has ", table.subdivisions, " subdivisions, but must have 0 to ",
               kMostSubdivisions);
  double last = 0;
  for (const double immersion : table.immersions) {
    if (!(immersion > last) || !(immersion < WaterlineTable::kDeep))
      check.fail("immersion ", immersion, " of the waterline table must be above ", last,
                 " and below ", WaterlineTable::kDeep);
    last = immersion;
  }
  const std::size_t needed =
      table.empty() ? 0 : OctahedralLattice(table.subdivisions).size() * table.immersions.size();
  if (table.corrections.size() != needed)
    check.fail("the waterline table has ", table.corrections.size(), " corrections, but needs ",
               needed);
  if (needed > 0 && body.added_mass_parts.empty())
    check.fail("the waterline table has nothing to correct: there are no parts of the added mass");
  for (const Matrix6& correction : table.corrections)
    check.finiteMatrix(correction, "a correction of the waterline table");
}

/// Fails unless a hold is a closed room: its area vectors and triangles say so.
void checkHold(const Hold& hold, std::size_t holds, const FluidBody& body, const Checker& check) {
  checkSurface(hold.surface, check);
  check.finiteMatrix(hold.centre, "centre of a hold");
  check.near(hold.centre, sizeOf(body), "centre of a hold");
  check.finiteMatrix(hold.turning_inertia, "turning inertia of a hold");
  check.positiveSemiDefinite(hold.turning_inertia, "turning inertia of a hold");
  check.finite(hold.volume, "volume of a hold");
  if (!(hold.volume > 0)) check.fail("volume of a hold is ", hold.volume, ", but must be positive");
  const double inside = volumeInside(hold.surface, hold.centre);
  if (!(std::abs(inside - hold.volume) <= kHoldRounding * hold.volume))
    check.fail("the triangles of a hold enclose ", inside, " m^3, but its volume is ", hold.volume);
  for (const HoldOpening& opening : hold.openings) {
    checkSurface({opening.outline, opening.lid}, check);
    if (opening.outline.size() < 9 || opening.lid.empty())
      check.fail("an opening of a hold has ", opening.outline.size() / 3, " corners and ",
                 opening.lid.size() / 3, " triangles, but must have at least 3 and 1");
    if (opening.to < -1 || opening.to >= static_cast<std::int64_t>(holds))
      check.fail("an opening leads to hold ", opening.to, ", but there are ", holds);
  }
}

void checkHolds(const FluidBody& body, const Checker& check) {
  double sum = 0;
  for (const Hold& hold : body.holds) {
    checkHold(hold, body.holds.size(), body, check);
    sum += hold.volume;
  }
  if (!(sum <= body.volume))
    check.fail("the holds have ", sum, " m^3, but the whole body has ", body.volume);
}

}  // namespace

void checkFluidBody(const FluidBody& body, const std::string& source) {
  const Checker check(source);
  check.notNegative(body.asymmetry, "asymmetry");
  check.notNegative(body.volume, "volume");
  check.notNegative(body.area, "area");
  check.notNegative(body.sphere_radius, "radius of the sphere");
  for (const double drag : body.drag) {
    check.notNegative(drag, "measured drag coefficient");
    if (drag > kLargestDrag)
      check.fail("measured drag coefficient is ", drag, ", but must be at most ", kLargestDrag);
  }
  if (!body.drag.isZero(0) && body.drag.minCoeff() == 0)
    check.fail("a measured drag coefficient is 0, but must be positive where another one is given");
  check.finiteMatrix(body.centre_of_volume, "centre of volume");
  check.finiteMatrix(body.origin, "origin");
  checkMotionMatrix(body.added_mass, check, "added mass");
  checkMassDistribution(body.uniform_mass, check, "centre of uniform mass",
                        "inertia of uniform mass");
  checkMassDistribution(body.surface_mass, check, "centre of surface mass",
                        "inertia of surface mass");
  checkFaces(body.faces, check);
  checkSurface(body.surface, check);
  checkForm(body, check);
  checkViscousForm(body, check);
  for (const FormLevel& level : body.form_levels) checkFormLevel(level, check);
  for (const AddedMassPart& part : body.added_mass_parts.all())
    checkPart(part, sizeOf(body), check);
  checkWaterline(body, check);
  checkHolds(body, check);
  checkWings(body, sizeOf(body), check);
  checkPlaces(body, check);
}

}  // namespace ambient
