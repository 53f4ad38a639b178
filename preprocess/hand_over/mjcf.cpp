#include <algorithm>
#include <array>
#include <cmath>

#include "bullet_ambient/base/elementary.h"
#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/spatial/cholesky.h"
#include "bullet_ambient/spatial/inertia.h"
#include "bullet_ambient/spatial/symmetric_eigen.h"
#include "preprocess/hand_over/handed_body.h"
#include "preprocess/polar/polar.h"
#include "preprocess/potential_flow/results/ellipsoid_added_mass.h"

namespace ambient {
namespace {

// Inertias of the body and of MuJoCo's ellipsoid, in the frame of the ellipsoid [kg m^2, kg].
struct TwoAddedMasses {
  Matrix6 body, ellipsoid;
  Matrix6 own;  // of the mass alone
};

std::string cell(const std::string& text, std::size_t width) {
  return std::string(width - std::min(width, text.size()), ' ') + text;
}

std::string percent(double share) { return fixedText(100 * share, 2) + " %"; }

// Rows of six pairs of numbers and their differences, relative to the larger of the two. Numbers
// below `rounding` count as 0. Translation first.
std::string comparison(const Vector6& body, const Vector6& ellipsoid, const Vector6& rounding) {
  std::string text = "      " + cell("body", 12) + cell("MuJoCo", 12) + cell("error", 12) + "\n";
  for (const int i : {3, 4, 5, 0, 1, 2}) {
    const double scale = std::max(std::abs(body[i]), std::abs(ellipsoid[i]));
    const double error = scale <= rounding[i] ? 0 : (ellipsoid[i] - body[i]) / scale;
    text += (i < 3 ? "  about " : "  along ") + std::string(1, "xyzxyz"[i]) +
            cell(roundedText(body[i]), 10) + cell(roundedText(ellipsoid[i]), 12) +
            cell(percent(error), 12) + "\n";
  }
  return text;
}

// Largest entry off the diagonal, relative to the root of the two on the diagonals of all inertia.
double largestLost(const TwoAddedMasses& of) {
  const Vector6 scale = (of.body + of.own).diagonal().cwiseSqrt();
  double largest = 0;
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < i; ++j)
      largest = std::max(largest, std::abs(of.body(i, j)) / (scale[i] * scale[j]));
  return largest;
}

// Largest difference of the kinetic energy by `change` of the inertia, over all motions, relative
// to that of body and fluid.
double largestShare(const Matrix6& change, const TwoAddedMasses& of) {
  const Matrix6 root = Cholesky<6>(of.body + of.own).inverseTransposed();
  const Matrix6 reduced = root.transpose() * change * root;
  return symmetricEigen<6>(0.5 * (reduced + reduced.transpose())).values.cwiseAbs().maxCoeff();
}

std::string addedMassReport(const TwoAddedMasses& of) {
  constexpr double kRounding = 1e-9;
  return "added mass along its axes [kg] and about them [kg m^2]\n" +
         comparison(of.body.diagonal(), of.ellipsoid.diagonal(), kRounding * of.own.diagonal()) +
         "largest entry off the diagonal, which MuJoCo has not: " + percent(largestLost(of)) +
         "\nerror of the kinetic energy of body and fluid, at most: " +
         percent(largestShare(of.ellipsoid - of.body, of)) +
         "\nMuJoCo has the added mass in products of velocities only. Accelerations do not feel "
         "it:\nmissing of the inertia of body and fluid, at most: " +
         percent(largestShare(of.body, of)) + "\n";
}

std::string sizesText(const Vector3& semi_axes) {
  return roundedText(semi_axes[0]) + ", " + roundedText(semi_axes[1]) + ", " +
         roundedText(semi_axes[2]) + " m";
}

// MuJoCo wants no moment above the sum of the two others, which those of a sheet are to rounding.
Matrix3 acceptedInertia(const HandedBody& body) {
  constexpr double kRounding = 1e-9;
  if (body.shape->volume > 0) return body.inertia;
  return body.inertia + kRounding * body.inertia.trace() * Matrix3::Identity();
}

std::string inertialElement(const HandedBody& body) {
  const Matrix3 inertia = acceptedInertia(body);
  Vector6 full;
  full << inertia.diagonal(), inertia(0, 1), inertia(0, 2), inertia(1, 2);
  return "<inertial pos=\"" + rowText(body.weight.centre) + "\" mass=\"" +
         numberText(body.weight.mass) + "\" fullinertia=\"" + rowText(full) + "\"/>";
}

std::string geomElement(const EllipsoidFit& fit, const EllipsoidDrag& drag) {
  const Quaternion q(fit.axes);
  const Eigen::Vector4d wxyz(q.w(), q.x(), q.y(), q.z());
  const Vector3 coefficients(drag.blunt, drag.slender, drag.angular);
  return "<geom type=\"ellipsoid\" size=\"" + rowText(fit.semi_axes) + "\" pos=\"" +
         rowText(fit.centre) + "\" quat=\"" + rowText(wxyz) +
         "\" fluidshape=\"ellipsoid\" fluidcoef=\"" + rowText(coefficients) + " 1 1\"/>";
}

std::string optionElement(const HandedBody& body) {
  const Medium& medium = body.settings.medium;
  return "<option integrator=\"implicit\" gravity=\"" +
         rowText(Vector3(-body.settings.gravity * body.settings.up)) + "\" density=\"" +
         numberText(medium.density) + "\" viscosity=\"" + numberText(medium.viscosity) + "\"/>";
}

TwoAddedMasses addedMassesOf(const HandedBody& body, const EllipsoidFit& fit) {
  const Matrix3 turn = fit.axes.transpose();
  const FrameOffset to_ellipsoid{turn, -(turn * fit.centre)};
  const Vector6 diagonal = body.settings.medium.density * ellipsoidAddedMass(fit.semi_axes);
  return {to_ellipsoid.inertiaToB(body.added_mass), diagonal.asDiagonal(),
          to_ellipsoid.inertiaToB(body.ownInertia())};
}

}  // namespace

