#pragma once

#include "bullet_ambient/bullet/precision_check.h"

namespace ambient {
inline namespace BULLET_AMBIENT_PRECISION_NAMESPACE {

/// What was computed for one body since it was attached.
struct AmbientCounters {
  long long substeps = 0;  ///< of free flight
  long long load_evaluations = 0;
  long long faces = 0;    ///< faces or clusters summed in them; a sphere has none
  long long guarded = 0;  ///< load evaluations in which the passivity guard acted
  long long coarse =
      0;  ///< steps whose error stayed above the tolerance at the largest substep count
  long long rows = 0;      ///< constraint rows rewritten
  long long rejected = 0;  ///< steps whose result was not finite and was not taken over

  AmbientCounters& operator+=(const AmbientCounters& other);
};

}  // namespace BULLET_AMBIENT_PRECISION_NAMESPACE
}  // namespace ambient
