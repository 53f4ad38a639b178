#pragma once

#include <filesystem>
#include <memory>

#include "bullet_ambient/bullet/core/precision_check.h"
#include "bullet_ambient/bullet/world/fluid_body_source.h"
#include "preprocess/collision_shape/collision_shape_body.h"

AMBIENT_BEGIN

/// The fluid bodies of collision shapes, each made once: shapes of equal numbers are one, wherever
/// they are in memory, and those that differ by their size alone are solved once and scaled. May be
/// shared by worlds and threads, whose shapes must not change meanwhile.
///
/// A form is solved at a size of 1 and its numbers rounded to a millionth, so that what a shape
/// gets depends on the shape alone, not on those that came before.
class FluidBodyCache : public FluidBodySource {
 public:
  struct Counts {
    int made = 0;     ///< forms that were solved
    int read = 0;     ///< forms that were read from the folder
    int instant = 0;  ///< forms that were guessed first, Quality::kInstant
  };

  /// When what was computed in the background takes the place of what was guessed.
  enum class Replacement {
    kWhenReady,  ///< in whichever step that is
    kWhenAsked,  ///< after finish() alone: the same step in every run
  };

  /// `folder`: where .ambient files of the forms are kept, for other runs and other programs; made
  /// when it is first needed; empty: none. A file that is damaged, foreign or of another version is
  /// made anew; that it cannot be written is told to settings.report. settings.report is called by
  /// the threads that ask and, of Quality::kInstant, by the one in the background.
  explicit FluidBodyCache(CollisionShapeSettings settings = {}, std::filesystem::path folder = {},
                          Replacement replacement = Replacement::kWhenReady);
  /// Waits for the solution that the background is at; others are dropped.
  ~FluidBodyCache() override;

  /// In the shape's frame, named after its kind, or as the settings say, and a number that belongs
  /// to this shape alone and is the same in all programs. Equal shapes get the same object. A
  /// thread that asks for a shape in the making waits for it. Cost if it is known: that of reading
  /// the shape's numbers.
  /// @throws std::runtime_error as makeFluidBody(), each time.
  ///
  /// Of Quality::kInstant the first answer is the guess, within milliseconds, and a thread goes on
  /// to kStandard; later answers are that, and revision() tells. Bodies of Fluid::addAll() then
  /// get it at the end of a substep. settings.flow.threads says how many cores that may take.
  std::shared_ptr<const FluidBody> fluidBody(const btCollisionShape& shape) override;
  unsigned revision() const noexcept override;

  /// The last answer of fluidBody() with this name; null: none. What decodeState() asks for.
  std::shared_ptr<const FluidBody> find(const std::string& name) const;

  /// Waits for all that is computed in the background. From then on, it is what fluidBody() answers
  /// with.
  void finish();

  Counts counts() const;

 private:
  struct Store;
  std::unique_ptr<Store> store_;
};

AMBIENT_END
