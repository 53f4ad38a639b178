#include "demos/study/falling_cases.h"

#include <cmath>
#include <cstdio>
#include <utility>

#include "bullet_ambient/spatial/pi.h"
#include "preprocess/builder/fluid_body_builder.h"
#include "preprocess/mesh/primitives.h"

namespace ambient {
namespace {

constexpr double kBroadside = 1.17;  // C_D that scales speeds and gravity where nothing else does
const Medium kUnitFluid{1, 1.0 / 2000, Vector3::Zero(), Vector3::Zero()};

Matrix6 diagonal(const Vector3& rotation, const Vector3& translation) {
  Matrix6 made = Matrix6::Zero();
  made.diagonal() << rotation, translation;
  return made;
}

std::shared_ptr<const FluidBody> bodyOf(const TriangleMesh& mesh, BuildSettings settings) {
  settings.name = "falling body";
  settings.origin = Eigen::Vector3d::Zero();
  settings.flow.max_panels = 800;
  return std::make_shared<FluidBody>(makeFluidBody(mesh, settings));
}

std::shared_ptr<const FluidBody> sheetOf(const TriangleMesh& mesh,
                                         const std::optional<Matrix6>& added_mass = {}) {
  BuildSettings settings;
  settings.flow.sheet = true;
  settings.added_mass = added_mass;
  return bodyOf(mesh, settings);
}

std::shared_ptr<const FluidBody> solidOf(const TriangleMesh& mesh,
                                         const std::optional<Matrix6>& added_mass = {}) {
  BuildSettings settings;
  settings.added_mass = added_mass;
  return bodyOf(mesh, settings);
}

Matrix6 addedMassOfDisc(double radius) {
  const double turn = 16 * std::pow(radius, 5) / 45;
  return diagonal({turn, turn, 0}, {0, 0, 8 * std::pow(radius, 3) / 3});
}

/// Of an elliptic cylinder of chord, span and thickness (x, y, z), flow in the x-z plane.
Matrix6 addedMassOfStrip(const Vector3& size) {
  const double a = size.x() / 2, c = size.z() / 2, span = size.y();
  const double turn = kPi / 8 * std::pow(a * a - c * c, 2) * span;
  const double x = kPi * c * c * span, z = kPi * a * a * span;
  return diagonal({z * span * span / 12, turn, x * span * span / 12}, {x, 0, z});
}

Vector3 inertiaOfBox(double mass, const Vector3& size) {
  const Vector3 squares = size.cwiseProduct(size);
  return mass / 12 * (Vector3::Constant(squares.sum()) - squares);
}

/// With its weight such that it falls broadside with speed 1.
void weigh(FallingCase& falling, double area) {
  falling.medium = kUnitFluid;
  falling.gravity = kBroadside * area / (2 * falling.mass);
  falling.time_step = 1.0 / 60;
  falling.duration = 120;
}

using Cases = std::vector<FallingCase>;

/// Field et al. 1997, by the dimensionless moment of inertia I*.
void addDiscs(Cases& cases) {
  FallingCase disc{"disc", "disc"};
  disc.body = sheetOf(makeEllipticSheetMesh(0.5, 0.5, 300), addedMassOfDisc(0.5));
  for (const double inertia : {.001, .002, .004, .006, .015, .02, .03, .1, .2, .5}) {
    disc.parameter = inertia;
    disc.mass = 16 * inertia;
    disc.inertia = disc.mass / 16 * Vector3(1, 1, 2);
    weigh(disc, kPi / 4);
    for (const double tilt : {5.0, 45.0, 85.0}) {
      disc.tilt = tilt;
      cases.push_back(disc);
    }
  }
}

/// Belmonte et al. 1998, by the Froude number.
void addStrips(Cases& cases) {
  const Vector3 size(1, 8, 0);
  FallingCase strip{"strip", "strip"};
  strip.body = sheetOf(makeRectangularSheetMesh(size.x(), size.y(), 300), addedMassOfStrip(size));
  for (const double froude : {.3, .4, .5, .55, .6, .65, .7, .75, .85, 1.0, 1.3, 2.0}) {
    strip.parameter = froude;
    strip.mass = froude * froude * size.y();
    strip.inertia = inertiaOfBox(strip.mass, size);
    weigh(strip, size.y());
    for (const double tilt : {20.0, 45.0, 70.0}) {
      strip.tilt = tilt;
      cases.push_back(strip);
    }
  }
}

/// Andersen et al. 2005: aluminium in water, by thickness over chord.
void addPlates(Cases& cases) {
  constexpr double kThickness = 0.81e-3;
  for (const int slenderness : {14, 8, 5}) {
    const double chord = slenderness * kThickness;
    const Vector3 size(chord, 8 * chord, kThickness);
    FallingCase plate{"plate", "1/" + std::to_string(slenderness), 1.0 / slenderness};
    plate.body = solidOf(makeBoxMesh(size / 2, 600), addedMassOfStrip(size));
    plate.mass = 2700 * size.prod();
    plate.inertia = inertiaOfBox(plate.mass, size);
    plate.medium = water();
    plate.time_step = 1e-3;
    plate.duration = 4;
    for (const double tilt : {11.5, 30.0, 60.0}) {
      plate.tilt = tilt;
      plate.keeps_path = tilt == 11.5;
      cases.push_back(plate);
    }
  }
}

struct Card {
  const char* name;
  double width, length, mass_per_area;
};

/// Cards in air that tumble about their long axis.
void addCards(Cases& cases) {
  const Card cards[] = {{"business card, 300 g/m2", .055, .085, .3},
                        {"paper, 160 g/m2", .05, .1, .16},
                        {"board, 1000 g/m2", .055, .085, 1},
                        {"strip of paper, 80 g/m2", .02, .07, .08}};
  for (const Card& c : cards) {
    FallingCase card{"card", c.name, c.mass_per_area};
    card.body = sheetOf(makeRectangularSheetMesh(c.width, c.length, 400));
    card.mass = c.mass_per_area * c.width * c.length;
    card.inertia = inertiaOfBox(card.mass, {c.width, c.length, 0});
    card.medium = air();
    card.time_step = 1.0 / 240;
    card.duration = 6;
    for (const double tilt : {60.0, 85.0}) {
      card.tilt = tilt;
      cases.push_back(card);
    }
  }
}

/// Czech coins in water; the density is that of plated steel.
void addCoins(Cases& cases) {
  const std::pair<double, double> coins[] = {{3.70e-3, 21.5e-3},
                                             {4.80e-3, 23.0e-3},
                                             {7.62e-3, 24.5e-3},
                                             {8.42e-3, 26e-3},
                                             {9.70e-3, 27.5e-3}};
  const char* names[] = {"coin_2", "coin_5", "coin_10", "coin_20", "coin_50"};
  for (int i = 0; i < 5; ++i) {
    const auto [mass, diameter] = coins[i];
    const double radius = diameter / 2, height = mass / (7800 * kPi * radius * radius);
    FallingCase coin{"coin", names[i], mass, 5};
    coin.body = solidOf(makeCylinderMesh(radius, height, 600), addedMassOfDisc(radius));
    coin.mass = mass;
    const double across = mass * (3 * radius * radius + height * height) / 12;
    coin.inertia = {across, across, mass * radius * radius / 2};
    coin.medium = water();
    coin.time_step = 1.0 / 480;
    coin.duration = 4;
    cases.push_back(coin);
  }
}

/// Cubes and balls of wood and of stone in water, by size.
void addCubesAndSpheres(Cases& cases) {
  const auto cube = solidOf(makeBoxMesh(Vector3::Constant(0.5), 1200));
  BuildSettings round;
  round.sphere_radius = 0.5;
  round.added_mass = diagonal(Vector3::Zero(), Vector3::Constant(kPi / 12));
  const auto ball = bodyOf(makeEllipsoidMesh(Vector3::Constant(0.5), 320), round);
  for (const double density : {600.0, 2500.0}) {
    for (const double size : {0.05, 0.1, 0.2, 0.4}) {
      FallingCase falling{"cube", std::to_string(static_cast<int>(density)), size, 3};
      falling.body = std::make_shared<FluidBody>(scaled(*cube, size));
      falling.mass = density * std::pow(size, 3);
      falling.inertia = inertiaOfBox(falling.mass, Vector3::Constant(size));
      falling.medium = water();
      falling.time_step = 1.0 / 60;
      falling.duration = 12 * std::sqrt(size);
      cases.push_back(falling);
      falling.family = "sphere";
      falling.body = std::make_shared<FluidBody>(scaled(*ball, size));
      falling.mass *= kPi / 6;
      falling.inertia = Vector3::Constant(falling.mass * size * size / 10);
      cases.push_back(falling);
    }
  }
}

}  // namespace

std::vector<FallingCase> makeFallingCases() {
  Cases cases;
  addCubesAndSpheres(cases);
  addCards(cases);
  addCoins(cases);
  addPlates(cases);
  addStrips(cases);
  addDiscs(cases);
  return cases;
}

}  // namespace ambient
