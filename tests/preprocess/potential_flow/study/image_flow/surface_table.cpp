#include "tests/preprocess/potential_flow/study/image_flow/surface_table.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>
#include <vector>

#include "bullet_ambient/spatial/inertia.h"
#include "bullet_ambient/spatial/symmetric_eigen.h"
#include "preprocess/waterline/waterline_builder.h"

namespace ambient::study {
namespace {

/// Uniform random direction, from bits of the generator only.
Vector3 randomNormal(std::mt19937& random) {
  const auto uniform = [&] { return static_cast<double>(random()) / 4294967296.0 * 2 - 1; };
  while (true) {
    const Vector3 point(uniform(), uniform(), uniform());
    if (point.squaredNorm() < 1 && point.squaredNorm() > 1e-4) return point.normalized();
  }
}

struct Errors {
  std::vector<double> by_parts;
  std::vector<double> by_table;  ///< bodies with a waterline table

  void add(const SurfaceCase& body, const SurfaceCase& tabulated, const SurfacePlane& plane,
           int panels) {
    const Matrix6 reference = imageInertia(body, plane, panels);
    const Immersion at = immersionOf(body.model, plane);
    by_parts.push_back(largestError(inertiaAt(body.model, at), reference));
    by_table.push_back(largestError(inertiaAt(tabulated.model, at), reference));
  }
};

/// Quantile of values, linear between sorted neighbours.
double quantile(std::vector<double> values, double share) {
  std::sort(values.begin(), values.end());
  const double place = share * static_cast<double>(values.size() - 1);
  const auto i = static_cast<std::size_t>(place);
  const std::size_t next = std::min(i + 1, values.size() - 1);
  return values[i] + (place - static_cast<double>(i)) * (values[next] - values[i]);
}

std::string cellOf(const std::vector<double>& errors) {
  char text[64];
  std::snprintf(text, sizeof text, " %.1f / %.1f / %.1f %% |", 100 * quantile(errors, 0.5),
                100 * quantile(errors, 0.9), 100 * quantile(errors, 1));
  return text;
}

std::string lineOf(const std::string& name, const Errors& afloat, const Errors& anywhere) {
  return "| " + name + " |" + cellOf(afloat.by_parts) + cellOf(afloat.by_table) +
         cellOf(anywhere.by_parts) + cellOf(anywhere.by_table) + "\n";
}

void append(const Errors& more, Errors& all) {
  all.by_parts.insert(all.by_parts.end(), more.by_parts.begin(), more.by_parts.end());
  all.by_table.insert(all.by_table.end(), more.by_table.begin(), more.by_table.end());
}

}  // namespace

Matrix6 imageInertia(const SurfaceCase& body, const SurfacePlane& plane, int panels) {
  return body.model.above.inertia +
         body.model.excess_density * solveImageFlow(body.mesh, plane, panels);
}

double largestError(const Matrix6& inertia, const Matrix6& reference) {
  const Eigen::LLT<Matrix6> root(reference);
  const Matrix6 half = root.matrixL().solve(inertia);
  const Matrix6 ratio = root.matrixL().solve(half.transpose());
  const Vector6 values = symmetricEigen<6>(0.5 * (ratio + ratio.transpose())).values;
  return (values.array() - 1).abs().maxCoeff();
}

double floatingHeight(const SurfaceModel& model, const Vector3& normal) {
  double low = -model.radius, high = model.radius;
  for (int i = 0; i < 50; ++i) {
    const double middle = 0.5 * (low + high);
    const double wet = immersionOf(model, {normal, middle, 1, 1}).wet.volume;
    (wet < 0.5 * model.shape->volume ? low : high) = middle;
  }
  return low;
}

std::string surfaceTable(int poses, int panels, int subdivisions) {
  std::string table =
      "| shape | afloat | with a waterline table | 0.1 to 1.5 of the height | with a table "
      "|\n|---|---|---|---|---|\n";
  std::fputs(table.c_str(), stdout);
  const auto print = [&](const std::string& line) {
    std::fputs(line.c_str(), stdout);
    std::fflush(stdout);
    table += line;
  };
  std::mt19937 random(1);
  Errors all_afloat, all_anywhere;
  for (const SurfaceCase& body : surfaceCases()) {
    const bool is_sphere = body.model.shape->sphere_radius > 0;
    const SurfaceCase tabulated = is_sphere ? body : withWaterline(body, subdivisions);
    Errors afloat, anywhere;
    for (int i = 0; i < poses; ++i) {
      const Vector3 normal = randomNormal(random);
      afloat.add(body, tabulated, {normal, floatingHeight(body.model, normal), 1, 1}, panels);
      const Immersion at = immersionOf(body.model, {normal, 0, 1, 1});
      const double depth = 0.1 + 1.4 * (i + 0.5) / poses;
      anywhere.add(body, tabulated, {normal, at.low + depth * at.size(), 1, 1}, panels);
    }
    print(lineOf(body.shape, afloat, anywhere));
    append(afloat, all_afloat);
    append(anywhere, all_anywhere);
  }
  print(lineOf("all", all_afloat, all_anywhere));
  return table;
}

}  // namespace ambient::study
