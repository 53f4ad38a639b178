#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

class btCollisionShape;

namespace ambient {

/// A collision shape of a world, and the dynamic bodies with this shape.
struct WorldShape {
  std::string name;  ///< unique in the file, fit for a file name
  const btCollisionShape* shape = nullptr;
  std::vector<std::string> bodies;  ///< names; "body <number>" for those without
};

/// The content of a .bullet file, as btDynamicsWorld::serialize() writes it, in either precision.
class WorldFile {
 public:
  /// Header, chunks and the description of structures are checked; what the structures hold is
  /// followed without checks, as Bullet does: read files that you trust.
  /// @throws std::runtime_error in one line that names the file, if it cannot be read, is not a
  /// .bullet file or a damaged one, or Bullet refuses it.
  explicit WorldFile(const std::filesystem::path& file);
  ~WorldFile();

  /// Distinct shapes of bodies with mass, in the order of the bodies. A shape is named after its
  /// body if there is only one, else by its own name, else after its first body.
  const std::vector<WorldShape>& dynamicShapes() const { return shapes_; }
  /// Bodies that Bullet's importer left out because it does not know their shape.
  int lostBodies() const { return lost_bodies_; }
  /// Bodies of joints that Bullet's importer does not read.
  int multibodies() const { return multibodies_; }

 private:
  struct Importer;
  std::unique_ptr<Importer> importer_;
  std::vector<WorldShape> shapes_;
  int lost_bodies_ = 0;
  int multibodies_ = 0;
};

}  // namespace ambient
