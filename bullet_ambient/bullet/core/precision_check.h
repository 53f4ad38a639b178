#pragma once

// Bullet is built for float or for double, and nothing in its binaries tells which: mixing them
// corrupts memory without a word. Every header of this box includes this one, and makes its
// declarations between AMBIENT_BEGIN and AMBIENT_END: in an inline namespace of `ambient` that
// names the precision. A mixture then fails in the compiler with a sentence below, or in the linker
// with the namespace's name in the missing symbol.

#if !defined(BULLET_AMBIENT_FLOAT64)
#error \
    "bullet_ambient: it is not known which precision of Bullet this program uses. Link BulletAmbient::bullet_ambient (Bullet in float) or BulletAmbient::bullet_ambient-float64 (Bullet in double), or take the flags of pkg-config bullet_ambient or bullet_ambient-float64."
#elif BULLET_AMBIENT_FLOAT64 && !defined(BT_USE_DOUBLE_PRECISION)
#error \
    "bullet_ambient: this file sees Bullet's headers in float (BT_USE_DOUBLE_PRECISION is not defined) but links bullet_ambient-float64, which is built for Bullet in double. Link BulletAmbient::bullet_ambient instead, or use the double precision Bullet everywhere."
#elif !BULLET_AMBIENT_FLOAT64 && defined(BT_USE_DOUBLE_PRECISION)
#error \
    "bullet_ambient: this file sees Bullet's headers in double (BT_USE_DOUBLE_PRECISION is defined) but links bullet_ambient, which is built for Bullet in float. Link BulletAmbient::bullet_ambient-float64 instead, or use the single precision Bullet everywhere."
#endif

#if BULLET_AMBIENT_FLOAT64
#define AMBIENT_BEGIN \
  namespace ambient { \
  inline namespace built_for_bullet_float64 {
#else
#define AMBIENT_BEGIN \
  namespace ambient { \
  inline namespace built_for_bullet_float32 {
#endif
#define AMBIENT_END \
  }                 \
  }
