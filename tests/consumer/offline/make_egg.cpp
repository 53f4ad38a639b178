// Writes the fluid body of an ellipsoid: make_egg FILE.ambient
#include <cstdio>
#include <exception>

#include "bullet_ambient/fluid_body.h"
#include "preprocess/build.h"
#include "preprocess/mesh.h"

int main(int argc, char** argv) try {
  if (argc != 2) {
    std::fprintf(stderr, "usage: make_egg FILE.ambient\n");
    return 2;
  }
  ambient::BuildSettings settings;
  settings.name = "egg";
  const ambient::TriangleMesh mesh = ambient::makeEllipsoidMesh({0.02, 0.02, 0.03}, 300);
  ambient::writeFluidBody(ambient::makeFluidBody(mesh, settings), argv[1]);
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
