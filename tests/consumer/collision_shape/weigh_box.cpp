// Prints the added mass of a cube of 2 m in water along x: weigh_box
#include <btBulletCollisionCommon.h>

#include <cstdio>
#include <exception>

#include "preprocess/collision_shape.h"

int main() try {
  const btBoxShape cube(btVector3(1, 1, 1));
  const ambient::FluidBody body = ambient::makeFluidBody(cube);
  std::printf("%g kg\n", 1000 * body.added_mass(3, 3));
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
