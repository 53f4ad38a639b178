#pragma once

#include <vector>

#include "bullet_ambient/fluid_body/fluid_body.h"

namespace ambient {

/// Group of mirrors across planes through the origin, perpendicular to axes of the frame.
class FaceMirrors {
 public:
  /// Bit 0, 1, 2 of `axes`: the mirror that turns x, y, z round.
  explicit FaceMirrors(unsigned axes);

  /// Number of images of a face, itself among them: 1, 2, 4 or 8.
  int images() const { return static_cast<int>(signs_.size()); }
  /// Returns the faces on the positive sides of all mirrors, each for all of its images.
  FaceTable folded(const FaceTable& faces) const;
  /// Unfolds faces: every face with its images, which share its area.
  FaceTable unfolded(const FaceTable& faces) const;
  /// Returns all faces mirrored by all mirrors at once.
  FaceTable mirrored(const FaceTable& faces) const;

 private:
  std::vector<Vector3> signs_;  // of coordinates, for each image
};

}  // namespace ambient
