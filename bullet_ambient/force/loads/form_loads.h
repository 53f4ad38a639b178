#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "bullet_ambient/force/loads/load_tables.h"
#include "bullet_ambient/force/loads/surface_loads.h"
#include "bullet_ambient/force/loads/wing_lift.h"

namespace ambient {

/// Loads that a derived class computes on a whole body and on a part of it alike. `wet`: the part
/// in the fluid; null: all of the body is.
class LoadsOnPart : public SurfaceLoads {
 public:
  virtual FaceLoads partsOn(const Twist& x, const WetPart* wet) const noexcept = 0;
  virtual Wrench sumOn(const Twist& x, const WetPart* wet) const noexcept {
    return partsOn(x, wet).total();
  }

  Wrench load(const Twist& x) const noexcept override { return sumOn(x, nullptr); }
  Wrench wetLoad(const Twist& x, const WetPart& wet) const noexcept override {
    return sumOn(x, &wet);
  }
  FaceLoads parts(const Twist& x) const noexcept override { return partsOn(x, nullptr); }
  FaceLoads wetParts(const Twist& x, const WetPart& wet) const noexcept override {
    return partsOn(x, &wet);
  }
  SplitLoad split(const Twist& x, const WetPart* wet) const noexcept override {
    return {sumOn(x, wet), {}};
  }
};

/// Loads that are a sum over faces, docs/theory.md eq. (13) to (17), (43) to (44).
class FaceSum final : public LoadsOnPart {
 public:
  /// @param body that has the faces
  FaceSum(const LoadTables::Body& body, LoadTables::Faces faces, const LoadSettings& settings,
          LoadPrecision precision);

  FaceLoads partsOn(const Twist& x, const WetPart* wet) const noexcept override;
  Wrench sumOn(const Twist& x, const WetPart* wet) const noexcept override;
  int faces() const noexcept override { return static_cast<int>(faces_->size()); }
  /// At alpha = pi/2 the power of each face is negative or 0 by both laws.
  bool needsGuard() const noexcept override { return settings_.separation_cosine != 0; }

  const LoadTables::Faces& table() const { return faces_; }

 private:
  /// Where sides of a pool cut the faces, they are summed in double.
  bool isInSingle(const WetPart* wet) const noexcept {
    return packed_ && !(wet && wet->plane.sides_F);
  }

  LoadTables::Faces faces_;
  std::shared_ptr<const PackedFaces> packed_;  ///< null: all is summed in double
  double reference_length_;  ///< in the Reynolds number of eq. (16), root of the body's area [m]
  LoadSettings settings_;
};

/// Loads on the wings of a body: their lift, and the pressure on the faces of each.
struct LoadsOnWings {
  WingLift lift;
  std::vector<FaceSum> on_faces;
};

/// Returns the loads of the form law on a body that is no ball, docs/theory.md eq. (113), (160).
/// @param on_faces pressure on the faces of the body, or of the rest of one with wings
/// @param body it and its tables
/// @param settings of the fluid and the law
/// @param stall_lag as FlowSettings::stall_lag
/// @param wings none: the body is one part
std::shared_ptr<const SurfaceLoads> makeFormLoads(FaceSum on_faces, const LoadTables::Body& body,
                                                  const LoadSettings& settings, double stall_lag,
                                                  std::optional<LoadsOnWings> wings = std::nullopt);

/// Returns the loads of the form law on a ball, docs/theory.md eq. (119). `on_unit`: pressure on
/// unitSphere(); null for a ball that no surface cuts.
std::shared_ptr<const SurfaceLoads> makeBallLoads(std::shared_ptr<const SurfaceLoads> on_unit,
                                                  const FluidBody& ball,
                                                  const LoadSettings& settings);

}  // namespace ambient
