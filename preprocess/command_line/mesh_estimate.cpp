#include "preprocess/command_line/mesh_estimate.h"

#include <sstream>
#include <stdexcept>

#include "bullet_ambient/base/pi.h"
#include "preprocess/builder/elapsed_display.h"
#include "preprocess/command_line/json_numbers.h"
#include "preprocess/mesh/input_error.h"

namespace ambient {
namespace {

using nlohmann::ordered_json;

std::string placeText(int triangle, const Eigen::Vector3d& point) {
  std::ostringstream text;
  text.precision(6);
  text << "triangle " << triangle << " at (" << point.x() << ", " << point.y() << ", " << point.z()
       << ")";
  return text.str();
}

}  // namespace

MeshEstimate estimateMesh(const TriangleMesh& mesh, const PotentialFlowSettings& settings,
                          const std::string& name) {
  const ElapsedDisplay display("solving " + name);
  MeshEstimate estimate;
  estimate.worst_triangles = findWorstTriangles(mesh, 3);
  if (!settings.sheet) estimate.thinnest = findThinnestPart(mesh);
  try {
    estimate.flow = estimateFlow(mesh, settings);
  } catch (const std::runtime_error& error) {
    raiseInputError(name, error.what());
  }
  return estimate;
}

ordered_json estimateJson(const MeshEstimate& estimate) {
  ordered_json worst = ordered_json::array(), text;
  for (const TriangleQuality& t : estimate.worst_triangles) {
    worst.push_back({{"triangle", t.triangle},
                     {"aspect", t.aspect},
                     {"smallest_angle", t.smallest_angle},
                     {"barycentre", vectorJson(t.barycentre)}});
  }
  if (const auto& flow = estimate.flow) {
    text = {{"panels", flow->panels},
            {"other_panels", flow->other_panels},
            {"rotation_error", flow->rotation_error},
            {"translation_error", flow->translation_error}};
  }
  if (const auto& thinnest = estimate.thinnest) {
    text["thinnest"] = {{"thickness", thinnest->thickness},
                        {"triangle", thinnest->triangle},
                        {"barycentre", vectorJson(thinnest->barycentre)}};
  }
  text["worst_triangles"] = worst;
  return text;
}

std::string estimateTable(const MeshEstimate& estimate) {
  constexpr double kDegree = kPi / 180;
  std::ostringstream text;
  text.precision(3);
  text << "estimated error  ";
  if (const auto& flow = estimate.flow) {
    text << 100 * flow->rotation_error << " % in rotation, " << 100 * flow->translation_error
         << " % in translation, from " << flow->panels << " and " << flow->other_panels
         << " panels\n";
  } else {
    text << "none: the mesh is too large to be solved on more panels\n";
  }
  if (const auto& thinnest = estimate.thinnest) {
    text << "thinnest part    " << thinnest->thickness << " m, "
         << placeText(thinnest->triangle, thinnest->barycentre) << "\n";
  }
  for (const TriangleQuality& t : estimate.worst_triangles) {
    text << "worst triangle   aspect " << t.aspect << ", smallest angle "
         << t.smallest_angle / kDegree << " degrees, " << placeText(t.triangle, t.barycentre)
         << "\n";
  }
  return text.str();
}

}  // namespace ambient
