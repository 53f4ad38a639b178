#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "preprocess/hand_over.h"
#include "preprocess/hand_over/handed_body.h"
#include "tests/preprocess/hand_over/handed_bodies.h"
#include "tests/support/bodies/hull_bodies.h"
#include "tests/support/refusal_of.h"
#include "tests/support/temporary_folder.h"

namespace ambient::test {
namespace {

using nlohmann::json;

Matrix6 matrixOf(const json& rows) {
  Matrix6 matrix;
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j) matrix(i, j) = rows.at(i).at(j);
  return matrix;
}

Vector6 rowOf(const json& row) {
  Vector6 vector;
  for (int i = 0; i < 6; ++i) vector[i] = row.at(i);
  return vector;
}

json fossen(const std::shared_ptr<const FluidBody>& body, const ExportSettings& settings) {
  return json::parse(exported(body, ExportFormat::kFossen, settings));
}

TEST(Fossen, ASphereCarriesHalfOfWhatItDisplaces) {
  const double mass = 2.0 / 3 * portable::acos(-1.0) * 0.125 * kSeaDensity;
  const json sphere = fossen(sphereBody(0.5), inSea());
  Vector6 diagonal;
  diagonal << mass, mass, mass, 0, 0, 0;
  EXPECT_LT((matrixOf(sphere["M_A"]) - Matrix6(diagonal.asDiagonal())).norm(), 1e-12 * mass);
  EXPECT_NEAR(sphere["mass"], 2 * mass, 1e-12 * mass);
  EXPECT_EQ(sphere["order"], "u v w p q r");
  EXPECT_FALSE(sphere.contains("D"));
}

// In SNAME's axes of bodies that look along any axis of F.
TEST(Fossen, AddedMassHasTheKineticEnergyOfTheFluid) {
  const PlacedEllipsoid placed;
  const Vector3 x = Vector3::UnitX(), y = Vector3::UnitY(), z = Vector3::UnitZ();
  for (const auto& [forward, up] : {std::pair(x, z), std::pair(Vector3(-y), x), std::pair(z, y)}) {
    ExportSettings settings = inSea();
    settings.forward = forward;
    settings.up = up;
    OtherFrame sname;
    sname.axes << forward, forward.cross(up), -up;
    const json body = fossen(bodyOf(placed), settings);
    EXPECT_LT(energyError(matrixOf(body["M_A"]) / kSeaDensity, placed, sname), 1e-13);
  }
}

// Fossen 2011, eq. (3.44), of a mass with its centre at r_g.
TEST(Fossen, RigidBodyMatrixIsFossens) {
  ExportSettings settings = inSea();
  settings.mass = 3;
  settings.centre_of_mass = {0.1, 0.2, -0.3};
  const json body = fossen(sphereBody(0.5), settings);
  const Vector3 r(0.1, -0.2, 0.3);  // in SNAME's axes
  for (int i = 0; i < 3; ++i) EXPECT_DOUBLE_EQ(body["centre_of_gravity"][i], r[i]);
  Matrix3 cross;
  cross << 0, -r.z(), r.y(), r.z(), 0, -r.x(), -r.y(), r.x(), 0;
  Matrix6 expected;
  expected << 3 * Matrix3::Identity(), -3 * cross, 3 * cross,
      3 * 0.1 * Matrix3::Identity() - 3 * cross * cross;
  EXPECT_LT((matrixOf(body["M_RB"]) - expected).norm(), 1e-14);
}

// Fossen 2011, eq. (4.24): rho g A, rho g V GM_T, rho g V GM_L.
TEST(Fossen, RestoringForcesOfABargeAreThoseOfItsMetacentres) {
  const double L = 4, B = 1.5, T = 0.4;
  FluidBody barge = boxBody({L, B, 1});
  barge.added_mass_parts =
      std::vector<AddedMassPart>(1);  // a waterline is allowed; its added mass does not count here
  barge.uniform_mass.inertia.setIdentity();
  ExportSettings settings = inSea();
  settings.draught = T;
  const json body = fossen(std::make_shared<FluidBody>(barge), settings);
  const double volume = L * B * T, weight = kSeaDensity * kSeaGravity * volume;
  const double between = T / 2 - 0.5;  // centre of buoyancy above the centre of mass
  Vector6 expected;
  expected << 0, 0, weight / T, weight * (B * B / (12 * T) + between),
      weight * (L * L / (12 * T) + between), 0;
  EXPECT_LT((matrixOf(body["G"]) - Matrix6(expected.asDiagonal())).norm(), 1e-12 * weight);
  EXPECT_NEAR(body["displaced_volume"], volume, 1e-14);
  EXPECT_NEAR(body["waterplane_area"], L * B, 1e-14);
  EXPECT_NEAR(body["centre_of_buoyancy"][2], -between, 1e-14);
}

// Below the surface only the lever between the two centres turns it back.
TEST(Fossen, ASubmergedBodyIsTurnedBackByItsBuoyancy) {
  ExportSettings settings = inSea();
  settings.centre_of_mass = {0.2, -0.1, 0.1};
  const PlacedEllipsoid placed;  // its centre is 0.3 m above
  const json body = fossen(bodyOf(placed), settings);
  const Vector3 buoyancy(0.2, 0.1, -0.4);  // in SNAME's axes
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(body["centre_of_buoyancy"][i], buoyancy[i], 1e-14);
  const double weight = body["mass"].get<double>() * kSeaGravity;
  Vector6 expected;
  expected << 0, 0, 0, 0.3 * weight, 0.3 * weight, 0;
  EXPECT_LT((matrixOf(body["G"]) - Matrix6(expected.asDiagonal())).norm(), 1e-12 * weight);
}

// The potential 0 at the surface is that of the sphere's image with opposite sign: half the mass of
// heave in unbounded fluid.
TEST(Fossen, HalfASphereHeavesWithHalfItsAddedMass) {
  ExportSettings settings = inSea();
  settings.draught = 0.5;
  const Matrix6 M = matrixOf(fossen(sphereBody(0.5), settings)["M_A"]);
  const double deep = 2.0 / 3 * portable::acos(-1.0) * 0.125 * kSeaDensity;
  EXPECT_NEAR(M(2, 2) / deep, 0.5, 1e-4);  // of the table of spheres
}

// Forces grow with the square of the speed: D x = -2 tau along the motion, Euler; across it a
// sphere feels the drag turn.
TEST(Fossen, DragOfASphereIsLinearised) {
  ExportSettings settings = inSea();
  settings.speed = 1.5;
  const json sphere = fossen(sphereBody(0.5), settings);
  const Matrix6 D = matrixOf(sphere["D"]);
  const Vector6 tau = rowOf(sphere["tau"]);
  EXPECT_LT(tau[0], 0);
  EXPECT_NEAR(D(0, 0) * 1.5, -2 * tau[0], 1e-7 * D(0, 0));
  EXPECT_NEAR(D(1, 1) * 1.5, -tau[0], 1e-7 * D(0, 0));
  EXPECT_NEAR(D(2, 2) * 1.5, -tau[0], 1e-7 * D(0, 0));
}

TEST(Fossen, DragOfABoxIsLinearised) {
  ExportSettings settings = inSea();
  settings.speed = 1.5;
  settings.forward = -Vector3::UnitY();
  FluidBody box = boxBody({0.5, 2, 1}, 4);
  box.uniform_mass.inertia.setIdentity();
  const json body = fossen(std::make_shared<FluidBody>(box), settings);
  const Matrix6 D = matrixOf(body["D"]);
  EXPECT_LT((D.col(0) * 1.5 + 2 * rowOf(body["tau"])).norm(), 1e-7 * D(0, 0));
  EXPECT_LT(rowOf(body["tau"])[0], 0);
  for (int i = 0; i < 6; ++i) EXPECT_GT(D(i, i), 0) << i;
}

TEST(Fossen, NamesAreTexts) {
  const auto body = sphereBody(1);
  body->name = "a\"b\\<\xff&\n";
  EXPECT_EQ(fossen(body, {})["name"], "a_b_____");
}

double largestError(const Vector3& a, const Vector3& b) {
  return (a - b).cwiseQuotient(b).cwiseAbs().maxCoeff();
}

TEST(EllipsoidFit, FindsTheSemiAxesOfAnEllipsoid) {
  for (const Vector3& semi_axes : {Vector3(1, 1, 1), Vector3(3, 2, 1), Vector3(0.01, 0.02, 0.05),
                                   Vector3(40, 1, 1), Vector3(1, 1, 0.02), Vector3(10, 3, 0.1)}) {
    const auto added = reference::ellipsoidAddedMass(semi_axes);
    EXPECT_LT(largestError(semiAxesOf(added.tail<3>()), semi_axes), 1e-11) << semi_axes.transpose();
  }
}

// Any three added masses are those of an ellipsoid: a cube's, and ones of no real body.
TEST(EllipsoidFit, HasTheAddedMassesThatWereAskedFor) {
  for (const Vector3& added :
       {Vector3(0.638, 0.638, 0.638), Vector3(1, 10, 100), Vector3(7, 7, 1)}) {
    const Vector3 found = reference::ellipsoidAddedMass(semiAxesOf(added)).tail<3>();
    EXPECT_LT(largestError(found, added), 1e-11) << added.transpose();
  }
}

// A disc: 8/3 a^3 along its axis and nothing along its plane.
TEST(EllipsoidFit, OfADiscIsThin) {
  const Vector3 semi_axes = semiAxesOf({0, 0, 8.0 / 3});
  EXPECT_NEAR(semi_axes[0], 1, 2e-3);
  EXPECT_LT(semi_axes[2], 3e-3);
}

TEST(EllipsoidFit, FindsWhereItStands) {
  const PlacedEllipsoid placed;
  const EllipsoidFit fit = fitEllipsoid(bodyOf(placed)->added_mass, {0, 0, 0});
  // The free shift of sheets is held back by a billionth.
  EXPECT_LT((fit.centre - placed.centre).norm(), 1e-8);
  const PlacedEllipsoid found{fit.semi_axes, fit.centre, fit.axes};
  const Matrix6 K = bodyOf(found)->added_mass;
  EXPECT_LT((K - bodyOf(placed)->added_mass).cwiseAbs().maxCoeff(), 1e-8);
}

// A sheet leaves the shift along its normal free.
TEST(EllipsoidFit, StaysInTheMiddleOfASheet) {
  Matrix6 added = Matrix6::Zero();
  added(5, 5) = 8.0 / 3;
  EXPECT_LT((fitEllipsoid(added, {0, 0, 0.3}).centre - Vector3(0, 0, 0.3)).norm(), 1e-12);
}

TEST(EllipsoidDrag, FindsTheCoefficientsOfAnEllipsoid) {
  const Vector3 semi_axes(2, 0.7, 0.4);
  const EllipsoidDrag drag{0.6, 0.1, 1.2};
  const EllipsoidDrag found = fitDrag(unitDrag(drag, semi_axes), semi_axes);
  EXPECT_NEAR(found.blunt, drag.blunt, 1e-12);
  EXPECT_NEAR(found.slender, drag.slender, 1e-12);
  EXPECT_NEAR(found.angular, drag.angular, 1e-12);
}

// MuJoCo's formula, written out: a disc that falls flat, and one that spins.
TEST(EllipsoidDrag, IsMuJoCos) {
  const double pi = portable::acos(-1.0);
  const Vector6 drag = unitDrag({0.5, 0.25, 1.5}, {2, 1, 0.5});
  EXPECT_NEAR(drag[5], 0.5 * pi * 2 * 1, 1e-13);
  EXPECT_NEAR(drag[3], 0.5 * pi * 0.5 + 0.25 * (pi * 2 - pi * 0.5), 1e-13);
  const double largest = 8.0 / 15 * pi * 1 * 16, about_z = 8.0 / 15 * pi * 0.5 * 16;
  EXPECT_NEAR(drag[2], 1.5 * about_z + 0.25 * (largest - about_z), 1e-12);
}

std::string exportRefusal(const std::shared_ptr<const FluidBody>& body, ExportFormat format,
                          const std::function<void(ExportSettings&)>& change) {
  ExportSettings settings;
  change(settings);
  return refusalOf<std::invalid_argument>([&] { exportFluidBody(body, format, settings); });
}

std::string exportRefusal(const std::function<void(ExportSettings&)>& change) {
  return exportRefusal(sphereBody(1), ExportFormat::kFossen, change);
}

TEST(ExportRefusal, NumbersThatAreNotPhysicalAreNamed) {
  const std::string begin = "fluid body 'ellipsoid': ", positive = ", must be positive and finite";
  EXPECT_EQ(exportRefusal([](auto& s) { s.medium.density = -1; }),
            begin + "density of the fluid [kg/m^3] is -1" + positive);
  EXPECT_EQ(exportRefusal([](auto& s) { s.medium.density = NAN; }),
            begin + "density of the fluid [kg/m^3] is nan" + positive);
  EXPECT_EQ(exportRefusal([](auto& s) { s.medium.viscosity = -1; }),
            begin + "viscosity [Pa s] is -1, must be from 0 to 1e24");
  EXPECT_EQ(exportRefusal([](auto& s) { s.gravity = HUGE_VAL; }),
            begin + "gravity [m/s^2] is inf" + positive);
  EXPECT_EQ(exportRefusal([](auto& s) { s.mass = 0; }), begin + "mass [kg] is 0" + positive);
  EXPECT_EQ(exportRefusal([](auto& s) { s.draught = -1; }), begin + "draught [m] is -1" + positive);
  EXPECT_EQ(exportRefusal([](auto& s) { s.speed = -2; }), begin + "speed [m/s] is -2" + positive);
  EXPECT_EQ(exportRefusal([](auto& s) { s.centre_of_mass = Vector3(0, NAN, 0); }),
            begin + "distance of the centre of mass [m] is nan, must be finite");
  EXPECT_EQ(exportRefusal([](auto& s) {
              s.up = {0, 0, 2};
            }),
            begin + "length of a forward or upward axis is 2, must be 1");
  EXPECT_EQ(exportRefusal([](auto& s) { s.up = s.forward; }),
            begin + "forward axis times upward axis is 1, must be 0");
}

TEST(ExportRefusal, NumbersThatMakeOthersInfiniteAreNamed) {
  for (const auto& change : std::vector<std::function<void(ExportSettings&)>>{
           [](auto& s) { s.medium.density = 1e308; }, [](auto& s) { s.mass = 1e308; },
           [](auto& s) { s.centre_of_mass = Vector3(1e200, 0, 0); }})
    EXPECT_NE(exportRefusal(change).find("largest entry of inertia and stiffness is inf, must be"),
              std::string::npos);
  EXPECT_EQ(
      exportRefusal([](auto& s) { s.speed = 1e200; }),
      "fluid body 'ellipsoid': speed [m/s] is 1e+200, must be small enough for a finite drag");
}

TEST(ExportRefusal, ASurfaceNeedsParts) {
  EXPECT_EQ(exportRefusal(std::make_shared<FluidBody>(facelessEllipsoid({1, 1, 1})),
                          ExportFormat::kSdf, [](auto& s) { s.draught = 1; }),
            "fluid body 'ellipsoid': number of added-mass parts, which a draught needs, is 0, must "
            "be above 0: build the body anew from its mesh or shape");
}

TEST(ExportRefusal, ASheetNeedsAMass) {
  FluidBody sheet = facelessEllipsoid({1, 1, 1});
  sheet.volume = 0;
  EXPECT_EQ(exportRefusal(std::make_shared<FluidBody>(sheet), ExportFormat::kSdf, [](auto&) {}),
            "fluid body 'ellipsoid': displaced mass [kg] is 0, must be positive, or the mass must "
            "be given");
}

TEST(ExportRefusal, WhatAFormatHasNoPlaceForIsNamed) {
  EXPECT_EQ(exportRefusal(sphereBody(1), ExportFormat::kSdf, [](auto& s) { s.speed = 1; }),
            "fluid body 'ellipsoid': speed [m/s] is 1, must be given for fossen only");
  EXPECT_THROW(exportFormatOf("urdf"), std::invalid_argument);
}

TEST(ExportRefusal, NothingIsHalfWritten) {
  const TemporaryFolder folder;
  const ExportedBody made = exportFluidBody(sphereBody(1), ExportFormat::kSdf, {});
  EXPECT_THROW(made.write(folder / "none" / "a.sdf"), std::runtime_error);
  EXPECT_THROW(made.write(folder.path()), std::runtime_error);
  EXPECT_TRUE(folder.empty());
}

}  // namespace
}  // namespace ambient::test
