#include <algorithm>
#include <cmath>

#include "bullet_ambient/spatial/cholesky.h"
#include "bullet_ambient/spatial/inertia.h"
#include "bullet_ambient/spatial/symmetric_eigen.h"
#include "preprocess/hand_over/ellipsoid_fit.h"
#include "preprocess/hand_over/handed_body.h"
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

}  // namespace ambient
