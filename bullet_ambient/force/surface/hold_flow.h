#pragma once

#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "bullet_ambient/fluid_body/fluid_body.h"

namespace ambient {

/// An opening for flows through it, in frame F: edges of its outline and pieces of its lid, which
/// are halved until they are many.
class OpeningShape {
 public:
  explicit OpeningShape(const HoldOpening& opening);

  struct Edge {
    Vector3 middle, way;  ///< [m]
  };
  struct Piece {
    Vector3 place;         ///< centroid [m]
    double area = 0;       ///< [m^2]
    std::size_t edge = 0;  ///< the nearest one
  };
  const std::vector<Vector3>& corners() const { return corners_; }
  const std::vector<Edge>& edges() const { return edges_; }
  const std::vector<Piece>& pieces() const { return pieces_; }
  /// Area of the lid along its normal, out of the hold [m^2].
  const Vector3& outward() const { return outward_; }
  /// Height of its highest corner along a normal [m].
  double top(const Vector3& normal) const noexcept;
  /// Whether no corner is below a height along a normal [m]. Cost: where their box is above it, two
  /// products of vectors.
  bool isAbove(double height, const Vector3& normal) const noexcept;

 private:
  std::vector<Vector3> corners_;
  Vector3 middle_, half_;  ///< of the box around the corners
  std::vector<Edge> edges_;
  std::vector<Piece> pieces_;
  Vector3 outward_{0, 0, 0};
};

/// A hole in a wall of a hold.
struct WallHole {
  Vector3 place{0, 0, 0};   ///< of its middle, in F [m]
  Vector3 normal{0, 0, 1};  ///< out of the hold, in F; unit
  double area = 0;          ///< [m^2]
};
/// Returns a hole as an opening to the fluid outside: an octagon, which is nearly round.
HoldOpening openingOf(const WallHole& hole);

/// Water on one side of an opening: the sea by default, whose level does not move.
struct WaterSide {
  double height = 0;                                        ///< of its level along the normal [m]
  double area = std::numeric_limits<double>::infinity();    ///< of its level [m^2]
  double volume = std::numeric_limits<double>::infinity();  ///< [m^3]
  double room = std::numeric_limits<double>::infinity();    ///< for more [m^3]
  /// Heights of the water at each edge of the opening above that level [m]; null: it is a plane.
  const double* rises = nullptr;
};

/// Which way is up, and how strong gravity is.
struct Upward {
  Vector3 normal{0, 0, 1};  ///< unit
  double gravity = 9.81;    ///< [m/s^2]
};

/// Flow through an opening with air on both sides, docs/theory.md eq. (138), (139), from one side
/// to the other; negative: back [m^3/s]. Water goes over the outline as over a weir, and, where the
/// whole outline lies below the level of the side that gives, at most as through an orifice. Cost:
/// a root for each edge and piece, 0.5 us.
/// @param opening,up in F
/// @param from_height,to_height of the levels along the normal [m]
/// @param from_rises,to_rises WaterSide::rises of the sides
double flowThrough(const OpeningShape& opening, const Upward& up, double from_height,
                   double to_height, const double* from_rises = nullptr,
                   const double* to_rises = nullptr) noexcept;

/// Flow through an opening where water shuts off the air on one side, eq. (139) with another
/// pressure there, positive from one side to the other [m^3/s]. Only water flows: a side gives
/// where its level is above the place.
/// @param opening,up in F
/// @param from_height,to_height of the levels along the normal [m]
/// @param air pressure of the air at the second side less that at the first, over rho g [m]
double sealedFlowThrough(const OpeningShape& opening, const Upward& up, double from_height,
                         double to_height, double air) noexcept;

/// Largest flow of water down through an opening while air rises through it, as large bubbles do,
/// docs/theory.md eq. (146) [m^3/s].
double bubblingFlow(const OpeningShape& opening, const Upward& up) noexcept;

/// Volume that flows through an opening in a step, implicit in the levels, docs/theory.md eq.
/// (140): at any duration these approach and never cross [m^3]. No more flows than there is water
/// or room.
double volumeThrough(const OpeningShape& opening, const Upward& up, const WaterSide& from,
                     const WaterSide& to, double duration) noexcept;

/// Pressure of the air outside a hold, and the weight of the water around it.
struct Outside {
  double atmosphere = 101325;  ///< pressure of the air at the surface [Pa]
  double weight = 9810;        ///< rho g of the water [N/m^3]
};

/// Air that water shuts off in a hold, or in several that it joins. It keeps pressure times volume,
/// docs/theory.md eq. (143).
struct SealedAir {
  double product = 0;  ///< pressure times volume [J]
  double volume = 0;   ///< [m^3]
  /// Pressure from which it leaves through the highest place of an opening, eq. (144) [Pa].
  double most = std::numeric_limits<double>::infinity();
  double kept = 0;  ///< volume that is left when water covers that place [m^3]
  /// Height of a place of an opening where the air outside can come in, eq. (145) [m].
  double inlet = std::numeric_limits<double>::infinity();

  /// Returns the product after water has come into the hold, whose level is then at a height.
  /// `taken` by the water; negative: given [m^3].
  double productAfter(double inflow, double level, const Outside& outside) const noexcept;
  /// Returns its pressure then, less that of the atmosphere, over rho g [m].
  double headAfter(double inflow, double level, const Outside& outside) const noexcept;
};

/// Finds where a function is zero that falls from one end to the other, or rises: by false
/// position, with half the value at an end that stays (Illinois), until the value is within
/// `accuracy`. @pre the values at the ends have different signs
template <class Function>
double fallingRoot(double near, double at_near, double far, double at_far, double accuracy,
                   const Function& function) {
  constexpr int kMostSteps = 60;
  int side = 0;
  double root = far;
  for (int i = 0; i < kMostSteps; ++i) {
    root = (near * at_far - far * at_near) / (at_far - at_near);
    const double at = function(root);
    if (std::abs(at) <= accuracy) break;
    if ((at > 0) == (at_near > 0)) {
      near = root;
      at_near = at;
      if (side == 1) at_far /= 2;
      side = 1;
    } else {
      far = root;
      at_far = at;
      if (side == -1) at_near /= 2;
      side = -1;
    }
  }
  return root;
}

}  // namespace ambient
