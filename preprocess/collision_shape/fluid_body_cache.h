#pragma once

#include <memory>
#include <string>
#include <vector>

#include "bullet_ambient/attach_world.h"
#include "bullet_ambient/bullet/core/precision_check.h"
#include "preprocess/collision_shape/collision_shape_body.h"

AMBIENT_BEGIN

/// Makes and keeps the fluid bodies of collision shapes. Shapes with equal numbers share one fluid
/// body; shapes that differ in size alone, or are images of each other across planes of their
/// frame, as the limbs of a robot, are solved once: scaled, and turned over by firstImage(). Forms
/// without a flow to solve, those of spheres, boxes, cylinders, capsules and cones, are made again
/// where more than 16 others came in between. May be shared by worlds and threads; shapes must not
/// change during a call.
///
/// A form is solved at size 1, with its numbers rounded to a millionth: the result depends on the
/// shape alone, not on earlier shapes.
class FluidBodyCache : public FluidBodySource {
 public:
  using Counts = BodyMaker::Counts;

  /// `folder`: where the forms are kept for other runs and programs. Damaged, foreign or outdated
  /// files are made again. settings.report is told of a file that cannot be written, and once a
  /// second of work that takes longer, by one thread at a time.
  explicit FluidBodyCache(CollisionShapeSettings settings = {}, BodyFolder folder = {});
  ~FluidBodyCache() override;

  /// Returns the fluid body of a shape, in the shape's frame, without the faces that follow from
  /// its surface, see facesOf(). Its name is the kind of the shape (or settings.name) and a number
  /// that is unique to the shape and the same in all programs. Equal shapes get the same object. If
  /// another thread is making the fluid body, waits for it. Cost if it is known: that of reading
  /// the shape's numbers. @throws std::runtime_error as makeFluidBody(), in every call.
  std::shared_ptr<const FluidBody> fluidBody(const btCollisionShape& shape) override;
  std::shared_ptr<const FluidBody> fluidBodyOf(const std::function<std::string()>& whose,
                                               const btCollisionShape& shape) override;
  /// Once one of the expected bodies has to be made, all that take long are, side by side on
  /// settings.flow.threads threads.
  void expect(const Expected* expected) noexcept override;

  /// Finds the last result of fluidBody() with a name; null: none. A FluidBodyLookup for
  /// decodeState().
  std::shared_ptr<const FluidBody> find(const std::string& name) const;

  /// Returns what settings.report was told, or would have been, of the form of a result of
  /// fluidBody(), in the metres of the shape that it was made for. Lines about the work itself are
  /// not in it.
  std::vector<std::string> said(const FluidBody& body) const { return body.provenance.said; }

  Counts counts() const;

 private:
  struct Store;
  std::unique_ptr<Store> store_;
};

AMBIENT_END
