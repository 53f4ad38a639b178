#pragma once

#include <optional>
#include <vector>

#include "bullet_ambient/spatial/vector_types.h"
#include "preprocess/hand_over/handed_body.h"

namespace ambient {

/// Steady straight flight without drive, in the plane of the forward and the upward axis.
struct Glide {
  double incidence = 0;  ///< of the forward axis above the path [rad]
  double speed = 0;      ///< at which the fluid carries the weight [m/s]
  double ratio = 0;      ///< way along for each metre of height; 0: straight down
  double angle = 0;      ///< of the path below the horizon [rad]; negative of what rises
  double moment = 0;     ///< about the centre of mass, nose up [N m]; 0 of a trim
  bool is_upright = false;
  Vector3 gravity{0, 0, 0};  ///< in F [m/s^2]
};

/// Small motion that swings, relative to a steady one.
struct Swing {
  double frequency = 0;  ///< undamped, |eigenvalue| [rad/s]
  double damping = 0;    ///< ratio: -Re(eigenvalue) / |eigenvalue|
  double period = 0;     ///< 2 pi / Im(eigenvalue) [s]
};

/// Small motions about a steady one.
struct GlideModes {
  std::vector<Swing> swings;  ///< the quickest first
  std::vector<double> rates;  ///< of motions that do not swing [1/s], ascending; positive: growth
};

/// What follows from one glide: where the loads of a change of incidence act, and how small motions
/// go on.
struct GlideStability {
  Vector3 neutral_point{0, 0, 0};  ///< on the line along forward through the centre of mass [m]
  double static_margin = 0;        ///< from there to the centre of mass, ahead [m]
  GlideModes pitching;             ///< in the plane: short period and phugoid
  GlideModes sideways;             ///< out of it: rolling, Dutch roll, spiral
};

/// How a body glides; mirror-symmetric about the plane of its forward and its upward axis.
struct GlidePlan {
  std::optional<Glide> trim;
  std::optional<Glide> best;  ///< of the largest ratio, whatever its moment
  GlideStability stability;   ///< of the trim
  bool goes_nose_up = false;  ///< without a trim: which way its nose goes at most incidences
  static constexpr double kWidest = 30;  ///< incidences that were tried, both ways [degrees]
};

/// Finds the trim: weight, buoyancy and the loads of a translation, with Munk's moment of the added
/// mass, leave neither force nor moment. Of several it is the stable one, then the one nearest to
/// 0. Its modes are the eigenvalues of Kirchhoff's equations, docs/theory.md eq. (2), linearised
/// about it: with the added mass, the derivatives of the loads by all of the motion, and the
/// turning of gravity. The fluid fills all space; holds are full of it. Cost: some thousand
/// evaluations of the loads.
/// @throws std::invalid_argument, naming the fluid body, if it neither sinks nor rises
GlidePlan planGlide(const HandedBody& body);

}  // namespace ambient
