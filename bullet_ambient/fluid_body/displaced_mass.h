#pragma once

namespace ambient {

/// Mass of a body, and mass of the medium that it displaces; afloat: of the fluid above the
/// surface, since it may float however light it is, but not on air.
struct DisplacedMass {
  double body = 0;    ///< [kg]
  double medium = 0;  ///< [kg]

  bool isLighter() const { return body < medium; }
  /// True if the body has less than half the mass of the medium and so rises fast, which is hardly
  /// meant in air.
  bool isMuchLighter() const { return 2 * body < medium; }
};

}  // namespace ambient
