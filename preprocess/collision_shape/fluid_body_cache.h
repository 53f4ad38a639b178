#pragma once

#include <filesystem>
#include <memory>

#include "bullet_ambient/bullet/core/precision_check.h"
#include "bullet_ambient/bullet/world/fluid_body_source.h"
#include "preprocess/collision_shape/collision_shape_body.h"

AMBIENT_BEGIN

/// Makes and keeps the fluid bodies of collision shapes. Shapes with equal numbers share one fluid
/// body; shapes that differ in size alone are solved once and scaled. May be shared by worlds and
/// threads; shapes must not change during a call.
///
/// A form is solved at size 1, with its numbers rounded to a millionth: the result depends on the
/// shape alone, not on earlier shapes.
class FluidBodyCache : public FluidBodySource {
 public:
  struct Counts {
    int made = 0;     ///< forms that were solved
    int read = 0;     ///< forms that were read from the folder
    int instant = 0;  ///< forms that were guessed first, Quality::kInstant
  };

  /// When a solution from the background replaces the first guess.
  enum class Replacement {
    kWhenReady,  ///< as soon as it is ready, in whichever step that is
    kWhenAsked,  ///< only after finish(): in the same step in every run
  };

  /// `folder`: folder of .ambient files of the forms, for other runs and programs; made when first
  /// needed; empty: none. Damaged, foreign or outdated files are made again; a file that cannot be
  /// written is reported to settings.report. settings.report is called by the asking threads and,
  /// for Quality::kInstant, by the background thread.
  explicit FluidBodyCache(CollisionShapeSettings settings = {}, std::filesystem::path folder = {},
                          Replacement replacement = Replacement::kWhenReady);
  /// Waits for the present background solution; drops the others.
  ~FluidBodyCache() override;

  /// Returns the fluid body of a shape, in the shape's frame. Its name is the kind of the shape (or
  /// settings.name) and a number that is unique to the shape and the same in all programs. Equal
  /// shapes get the same object. If another thread is making the fluid body, waits for it. Cost if
  /// it is known: that of reading the shape's numbers. @throws std::runtime_error as
  /// makeFluidBody(), in every call.
  ///
  /// With Quality::kInstant the first result is a guess, within milliseconds, and a background
  /// thread solves the flow (kStandard). Later calls return the solution, and revision() changes;
  /// bodies of Fluid::addAll() get it at the end of a substep. settings.flow.threads limits the
  /// cores of the background.
  std::shared_ptr<const FluidBody> fluidBody(const btCollisionShape& shape) override;
  unsigned revision() const noexcept override;

  /// Finds the last result of fluidBody() with a name; null: none. A FluidBodyLookup for
  /// decodeState().
  std::shared_ptr<const FluidBody> find(const std::string& name) const;

  /// Waits for all background solutions. From then on fluidBody() returns them.
  void finish();

  Counts counts() const;

 private:
  struct Store;
  std::unique_ptr<Store> store_;
};

AMBIENT_END
