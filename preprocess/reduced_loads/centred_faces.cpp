#include "preprocess/reduced_loads/centred_faces.h"

#include <cmath>
#include <stdexcept>

namespace ambient {

CentredFaces::CentredFaces(const FluidBody& body, const FaceTable& source) {
  double area = 0, moment = 0;
  for (std::size_t i = 0; i < source.size(); ++i) {
    area += source.area[i];
    centre += source.area[i] * source.centroid(i);
  }
  if (area > 0) centre /= area;
  for (std::size_t i = 0; i < source.size(); ++i)
    moment += source.area[i] * (source.centroid(i) - centre).squaredNorm();
  if (area > 0) length = std::sqrt(moment / area);
  if (!(length > 0)) {
    throw std::invalid_argument("fluid body '" + body.name +
                                "': reduced loads need faces that are apart and have an area");
  }
  for (std::size_t i = 0; i < source.size(); ++i)
    faces.add(source.normal(i), (source.centroid(i) - centre) / length,
              source.area[i] / (length * length));
  faces.sharpness = source.sharpness;
}

void CentredFaces::moveBack(FaceTable& of_level) const {
  FaceTable moved;
  for (std::size_t i = 0; i < of_level.size(); ++i)
    moved.add(of_level.normal(i), centre + length * of_level.centroid(i),
              length * length * of_level.area[i]);
  moved.sharpness = std::move(of_level.sharpness);
  of_level = std::move(moved);
}

}  // namespace ambient
