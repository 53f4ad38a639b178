#include "tests/study/reality/falling_cases.h"

#include <cmath>
#include <utility>

#include "bullet_ambient/base/elementary.h"
#include "bullet_ambient/base/pi.h"
#include "preprocess/mesh/shapes/primitives.h"
#include "tests/study/reality/falling_bodies.h"

namespace ambient {
namespace {

constexpr double kBroadside = 1.17;  // C_D for speed and gravity scales if a case has no other
const Medium kUnitFluid{1, 1.0 / 2000, Vector3::Zero(), Vector3::Zero()};

/// Sets fluid and gravity so that terminal speed broadside is 1.
void weigh(FallingCase& falling, double area) {
  falling.medium = kUnitFluid;
  falling.gravity = kBroadside * area / (2 * (falling.mass - falling.body->volume));
  falling.time_step = 1.0 / 60;
  falling.duration = 120;
}

using Cases = std::vector<FallingCase>;

void addReleases(Cases& cases, FallingCase falling, const std::vector<double>& tilts) {
  for (const double tilt : tilts) {
    falling.tilt = tilt;
    cases.push_back(falling);
  }
}

/// Field et al. 1997: discs by dimensionless moment of inertia I*.
void addDiscs(Cases& cases) {
  FallingCase disc{"disc", "disc"};
  disc.body = sheetOf(makeEllipticSheetMesh(0.5, 0.5, 300), addedMassOfDisc(0.5));
  for (const double inertia : {.001, .002, .004, .006, .015, .02, .03, .1, .2, .5}) {
    disc.parameter = inertia;
    disc.mass = 16 * inertia;
    disc.inertia = disc.mass / 16 * Vector3(1, 1, 2);
    weigh(disc, kPi / 4);
    addReleases(cases, disc, {5, 45, 85});
  }
}

/// Discs with round edges, 10 : 1, by dimensionless moment of inertia I*.
void addSpheroids(Cases& cases) {
  FallingCase disc{"spheroid", "spheroid 10:1"};
  const Vector3 semi_axes(0.5, 0.5, 0.05);
  disc.body = solidOf(makeEllipsoidMesh(semi_axes, 720), addedMassOfEllipsoid(semi_axes));
  for (const double inertia : {.004, .006, .008, .015, .03, .1, .2, .3}) {
    disc.parameter = inertia;
    disc.mass = 20 * inertia;  // I = m d^2 / 20, about a diameter
    disc.inertia = disc.mass / 5 * Vector3(0.2525, 0.2525, 0.5);
    weigh(disc, kPi / 4);
    addReleases(cases, disc, {5, 45, 85});
  }
}

/// Belmonte et al. 1998: strips by Froude number.
void addStrips(Cases& cases) {
  const Vector3 size(1, 8, 0);
  FallingCase strip{"strip", "strip"};
  strip.body = sheetOf(makeRectangularSheetMesh(size.x(), size.y(), 300), addedMassOfStrip(size));
  for (const double froude : {.3, .4, .5, .55, .6, .65, .7, .75, .85, 1.0, 1.3, 2.0}) {
    strip.parameter = froude;
    strip.mass = froude * froude * size.y();
    strip.inertia = inertiaOfBox(strip.mass, size);
    weigh(strip, size.y());
    addReleases(cases, strip, {20, 45, 70});
  }
}

/// Andersen et al. 2005: aluminium plates in water, by thickness over chord.
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

FallingCase cardOf(const char* family, const Card& c) {
  FallingCase card{family, c.name, c.mass_per_area};
  card.body = sheetOf(makeRectangularSheetMesh(c.width, c.length, 400));
  card.mass = c.mass_per_area * c.width * c.length;
  card.inertia = inertiaOfBox(card.mass, {c.width, c.length, 0});
  card.medium = air();
  card.time_step = 1.0 / 240;
  card.duration = 6;
  return card;
}

/// Cards in air that tumble about their long axis.
void addCards(Cases& cases) {
  const Card cards[] = {{"business card 300 g/m2", .055, .085, .3},
                        {"paper 160 g/m2", .05, .1, .16},
                        {"board 1000 g/m2", .055, .085, 1},
                        {"strip of paper 80 g/m2", .02, .07, .08}};
  for (const Card& c : cards) addReleases(cases, cardOf("card", c), {60, 85});
}

/// Mahadevan et al. 1999: long cards, by width and by mass per area.
void addLongCards(Cases& cases) {
  const Card cards[] = {{"width 30 mm", .03, .3, .3},
                        {"width 45 mm", .045, .3, .3},
                        {"width 60 mm", .06, .3, .3},
                        {"150 g/m2", .045, .3, .15},
                        {"600 g/m2", .045, .3, .6}};
  for (const Card& c : cards) addReleases(cases, cardOf("long card", c), {60});
}

/// Flat round coin without relief, released 5 degrees off level.
FallingCase coinOf(const char* family, const std::string& name, double mass, double diameter,
                   double density) {
  const double radius = diameter / 2, height = mass / (density * kPi * radius * radius);
  FallingCase coin{family, name, mass, 5};
  coin.body = solidOf(makeCylinderMesh(radius, height, 600), addedMassOfDisc(radius));
  coin.mass = mass;
  const double across = mass * (3 * radius * radius + height * height) / 12;
  coin.inertia = {across, across, mass * radius * radius / 2};
  return coin;
}

/// A Czech coin in water; the density is that of plated steel.
FallingCase czechCoin(const char* family, const std::string& name, double mass, double diameter) {
  FallingCase coin = coinOf(family, name, mass, diameter, 7800);
  coin.medium = water();
  coin.time_step = 1.0 / 480;
  coin.duration = 4;
  return coin;
}

/// Czech coins in water.
void addCoins(Cases& cases) {
  cases.push_back(czechCoin("coin", "coin_2", 3.70e-3, 21.5e-3));
  cases.push_back(czechCoin("coin", "coin_5", 4.80e-3, 23.0e-3));
  cases.push_back(czechCoin("coin", "coin_10", 7.62e-3, 24.5e-3));
  cases.push_back(czechCoin("coin", "coin_20", 8.42e-3, 26e-3));
  cases.push_back(czechCoin("coin", "coin_50", 9.70e-3, 27.5e-3));
}

/// Motions drawn after the law was frozen: coins in a tank of 38 cm, a US cent in air, and playing
/// cards dropped flat and on edge.
void addDrawn(Cases& cases) {
  Cases coins;
  addCoins(coins);
  coins.insert(coins.begin(), czechCoin("coin", "coin_1", 3.60e-3, 20.0e-3));
  for (FallingCase& coin : coins) {
    coin.family = "dropped coin";
    coin.depth = 0.38;
    addReleases(cases, coin, {2, 5, 10});
  }
  FallingCase cent = coinOf("dropped coin", "cent", 2.5e-3, 19.05e-3, 7140);  // mostly zinc
  cent.medium = air();
  cent.time_step = 1.0 / 480;
  cent.duration = 8;
  addReleases(cases, cent, {2, 5, 10});
  FallingCase card = cardOf("playing card", {"flat", .063, .088, .325});
  card.duration = 3;
  addReleases(cases, card, {2, 5, 10});
  card.name = "on edge";
  addReleases(cases, card, {80, 85, 88});
}

/// Cubes and balls of wood and of stone in water, by size.
void addCubesAndSpheres(Cases& cases) {
  const auto cube = solidOf(makeBoxMesh(Vector3::Constant(0.5), 1200));
  const auto ball = ballOf(0.5);
  for (const double density : {600.0, 2500.0}) {
    for (const double size : {0.05, 0.1, 0.2, 0.4}) {
      FallingCase falling{"cube", std::to_string(static_cast<int>(density)), size, 3};
      falling.body = std::make_shared<FluidBody>(scaled(*cube, size));
      falling.mass = density * portable::pow(size, 3);
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

struct Group {
  const char* name;
  void (*add)(Cases&);
};

constexpr Group kGroups[] = {{"cubes and balls", addCubesAndSpheres},
                             {"cards", addCards},
                             {"long cards", addLongCards},
                             {"coins", addCoins},
                             {"plates", addPlates},
                             {"strips", addStrips},
                             {"discs", addDiscs},
                             {"spheroids", addSpheroids},
                             {"drawn", addDrawn}};

}  // namespace

std::vector<std::string> fallingGroups() {
  std::vector<std::string> names;
  for (const Group& group : kGroups) names.emplace_back(group.name);
  return names;
}

std::vector<FallingCase> makeFallingCases(const std::string& group) {
  Cases cases;
  for (const Group& known : kGroups)
    if (known.name == group) known.add(cases);
  return cases;
}

}  // namespace ambient
