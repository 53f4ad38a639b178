#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "bullet_ambient/fluid_body/fluid_body.h"
#include "preprocess/collision_shape/collision_shape_body.h"
#include "preprocess/shape/shape_description.h"

namespace ambient {

/// The fluid bodies of a program's runs, each solved once: within a scene by memory, between runs
/// by .ambient files in a folder, kept as FluidBodyCache keeps them: a file is read again where
/// readIfSame(), so that an edited mesh or another revision of the solver does not meet an old one.
///
/// Unlike a FluidBodyCache, it solves shapes at their own size, without tables, so that the bits of
/// published scenes stay, takes shapes in JSON, and writes only when it is told to.
class SceneBodyCache {
 public:
  /// `folder` need not exist; empty: no files. `threads` solve; 0: all cores.
  explicit SceneBodyCache(std::filesystem::path folder = {}, int threads = 0);

  /// `waterline_subdivisions` as in BuildSettings.
  /// @throws std::runtime_error in one line that names the file or the shape's source.
  std::shared_ptr<const FluidBody> get(const ShapeDescription& shape, const std::string& name,
                                       int waterline_subdivisions = 0);
  /// That of what a link collides with, in the shape's frame. @throws as makeFluidBody()
  std::shared_ptr<const FluidBody> get(const btCollisionShape& shape, const std::string& name);

  /// Writes what was solved since it was made. @throws std::runtime_error as writeFluidBody().
  void save();

  /// What a user should know about the meshes, one line each.
  const std::vector<std::string>& warnings() const { return warnings_; }
  int solved() const { return static_cast<int>(unsaved_.size()); }

 private:
  std::shared_ptr<const FluidBody> readOrBuild(const ShapeDescription& shape,
                                               const std::string& name, int waterline_subdivisions);
  /// From the folder, if it is there; else what `build` returns, which save() then writes.
  std::shared_ptr<const FluidBody> readOr(const std::string& name, const Provenance& provenance,
                                          const std::function<FluidBody()>& build);

  std::filesystem::path folder_;
  int threads_;
  std::map<std::string, std::shared_ptr<const FluidBody>> by_text_;
  std::map<std::filesystem::path, std::shared_ptr<const FluidBody>> unsaved_;
  std::vector<std::string> warnings_;
};

}  // namespace ambient
