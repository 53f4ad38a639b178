#pragma once

#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "bullet_ambient/fluid_body/fluid_body.h"
#include "preprocess/builder/body_maker.h"
#include "preprocess/collision_shape/form_body.h"
#include "preprocess/shape/shapes.h"

class btCollisionShape;

namespace ambient {

/// Cache of the fluid bodies of a program's runs; each is solved once. Keeps bodies in memory and,
/// between programs, in a folder, like FluidBodyCache. A file is reused only if readIfSame()
/// accepts it: an edited mesh or another revision of the solver needs a new one.
///
/// Boxes, cylinders, capsules and cones are made as Fluid::addAll() makes them from collision
/// shapes: their added mass is looked up, and few faces carry the loads of the form law.
///
/// Differences to FluidBodyCache: makes shapes at their own size; accepts shapes in JSON; writes
/// files only in save().
class SceneBodyCache {
 public:
  /// threads: threads of the solver; 0: all cores. report: see BodyMaker; default: standard error.
  explicit SceneBodyCache(BodyFolder folder = {}, int threads = 0,
                          BodyMaker::Report report = printReport);

  /// Fluid body of a shape; waterline_subdivisions: see BuildSettings.
  /// @throws std::runtime_error in one line that names the file or the shape's source.
  std::shared_ptr<const FluidBody> get(const ShapeDescription& shape, const std::string& name,
                                       int waterline_subdivisions = 0);
  /// Fluid body of a link's collision shape, in the shape's frame. @throws as makeFluidBody()
  std::shared_ptr<const FluidBody> get(const btCollisionShape& shape, const std::string& name);

  /// Says for whom get() works next, for lines about work that takes long: "body 3 of 14".
  void announce(std::string whose) { whose_ = std::move(whose); }

  /// Writes the bodies made by this object since the last call; what cannot be written is reported.
  void save();

  /// Gives warnings about a mesh to the report, one line each.
  void warn(const std::vector<std::string>& warnings) {
    for (const std::string& warning : warnings) maker_.say(warning);
  }
  int solved() const { return maker_.counts().made; }

 private:
  CollisionShapeSettings solidSettings(const std::string& name);
  std::shared_ptr<const FluidBody> readOrBuild(const ShapeDescription& shape,
                                               const std::string& name, int waterline_subdivisions);
  /// Reads or makes the fluid body of a box, cylinder, capsule or cone. A build with
  /// BULLET_AMBIENT_WHOLE_DEMO=OFF refuses them.
  std::shared_ptr<const FluidBody> readOrMakeSolid(const ShapeDescription& shape,
                                                   const std::string& name,
                                                   int waterline_subdivisions);
  /// Reads a body from the folder, or else calls `make`, whose result save() will write.
  std::shared_ptr<const FluidBody> readOr(const std::string& name, const Provenance& provenance,
                                          const BodyMaker::Make& make);

  BodyMaker maker_;
  int threads_;
  std::string whose_;
  std::map<std::string, std::shared_ptr<const FluidBody>> by_text_;
  std::vector<BodyMaker::Made> unsaved_;
};

}  // namespace ambient
