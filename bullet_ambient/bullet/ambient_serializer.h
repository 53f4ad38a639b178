#pragma once

#include <LinearMath/btSerializer.h>

#include <string>
#include <string_view>

#include "bullet_ambient/bullet/precision_check.h"
#include "bullet_ambient/bullet/world_state.h"

namespace ambient {
inline namespace BULLET_AMBIENT_PRECISION_NAMESPACE {

/// Code of the chunk that carries the saved state in a .bullet file. Loaders that do not know it
/// skip it.
constexpr int kAmbientChunkCode = BT_MAKE_ID('A', 'M', 'B', 'I');

/// Saves a world with its fluids: world.serialize(&serializer) writes what btDefaultSerializer
/// does, and a chunk with saveState(). Load the file with btBulletWorldImporter into an empty
/// world, then call restoreState(readAmbientChunk(...)): that attaches the bodies to their fluids
/// again, and brings back what Bullet's format leaves out, like velocities.
class AmbientSerializer : public btDefaultSerializer {
 public:
  /// Both must outlive the serializer; the world is the one that is serialized.
  AmbientSerializer(const btDynamicsWorld& world, const AmbientRegistry& registry)
      : world_(world), registry_(registry) {}

  void finishSerialization() override;

 private:
  const btDynamicsWorld& world_;
  const AmbientRegistry& registry_;
};

/// The saved state in the bytes of a .bullet file of this machine's byte order and pointer size;
/// `source` stands for the file in messages.
/// @throws std::runtime_error if there is none, and as decodeState().
WorldState readAmbientChunk(std::string_view file, const std::string& source,
                            const FluidBodyLookup& lookup);

}  // namespace BULLET_AMBIENT_PRECISION_NAMESPACE
}  // namespace ambient
