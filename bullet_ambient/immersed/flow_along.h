#pragma once

#include <algorithm>
#include <array>

#include "bullet_ambient/immersed/ambient_body.h"
#include "bullet_ambient/immersed/fluid_regions.h"

namespace ambient {

// A body across the rim of a pool: the bounds of a region of water cut it, and no water is beyond.

/// Finds the region of a body in a step of `duration` [s]: that at its centre of mass, or, where
/// that has no surface, a pool into whose water it reaches from outside. Adds the number of tests
/// to `asked`. Cost: RegionIndex::findAround(), and that of findSides() where bounds are near.
RegionsAround findRegions(const AmbientBody& ambient, const MotionView& now,
                          const FluidRegions& regions, double duration, long long& asked) noexcept;

/// Returns the point at which a region is sampled for a body: its centre of mass, or the point of
/// the region that is nearest to it.
Vector3 pointIn(const FluidRegion& region, const Vector3& centre_W) noexcept;

/// Returns the sides of a region of water beyond which a body reaches where its velocity brings it
/// in a time `ahead` [s], but those with water beyond. Balls have none: their centre decides.
PoolSides findSides(const AmbientBody& ambient, const MotionView& now, const FluidRegions& regions,
                    const RegionEntry& pool, double ahead) noexcept;

/// Computes by how much the water presses a body across the sides of its pool, and resists where
/// more of it comes into the water in a step of `duration` [s]: FlowAlongBody::side_push_W,
/// growth_W.
/// @pre it is at a surface
void findSidePush(AmbientBody& ambient, const MotionView& now, double duration) noexcept;

/// True if a body of a length [m] is not small against the waves of a region, docs/theory.md eq.
/// (83), and may meet different heights of the surface along it.
bool isLargeAgainstWaves(const FluidRegion& region, double length) noexcept;

/// True if the fluid may differ along a body: the bounds of a region cross it, its region has a
/// flow, or it is not small against the waves; docs/theory.md eq. (83). Cost: some comparisons.
bool needsStations(const AmbientBody& ambient, const RegionsAround& around) noexcept;

/// Returns half the height of a body for sampleRegion() [m]; 0 where the region has no flow above.
double halfHeight(const AmbientBody& ambient, const MotionView& now,
                  const FluidRegion& region) noexcept;

/// Samples of the regions at the stations of a body, as differences from that at its centre of
/// mass. Stations in a fluid of another density or viscosity count as the centre.
class StationSamples {
 public:
  /// `centre`: sample at the centre of mass. Cost: a call of each function of the region for each
  /// station. Allocates nothing.
  StationSamples(const AmbientBody& ambient, const MotionView& now, const FluidRegions& regions,
                 const RegionsAround& around, const RegionSample& centre) noexcept;

  bool isFinite() const noexcept { return is_finite_; }  ///< false: a station counts as the centre
  bool isSteady() const noexcept {
    return is_steady_;
  }  ///< no fluid at a station changes with time

  /// Adds what the mean velocity and acceleration over the stations differ by from the centre.
  void addMeans(Medium RegionSample::*side, RegionSample& sample) const noexcept;
  /// Fits height and tilt of the surface to the stations; docs/theory.md eq. (84). Call after
  /// addMeans().
  void fitSurface(const Vector3& gravity, RegionSample& sample) const noexcept;
  /// Returns how the fluid on one side of the surface moves along the body, eq. (85), (86).
  FlowAlongBody flowAlong(Medium RegionSample::*side) const noexcept;

 private:
  static constexpr int kPairs = 3;
  struct Station {
    Vector3 offset_W{0, 0, 0};
    RegionSample sample;
    bool has_surface = false;  // of StationSamples::surface_
  };

  void sampleAt(const AmbientBody& ambient, const FluidRegions& regions,
                const RegionsAround& around, Station& station) noexcept;
  bool isUsed(int axis) const { return !stations_[2 * axis].offset_W.isZero(0); }
  Vector3 difference(int station, Medium RegionSample::*side, Vector3 Medium::*what) const;
  Vector3 meanDifference(Medium RegionSample::*side, Vector3 Medium::*what) const;
  // Velocities at the stations of an axis less that at the centre, in B [m/s].
  struct AxisFlow {
    Vector3 offset_B{0, 0, 0};
    Vector3 even_B{0, 0, 0};  // what grows evenly along the axis, at the station ahead
    Vector3 ahead_B{0, 0, 0}, behind_B{0, 0, 0};  // the rest
    Vector3 acceleration_B{0, 0, 0};              // odd part, at the station ahead [m/s^2]
    double largest = 0;                           // of either side, with what is even

    double rest() const { return std::max(ahead_B.norm(), behind_B.norm()); }
  };

  AxisFlow alongAxis(int axis, Medium RegionSample::*side) const;
  // Returns the angular velocity or acceleration of the rigid motion nearest to what is ahead.
  static Vector3 turning(const AxisFlow (&axes)[kPairs], Vector3 AxisFlow::*ahead_B);
  // Adds the rest along an axis, at three stations.
  static void divide(const AxisFlow& axis, FlowAlongBody& flow);

  const Vector3 centre_W_;
  const Matrix3 to_world_;
  RegionSample centre_;
  const Vector3 still_axis_B_;
  const double half_height_;     // for sampleRegion() [m]
  const WaterSurface* surface_;  // that of the centre, if it is no plane
  bool may_turn_ = false;        // its velocity may differ by more than that of a wave
  bool is_finite_ = true, is_steady_ = true;
  std::array<Station, 2 * kPairs> stations_;  // of each axis those on both sides
};

/// Finds what the flow along a body adds to its applied wrench in a step of `duration` [s]:
/// FlowAlongBody::push_B, at_rest_B, side_push_W, growth_W, layers_W. Allocates nothing. Cost:
/// nothing where the fluid moves as one.
void findPushes(AmbientBody& ambient, const MotionView& now, const FluidRegions& regions,
                double duration) noexcept;

}  // namespace ambient
