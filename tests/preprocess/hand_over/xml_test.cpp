#include <gtest/gtest.h>
#include <tinyxml2.h>

#include <sstream>

#include "preprocess/hand_over.h"
#include "preprocess/hand_over/handed_body.h"
#include "tests/preprocess/hand_over/handed_bodies.h"

namespace ambient::test {
namespace {

/// A parsed text, and the elements on a path in it.
class Xml {
 public:
  explicit Xml(const std::string& text) {
    document_.Parse(text.c_str());
    EXPECT_FALSE(document_.Error()) << document_.ErrorStr() << "\n" << text;
  }
  const tinyxml2::XMLElement& at(const std::vector<std::string>& path) const {
    const tinyxml2::XMLElement* element = document_.RootElement();
    for (const std::string& name : path) {
      element = element->FirstChildElement(name.c_str());
      if (!element) throw std::runtime_error("no element " + name);
    }
    return *element;
  }

 private:
  tinyxml2::XMLDocument document_;
};

std::vector<double> numbersIn(const std::string& text) {
  std::istringstream stream(text);
  return {std::istream_iterator<double>(stream), {}};
}

Vector3 vectorIn(const std::string& text) {
  const std::vector<double> numbers = numbersIn(text);
  return {numbers.at(0), numbers.at(1), numbers.at(2)};
}

Matrix6 addedMassIn(const tinyxml2::XMLElement& element) {
  const std::string letters = "xyzpqr";
  Matrix6 K;
  for (std::size_t i = 0; i < 6; ++i)
    for (std::size_t j = i; j < 6; ++j) {
      const std::string name{letters[i], letters[j]};
      const tinyxml2::XMLElement* entry = element.FirstChildElement(name.c_str());
      EXPECT_TRUE(entry) << name;
      K(static_cast<int>(i), static_cast<int>(j)) = std::stod(entry->GetText());
    }
  return K.selfadjointView<Eigen::Upper>();
}

TEST(Sdf, ASphereCarriesHalfOfWhatItDisplaces) {
  const Xml sdf(exported(sphereBody(0.5), ExportFormat::kSdf, inSea()));
  EXPECT_EQ(std::string(sdf.at({}).Attribute("version")), "1.10");
  const Matrix6 K = addedMassIn(sdf.at({"model", "link", "inertial", "fluid_added_mass"}));
  const double mass = 2.0 / 3 * portable::acos(-1.0) * 0.125 * kSeaDensity;
  Vector6 diagonal;
  diagonal << mass, mass, mass, 0, 0, 0;
  EXPECT_LT((K - Matrix6(diagonal.asDiagonal())).norm(), 1e-12 * mass);
  const std::string own = sdf.at({"model", "link", "inertial", "mass"}).GetText();
  EXPECT_NEAR(std::stod(own), 2 * mass, 1e-12 * mass);
}

// About the link's origin, translation first.
TEST(Sdf, AddedMassHasTheKineticEnergyOfTheFluid) {
  const PlacedEllipsoid placed;
  const Xml sdf(exported(bodyOf(placed), ExportFormat::kSdf, inSea()));
  const Matrix6 K = addedMassIn(sdf.at({"model", "link", "inertial", "fluid_added_mass"}));
  EXPECT_LT(energyError(K / kSeaDensity, placed, {}), 1e-13);
}

TEST(Sdf, MassStandsAtItsCentre) {
  ExportSettings settings = inSea();
  settings.mass = 7;
  settings.centre_of_mass = {0.1, 0.2, 0.3};
  const auto body = bodyOf({});
  const Xml sdf(exported(body, ExportFormat::kSdf, settings));
  const std::vector<double> pose =
      numbersIn(sdf.at({"model", "link", "inertial", "pose"}).GetText());
  EXPECT_EQ(pose, (std::vector<double>{0.1, 0.2, 0.3, 0, 0, 0}));
  const tinyxml2::XMLElement& inertia = sdf.at({"model", "link", "inertial", "inertia"});
  const Matrix3 expected = 7 * body->uniform_mass.inertia;
  for (const auto& [name, i, j] : {std::tuple("ixx", 0, 0), std::tuple("ixy", 0, 1),
                                   std::tuple("iyz", 1, 2), std::tuple("izz", 2, 2)})
    EXPECT_DOUBLE_EQ(std::stod(inertia.FirstChildElement(name)->GetText()), expected(i, j)) << name;
}

PlacedEllipsoid ellipsoidIn(const tinyxml2::XMLElement& geom) {
  const std::vector<double> q = numbersIn(geom.Attribute("quat"));
  return {vectorIn(geom.Attribute("size")), vectorIn(geom.Attribute("pos")),
          Eigen::Quaterniond(q.at(0), q.at(1), q.at(2), q.at(3)).toRotationMatrix()};
}

// The share of the kinetic energy in a line of the report.
double percentAfter(const std::string& report, const std::string& words) {
  const std::size_t at = report.find(words);
  EXPECT_NE(at, std::string::npos) << report;
  return std::stod(report.substr(at + words.size()));
}

const char* const kEnergyError = "error of the kinetic energy of body and fluid, at most: ";

// The ellipsoid of the file, by the closed form, is the one that the fluid body was made of.
TEST(Mjcf, EllipsoidHasTheKineticEnergyOfTheFluid) {
  const PlacedEllipsoid placed;
  const ExportedBody made = exportFluidBody(bodyOf(placed), ExportFormat::kMjcf, inSea());
  const Xml mjcf(made.bytes);
  const tinyxml2::XMLElement& geom = mjcf.at({"worldbody", "body", "geom"});
  EXPECT_EQ(std::string(geom.Attribute("fluidshape")), "ellipsoid");
  const PlacedEllipsoid found = ellipsoidIn(geom);
  EXPECT_LT(energyError(linearFirst(bodyOf(found)->added_mass), placed, {}), 1e-7);
  EXPECT_EQ(percentAfter(made.report, kEnergyError), 0);
  EXPECT_NE(made.bytes.find(made.report), std::string::npos) << "no comment";
}

TEST(Mjcf, MassAndFluidAreGiven) {
  ExportSettings settings = inSea();
  settings.mass = 7;
  settings.centre_of_mass = {0.1, 0.2, 0.3};
  settings.up = Vector3::UnitY();
  const auto body = bodyOf({});
  const Xml mjcf(exported(body, ExportFormat::kMjcf, settings));
  const tinyxml2::XMLElement& inertial = mjcf.at({"worldbody", "body", "inertial"});
  EXPECT_EQ(vectorIn(inertial.Attribute("pos")), Vector3(0.1, 0.2, 0.3));
  const std::vector<double> full = numbersIn(inertial.Attribute("fullinertia"));
  const Matrix3 expected = 7 * body->uniform_mass.inertia;
  EXPECT_DOUBLE_EQ(full.at(2), expected(2, 2));
  EXPECT_DOUBLE_EQ(full.at(3), expected(0, 1));
  EXPECT_DOUBLE_EQ(full.at(5), expected(1, 2));
  EXPECT_EQ(std::stod(mjcf.at({"option"}).Attribute("density")), kSeaDensity);
  EXPECT_EQ(vectorIn(mjcf.at({"option"}).Attribute("gravity")), Vector3(0, -kSeaGravity, 0));
  EXPECT_NEAR(std::stod(mjcf.at({"worldbody", "body"}).Attribute("gravcomp")),
              kSeaDensity * body->volume / 7, 1e-9);
}

// A body like a cube, whose ellipsoid is a ball and turns freely.
TEST(Mjcf, ReportTellsTheErrorOfTheAddedMass) {
  FluidBody cube = facelessEllipsoid(Vector3::Ones());
  cube.uniform_mass.inertia = 0.4 * Matrix3::Identity();
  cube.added_mass.topLeftCorner<3, 3>() = 0.1 * Matrix3::Identity();
  const auto body = std::make_shared<FluidBody>(cube);
  const ExportedBody made = exportFluidBody(body, ExportFormat::kMjcf, inSea());
  const double own = 0.4 * cube.volume, mass = cube.added_mass(5, 5);
  EXPECT_NEAR(percentAfter(made.report, kEnergyError), 100 * 0.1 / (0.1 + own), 0.01);
  EXPECT_NEAR(percentAfter(made.report, "fluid, at most: "), 100 * 0.1 / (0.1 + own), 0.01);
  EXPECT_NEAR(percentAfter(made.report, "missing of the inertia of body and fluid, at most: "),
              100 * mass / (mass + cube.volume), 0.01);
  EXPECT_NE(made.report.find("-100.00 %\n"), std::string::npos) << made.report;
}

// The ellipsoid cannot have a coupling that no shift of its centre makes.
TEST(Mjcf, ReportTellsTheLostCoupling) {
  FluidBody screw = facelessEllipsoid(Vector3(1, 0.8, 0.6));
  screw.uniform_mass.inertia = 0.4 * Matrix3::Identity();
  screw.added_mass(0, 3) = screw.added_mass(3, 0) = 0.05;
  const auto body = std::make_shared<FluidBody>(screw);
  const ExportedBody made = exportFluidBody(body, ExportFormat::kMjcf, inSea());
  const double turning = screw.added_mass(0, 0) + 0.4 * screw.volume;
  const double moving = screw.added_mass(3, 3) + screw.volume;
  EXPECT_NEAR(percentAfter(made.report, "which MuJoCo has not: "),
              100 * 0.05 / std::sqrt(turning * moving), 0.01);
}

}  // namespace
}  // namespace ambient::test
