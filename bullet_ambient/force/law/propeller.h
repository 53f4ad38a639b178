#pragma once

#include <vector>

#include "bullet_ambient/spatial/vector_types.h"

namespace ambient {

/// Thrust and torque of a propeller, and what they cost; signs as those of positive turns.
struct PropellerLoad {
  double thrust = 0;   ///< T, along the axis [N]
  double torque = 0;   ///< Q, of the shaft on the propeller [N m]; 0 of an ideal disc
  double power = 0;    ///< of the shaft: 2 pi n Q; below 0 where the flow turns it [W]
  double induced = 0;  ///< v_i: of the fluid through the disc, against the axis [m/s]

  /// The load of a part of the disc: v_i stays.
  friend PropellerLoad operator*(double factor, const PropellerLoad& load) {
    return {factor * load.thrust, factor * load.torque, factor * load.power, load.induced};
  }
};

/// Point of an open-water diagram: T = rho n^2 D^4 K_T, Q = rho n^2 D^5 K_Q at J = V/(n D).
struct PropellerPoint {
  double advance = 0;  ///< J
  double thrust = 0;   ///< K_T, for aeroplanes C_T
  double torque = 0;   ///< K_Q, for aeroplanes C_P / (2 pi)
};

/// Numbers of a propeller with a table that it need not have.
struct PropellerExtras {
  /// Blade area over that of the disc: drag of blades that stand still, docs/theory.md eq. (165).
  double area_ratio = 0.3;
  /// Thrust and torque that turns backwards have of those ahead; 1 of blades without camber.
  double astern = 1;
};

/// Ship's screw of the Wageningen B series, docs/theory.md eq. (164).
struct WageningenScrew {
  int blades = 4;          ///< Z, 2 to 7
  double area_ratio = 0;   ///< A_E/A_0, 0.3 to 1.05
  double pitch_ratio = 0;  ///< P/D, 0.5 to 1.4
  double astern = 1;       ///< as PropellerExtras
};

/// Returns the point of a screw at J by the polynomials of Oosterveld and van Oossanen.
PropellerPoint wageningenPoint(const WageningenScrew& screw, double advance);

/// Law of a propeller in the fluid at its disc, docs/theory.md section 22: quasi-steady, for any
/// turns and advance. It never gives more power to the body and the fluid than its shaft takes.
/// Plain numbers: copies are cheap, nothing changes.
class Propeller {
 public:
  /// An actuator disc, which has the power of its thrust at rest at any advance, eq. (163).
  /// @throws std::invalid_argument, one line, if the diameter [m] is not above 0
  static Propeller idealDisc(double diameter);
  /// A propeller by its diagram, linear between points.
  /// @throws std::invalid_argument, one line, if J does not rise from 0, a number is not finite, or
  /// a point takes less power than an ideal disc
  static Propeller byTable(double diameter, std::vector<PropellerPoint> points,
                           const PropellerExtras& extras = {});
  /// @throws std::invalid_argument, one line, if a number is outside of the series
  static Propeller wageningen(double diameter, const WageningenScrew& screw);

  double diameter() const noexcept { return diameter_; }
  /// Whether load() takes the thrust at rest in place of turns.
  bool isIdealDisc() const noexcept { return points_.empty(); }
  /// Returns what the whole disc gives.
  /// @param drive turns n [1/s]; of an ideal disc the thrust that it would have at rest [N]
  /// @param advance V: velocity of the disc along its axis, relative to the fluid there [m/s]
  /// @param density [kg/m^3]
  PropellerLoad load(double drive, double advance, double density) const noexcept;
  /// Returns the drag of the disc in its plane over the velocity there, docs/theory.md eq. (165a)
  /// [N s/m]; 0 of an ideal disc.
  /// @param load of load(), or that times a factor
  /// @param turns n [1/s]
  /// @param advance V [m/s]
  /// @param across speed of the disc across its axis, relative to the fluid there [m/s]
  double dragAcross(const PropellerLoad& load, double turns, double advance,
                    double across) const noexcept;

 private:
  /// T/(rho D^2) and Q/(rho D^3) [m^2/s^2].
  struct Specific {
    double thrust = 0, torque = 0;
  };

  Propeller(double diameter, std::vector<PropellerPoint> points, const PropellerExtras& extras,
            double pitch_ratio);
  double area() const noexcept;
  PropellerLoad discLoad(double rest_thrust, double advance, double density) const noexcept;
  Specific ahead(double turned, double advance, double factor) const noexcept;
  Specific inTable(double advance) const noexcept;

  double diameter_;
  std::vector<PropellerPoint> points_;  ///< empty: an ideal disc
  double astern_ = 1;
  Specific stopped_;  ///< c_T and c_Q of blades that stand still in flow from ahead
};

/// Returns v_i of momentum theory for a thrust [N] at an advance [m/s], with the thrust's sign,
/// docs/theory.md eq. (162). `mass_per_length`: rho A of the disc, above 0 [kg/m].
double inducedVelocity(double thrust, double advance, double mass_per_length) noexcept;

/// Jet behind a disc.
struct Wash {
  double velocity = 0;  ///< that it adds to the fluid, away from the disc, >= 0 [m/s]
  double radius = 0;    ///< [m]; 0: there is none

  /// Returns the share of a line that is in the jet. `centre`: of the line from the axis; `half`:
  /// from there to its end [m].
  double shareOf(const Vector3& centre, const Vector3& half) const noexcept;
  /// Returns the share of its velocity that a point has beside the axis [m], docs/theory.md eq.
  /// (171a): an edge, where a line has none.
  double shareAt(double beside) const noexcept;
};

/// Returns the jet of a disc at a distance behind it, docs/theory.md eq. (170), (170a): against the
/// axis if `induced` is positive, else along it.
/// @param induced v_i [m/s]
/// @param advance V of the disc [m/s]
/// @param radius of the disc [m]
/// @param distance down the jet [m]
Wash washOf(double induced, double advance, double radius, double distance) noexcept;

}  // namespace ambient
