#pragma once

#include <vector>

#include "bullet_ambient/fluid_body/fluid_body.h"

namespace ambient {

/// Mirrors through the origin across the axes, each with all others that they make together.
class FaceMirrors {
 public:
  /// Bit 0, 1, 2 of `axes`: the mirror that turns x, y, z round.
  explicit FaceMirrors(unsigned axes);

  /// Number of images of a face, itself among them: 1, 2, 4 or 8.
  int images() const { return static_cast<int>(signs_.size()); }
  /// All faces on the positive sides of the mirrors: each stands there for all of its images.
  FaceTable folded(const FaceTable& faces) const;
  /// Unfolds faces: every face with its images, which share its area.
  FaceTable unfolded(const FaceTable& faces) const;
  /// All faces as the last of the images shows them; for a single mirror the image in it.
  FaceTable mirrored(const FaceTable& faces) const;

 private:
  std::vector<Vector3> signs_;  // of coordinates, for each image
};

}  // namespace ambient
