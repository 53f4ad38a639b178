#pragma once

#include <filesystem>
#include <memory>

#include "bullet_ambient/bullet/fluid_body_source.h"
#include "bullet_ambient/bullet/precision_check.h"
#include "preprocess/collision_shape/collision_shape_body.h"

namespace ambient {
inline namespace BULLET_AMBIENT_PRECISION_NAMESPACE {

/// The fluid bodies of collision shapes, each made once: shapes of equal numbers are one, wherever
/// they are in memory, and those that differ by their size alone are solved once and scaled. May be
/// shared by worlds and threads, whose shapes must not change meanwhile.
///
/// A form is solved at a size of 1 and its numbers rounded to a millionth, so that what a shape
/// gets depends on the shape alone, not on those that came before.
class FluidBodyCache : public FluidBodySource {
 public:
  struct Counts {
    int made = 0;  ///< forms that were solved
    int read = 0;  ///< forms that were read from the folder
  };

  /// `folder`: where .ambient files of the forms are kept, for other runs and other programs; made
  /// when it is first needed; empty: none. A file that is damaged, foreign or of another version is
  /// made anew; that it cannot be written is told to settings.report. settings.report is called by
  /// the threads that ask.
  explicit FluidBodyCache(CollisionShapeSettings settings = {}, std::filesystem::path folder = {});
  ~FluidBodyCache() override;

  /// In the shape's frame, named after its kind or as the settings say. Equal shapes get the same
  /// object. A thread that asks for a shape in the making waits for it. Cost if it is known: that
  /// of reading the shape's numbers.
  /// @throws std::runtime_error as makeFluidBody(), each time.
  std::shared_ptr<const FluidBody> fluidBody(const btCollisionShape& shape) override;

  Counts counts() const;

 private:
  struct Store;
  std::unique_ptr<Store> store_;
};

}  // namespace BULLET_AMBIENT_PRECISION_NAMESPACE
}  // namespace ambient
