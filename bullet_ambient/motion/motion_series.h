#pragma once

namespace ambient {

// The power series behind flowWithoutLoads(). Plain data only: it is compiled once per instruction
// set, and must not share an inline function with the rest of the program.

/// Where a body starts and how long it moves.
struct SeriesStart {
  const double* inverse_inertia;  ///< K^-1, 36 entries by columns
  bool has_diagonal_inertia;      ///< only those on its diagonal are read, the others being 0
  double momentum[6];             ///< (l, p) in body axes
  double twist[6];                ///< (w, v) in body axes
  double duration;                ///< [s]
  double precision;               ///< of momentum and turn, relative to the motion
};

/// Where it is after `fraction` of the duration, the largest at which the series is precise.
struct SeriesEnd {
  double fraction;
  double momentum[6];  ///< in body axes of the end
  double way[3];       ///< from the start, in body axes of the end [m]
  double turn[4];      ///< quaternion since the start, (x, y, z, w), not normalised
};

/// No operation is fused: all instruction sets give the same bits.
using SumMotionSeries = SeriesEnd (*)(const SeriesStart&) noexcept;

SeriesEnd sumMotionSeriesBaseline(const SeriesStart&) noexcept;
#if defined(__x86_64__)
SeriesEnd sumMotionSeriesAvx2(const SeriesStart&) noexcept;
#endif

/// Whether this processor has the instructions of sumMotionSeriesAvx2().
bool hasAvx2MotionSeries() noexcept;

}  // namespace ambient