ExportedBody makeMjcf(const HandedBody& body) {
  const double density = body.settings.medium.density;
  const EllipsoidFit fit = fitEllipsoid(body.added_mass / density, body.middle());
  const Vector6 unit_drag = unitDrag(body, fit);
  const EllipsoidDrag drag = fitDrag(unit_drag, fit.semi_axes);
  constexpr double kRounding = 1e-9;
  const std::string report =
      "ellipsoid for MuJoCo with semi-axes " + sizesText(fit.semi_axes) + "\n" +
      addedMassReport(addedMassesOf(body, fit)) +
      "drag along its axes at 1 m/s [N] and about them at 1 rad/s [N m]\n" +
      comparison(density * unit_drag, density * unitDrag(drag, fit.semi_axes),
                 kRounding * density * unit_drag);
  const double carried = density * body.wet.volume / body.weight.mass;
  return {"<mujoco model=\"" + body.name +
              "\">\n<!-- The frame of the body is F. Its weight is carried by buoyancy at the "
              "centre of mass.\n" +
              report + "-->\n  " + optionElement(body) + "\n  <worldbody>\n    <body name=\"" +
              body.name + "\" gravcomp=\"" + numberText(carried) +
              "\">\n      <freejoint/>\n      " + inertialElement(body) + "\n      " +
              geomElement(fit, drag) + "\n    </body>\n  </worldbody>\n</mujoco>\n",
          report};
}

namespace {

// Lamb's alpha_0, beta_0, gamma_0 by the added masses m of an ellipsoid of volume V: m = V a/(2 -
// a).
Vector3 shapeFactors(const Vector3& m, double volume) {
  return 2 * m.array() / (volume + m.array());
}

// The volume V of the ellipsoid: sum m_k / (V + m_k) = 1, or V^3 - e_2 V - 2 e_3 = 0 by the
// elementary symmetric functions of m. Newton's method comes down from above.
double volumeOf(const Vector3& m) {
  const double e2 = m[0] * m[1] + m[1] * m[2] + m[2] * m[0], e3 = m.prod();
  double volume = 2 * m.maxCoeff();
  for (int i = 0; i < 100; ++i) {
    const double next = (2 * volume * volume * volume + 2 * e3) / (3 * volume * volume - e2);
    if (!(next < volume)) break;
    volume = next;
  }
  return volume;
}

// The shift d to where the coupling C - [d]x M is least; M is the translation block.
Vector3 leastCoupling(const Matrix6& added_mass) {
  const Matrix3 mass = added_mass.bottomRightCorner<3, 3>();
  const Matrix3 coupling = added_mass.topRightCorner<3, 3>();
  Matrix3 normal;
  Vector3 right;
  std::array<Matrix3, 3> by;
  for (int k = 0; k < 3; ++k)
    by[static_cast<std::size_t>(k)] = crossMatrix(Vector3::Unit(k)) * mass;
  for (int k = 0; k < 3; ++k) {
    const Matrix3& by_k = by[static_cast<std::size_t>(k)];
    right[k] = by_k.cwiseProduct(coupling).sum();
    for (int l = 0; l < 3; ++l)
      normal(k, l) = by_k.cwiseProduct(by[static_cast<std::size_t>(l)]).sum();
  }
  // A sheet has no mass along itself: a shift along its normal couples nothing.
  constexpr double kFree = 1e-9;
  normal.diagonal().array() += kFree * normal.trace();
  return Cholesky<3>(normal).solve(right);
}

}  // namespace

// A longer semi-axis has a smaller factor. Each step corrects the logarithms of the semi-axes by
// half the error of their factors, which brings the ratios at least twice as near.
Vector3 semiAxesOf(const Vector3& added_mass) {
  constexpr double kThinnest = 1e-5, kRounding = 1e-14, kUnitVolume = 4 * kPi / 3;
  const Vector3 m = added_mass.cwiseMax(kThinnest * added_mass.maxCoeff());
  const double volume = volumeOf(m);
  const Vector3 wanted = shapeFactors(m, volume);
  Vector3 semi_axes = Vector3::Ones();
  for (int i = 0; i < 200; ++i) {
    const Vector3 factors = shapeFactors(ellipsoidAddedMass(semi_axes).tail<3>(), kUnitVolume);
    const Vector3 ratio = factors.cwiseQuotient(wanted);
    semi_axes = semi_axes.cwiseProduct(ratio.cwiseSqrt());
    semi_axes /= portable::cbrt(semi_axes.prod());
    if ((ratio.array() - 1).abs().maxCoeff() < kRounding) break;
  }
  return semi_axes * portable::cbrt(volume / kUnitVolume);
}

