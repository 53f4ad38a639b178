#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <stdexcept>

#include "preprocess/hand_over.h"
#include "tests/preprocess/hand_over/handed_bodies.h"
#include "tests/support/refusal_of.h"
#include "tests/support/temporary_folder.h"

namespace ambient::test {
namespace {

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
            begin + "viscosity [Pa s] is -1, must be finite and not negative");
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
