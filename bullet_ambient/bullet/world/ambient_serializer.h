#pragma once

#include <LinearMath/btSerializer.h>

#include <string>
#include <string_view>

#include "bullet_ambient/bullet/core/precision_check.h"
#include "bullet_ambient/bullet/state/world_state.h"

AMBIENT_BEGIN

class Fluid;

/// Code of the chunk that carries the saved state in a .bullet file. Loaders that do not know it
/// skip it.
constexpr int kAmbientChunkCode = BT_MAKE_ID('A', 'M', 'B', 'I');

/// Saves a world with its fluids: world.serialize(&serializer) writes what btDefaultSerializer
/// does, and a chunk with Fluid::save(). Load the file with btBulletWorldImporter into an empty
/// world, then call Fluid::restore(readAmbientChunk(...)): that puts the bodies into their fluids
/// again, and brings back what Bullet's format leaves out, like velocities.
class AmbientSerializer : public btDefaultSerializer {
 public:
  /// `fluid`: the Fluid of the serialized world; must outlive the serializer.
  explicit AmbientSerializer(const Fluid& fluid) : fluid_(fluid) {}

  void finishSerialization() override;

 private:
  const Fluid& fluid_;
};

/// Reads the saved state from the bytes of a .bullet file of this machine's byte order and pointer
/// size; messages name `source`. @throws std::runtime_error if the file holds no saved state, and
/// as decodeState().
WorldState readAmbientChunk(std::string_view file, const std::string& source,
                            const FluidBodyLookup& lookup);

AMBIENT_END