EllipsoidFit fitEllipsoid(const Matrix6& added_mass, const Vector3& middle) {
  const PrincipalFrame frame = findPrincipalFrame(added_mass.bottomRightCorner<3, 3>());
  const Vector3 centre = middle + leastCoupling(shiftOrigin(added_mass, middle));
  return {semiAxesOf(frame.moments), centre, frame.rotation};
}

namespace {

// Factors of the coefficients: of blunt or angular drag, and of slender drag.
struct DragAreas {
  Vector3 blunt, slender;
};

DragAreas silhouettes(const Vector3& a) {
  const Vector3 areas = kPi * Vector3(a[1] * a[2], a[2] * a[0], a[0] * a[1]);
  return {areas, Vector3::Constant(areas.maxCoeff()) - areas};
}

DragAreas moments(const Vector3& a) {
  constexpr double kSphere = 8.0 / 15 * kPi;
  Vector3 own, sorted = a;
  for (int k = 0; k < 3; ++k) {
    const double wide = std::max(a[(k + 1) % 3], a[(k + 2) % 3]);
    own[k] = kSphere * a[k] * (wide * wide) * (wide * wide);
  }
  std::sort(sorted.data(), sorted.data() + 3);
  const double largest = kSphere * sorted[1] * (sorted[2] * sorted[2]) * (sorted[2] * sorted[2]);
  return {own, Vector3::Constant(largest) - own};
}

// One over each drag, or over 1 % of the largest; 0 where there is none.
Vector3 weightsOf(const Vector3& drag) {
  if (!(drag.maxCoeff() > 0)) return Vector3::Zero();
  return drag.cwiseMax(0.01 * drag.maxCoeff()).cwiseInverse();
}

// The x >= 0 for which a x comes nearest to b.
double nearestFactor(const Vector3& a, const Vector3& b) {
  const double square = a.squaredNorm();
  return square > 0 ? std::max(0.0, a.dot(b) / square) : 0;
}

// Fits blunt and slender drag. A ball has no slender side.
EllipsoidDrag fitAlong(const Vector3& force, const DragAreas& along) {
  constexpr double kRounding = 1e-12;
  const Vector3 weights = weightsOf(force), right = weights.cwiseProduct(force);
  const Vector3 blunt = weights.cwiseProduct(along.blunt);
  const Vector3 slender = weights.cwiseProduct(along.slender);
  const double bb = blunt.squaredNorm(), ss = slender.squaredNorm(), bs = blunt.dot(slender);
  const double determinant = bb * ss - bs * bs;
  EllipsoidDrag fit{0, 0, 0};
  if (determinant > kRounding * bb * bb)
    fit.slender = std::max(0.0, (bb * slender.dot(right) - bs * blunt.dot(right)) / determinant);
  fit.blunt = nearestFactor(blunt, right - fit.slender * slender);
  return fit;
}

}  // namespace

Vector6 unitDrag(const EllipsoidDrag& drag, const Vector3& semi_axes) {
  const DragAreas along = silhouettes(semi_axes), about = moments(semi_axes);
  return stack(drag.angular * about.blunt + drag.slender * about.slender,
               drag.blunt * along.blunt + drag.slender * along.slender);
}

Vector6 unitDrag(const HandedBody& body, const EllipsoidFit& fit) {
  const BodyLoads loads(body.shape, {1, 0, Vector3::Zero(), Vector3::Zero()}, {});
  const FrameOffset to_ellipsoid{fit.axes.transpose(), -(fit.axes.transpose() * fit.centre)};
  Vector6 drag;
  for (int k = 0; k < 6; ++k) {
    const auto loadAt = [&](double speed) {
      const Twist motion = Twist::fromVector(speed * Vector6::Unit(k));
      return to_ellipsoid.toB(loads.at(to_ellipsoid.toF(motion)).total()).vector()[k];
    };
    drag[k] = std::max(0.0, (loadAt(-1) - loadAt(1)) / 2);
  }
  return drag;
}

EllipsoidDrag fitDrag(const Vector6& unit_drag, const Vector3& semi_axes) {
  const Vector3 force = unit_drag.tail<3>(), torque = unit_drag.head<3>();
  const DragAreas along = silhouettes(semi_axes), about = moments(semi_axes);
  EllipsoidDrag fit = fitAlong(force, along);
  const Vector3 weights = weightsOf(torque);
  fit.angular = nearestFactor(weights.cwiseProduct(about.blunt),
                              weights.cwiseProduct(torque - fit.slender * about.slender));
  return fit;
}

}  // namespace ambient
