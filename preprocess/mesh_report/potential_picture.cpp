#include "preprocess/mesh_report/potential_picture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <vector>

#include "bullet_ambient/spatial/ambient_assert.h"

namespace ambient {
namespace {

using Eigen::Index;
using Eigen::Vector3d;

// Of one view, in pixels.
constexpr double kCell = 320, kCaption = 48, kMargin = 30;
// Below this magnitude, over the size (translation) or its square, a potential is rounding and
// discretisation: white.
constexpr double kNothing = 1e-3;

template <class... Values>
std::string format(const char* pattern, Values... values) {
  std::array<char, 512> text{};
  std::snprintf(text.data(), text.size(), pattern, values...);
  return text.data();
}

/// The rows are right, up and towards the eye.
Eigen::Matrix3d makeCamera() {
  const Vector3d eye = Vector3d(0.8, -1, 0.7).normalized();
  const Vector3d right = Vector3d::UnitZ().cross(eye).normalized();
  Eigen::Matrix3d camera;
  camera << right.transpose(), eye.cross(right).transpose(), eye.transpose();
  return camera;
}

/// Blue, white, red for -1, 0, 1, darker where a side is turned away from the light.
std::string colourOf(double value, double light) {
  const Vector3d blue(33, 102, 172), white(247, 247, 247), red(178, 24, 43);
  const Vector3d end = value < 0 ? blue : red;
  const Vector3d colour = light * (white + std::min(1.0, std::abs(value)) * (end - white));
  return format("#%02x%02x%02x", static_cast<int>(colour.x()), static_cast<int>(colour.y()),
                static_cast<int>(colour.z()));
}

/// A triangle as it is seen: its corners [px], and what it needs in every view.
struct SeenTriangle {
  int triangle = 0;
  double depth = 0, light = 1;
  std::string path;
};

std::string pathOf(const TriangleMesh& seen, Index t) {
  // Somewhat larger than it is, so that no seams shine through.
  constexpr double kOverlap = 0.35;
  const Eigen::Vector2d middle =
      ((seen.corner(t, 0) + seen.corner(t, 1) + seen.corner(t, 2)) / 3).head<2>();
  std::string path;
  for (int k = 0; k < 3; ++k) {
    Eigen::Vector2d corner = seen.corner(t, k).head<2>();
    const double distance = (corner - middle).norm();
    if (distance > 0) corner += kOverlap / distance * (corner - middle);
    path += format("%c%.1f,%.1f", k == 0 ? 'M' : 'L', corner.x(), corner.y());
  }
  return path + "z";
}

/// The surface turned to the eye and fitted into a cell: x to the right, y down, z to the eye.
TriangleMesh seenFrom(const Eigen::Matrix3d& camera, TriangleMesh surface) {
  surface.vertices = camera * surface.vertices;
  surface.vertices.row(1) *= -1;
  const Vector3d low = surface.vertices.rowwise().minCoeff(),
                 high = surface.vertices.rowwise().maxCoeff();
  const double scale = (kCell - 2 * kMargin) / (high - low).head<2>().maxCoeff();
  surface.vertices = (scale * (surface.vertices.colwise() - (low + high) / 2)).colwise() +
                     Vector3d(kCell / 2, kCell / 2, 0);
  return surface;
}

/// From the farthest to the nearest; what shows its back is left out, unless it is a sheet.
std::vector<SeenTriangle> sortSeen(const TriangleMesh& seen, bool sheet) {
  std::vector<SeenTriangle> triangles;
  for (Index t = 0; t < seen.triangleCount(); ++t) {
    const Vector3d a = seen.corner(t, 0), b = seen.corner(t, 1), c = seen.corner(t, 2);
    // y runs down, which turns triangles round.
    const Vector3d normal = -(b - a).cross(c - a).normalized();
    if (normal.z() <= 0 && !sheet) continue;
    constexpr double kDark = 0.8;
    const double light = kDark + (1 - kDark) * std::abs(normal.z());
    triangles.push_back({static_cast<int>(t), (a + b + c).z(), light, pathOf(seen, t)});
  }
  std::stable_sort(triangles.begin(), triangles.end(),
                   [](const SeenTriangle& p, const SeenTriangle& q) { return p.depth < q.depth; });
  return triangles;
}

/// The three axes, in the corner of a cell.
std::string drawAxes(const Eigen::Matrix3d& camera) {
  constexpr double kLength = 26, kX = 40, kY = kCell - 30;
  std::string text;
  for (int k = 0; k < 3; ++k) {
    const double x = camera(0, k), y = -camera(1, k);
    text += format(
        "<path d=\"M%.1f,%.1fl%.1f,%.1f\" stroke=\"#444\"/><text x=\"%.1f\" y=\"%.1f\">%c</text>\n",
        kX, kY, kLength * x, kLength * y, kX + 1.35 * kLength * x, kY + 1.35 * kLength * y + 4,
        "xyz"[k]);
  }
  return text;
}

std::string drawView(const std::vector<SeenTriangle>& triangles, const TriangleMesh& surface,
                     const Eigen::VectorXd& potential, double least_range, const char* motion) {
  const double range = std::max(potential.cwiseAbs().maxCoeff(), least_range);
  std::string text;
  for (const SeenTriangle& seen : triangles) {
    double sum = 0;
    for (int k = 0; k < 3; ++k) sum += potential[surface.triangles(k, seen.triangle)];
    text +=
        "<path d=\"" + seen.path + "\" fill=\"" + colourOf(sum / 3 / range, seen.light) + "\"/>\n";
  }
  return text + format(
                    "<text x=\"%g\" y=\"%g\">%s</text>\n"
                    "<text x=\"%g\" y=\"%g\">%.3g to %.3g m²/s</text>\n",
                    kCell / 2, kCell + 10, motion, kCell / 2, kCell + 28, potential.minCoeff(),
                    potential.maxCoeff());
}

}  // namespace

std::string potentialPicture(const TriangleMesh& surface,
                             const Eigen::Matrix<double, Eigen::Dynamic, 6>& potential,
                             bool sheet) {
  AMBIENT_ASSERT(potential.rows() == surface.vertexCount());
  constexpr std::array<const char*, 6> kMotions{
      "turns about x at 1 rad/s", "turns about y at 1 rad/s", "turns about z at 1 rad/s",
      "moves along x at 1 m/s",   "moves along y at 1 m/s",   "moves along z at 1 m/s"};
  const Eigen::Matrix3d camera = makeCamera();
  const std::vector<SeenTriangle> triangles = sortSeen(seenFrom(camera, surface), sheet);
  const double size = surface.extents().norm();
  const double width = 3 * kCell, height = 2 * (kCell + kCaption) + kCaption;
  std::string text = format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"%g\" height=\"%g\" viewBox=\"0 0 %g %g\" "
      "font-family=\"sans-serif\" font-size=\"13\" text-anchor=\"middle\">\n"
      "<rect width=\"100%%\" height=\"100%%\" fill=\"white\"/>\n"
      "<text x=\"%g\" y=\"28\" font-size=\"15\">%s (blue: below zero, red: above)</text>\n",
      width, height, width, height, width / 2,
      sheet ? "Jump of the potential, front minus back" : "Potential of the flow on the surface");
  for (int motion = 0; motion < 6; ++motion) {
    const bool turns = motion < 3;
    // Translations first.
    text += format("<g transform=\"translate(%g %g)\">\n", kCell * (motion % 3),
                   kCaption + (turns ? kCell + kCaption : 0));
    text += drawView(triangles, surface, potential.col(motion),
                     kNothing * (turns ? size * size : size), kMotions[motion]);
    text += drawAxes(camera) + "</g>\n";
  }
  return text + "</svg>\n";
}

}  // namespace ambient
