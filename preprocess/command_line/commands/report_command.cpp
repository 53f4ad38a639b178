#include <iostream>
#include <memory>
#include <sstream>

#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/base/plain_text.h"
#include "preprocess/builder/elapsed_display.h"
#include "preprocess/command_line/commands.h"
#include "preprocess/command_line/input_shape.h"
#include "preprocess/command_line/json_numbers.h"
#include "preprocess/command_line/option_values.h"
#include "preprocess/mesh/input_error.h"
#include "preprocess/mesh/usual_size.h"
#include "preprocess/mesh_report/mesh_report.h"
#include "preprocess/shape/shape_mesh.h"

namespace ambient {
namespace {

using nlohmann::ordered_json;

/// Options of ambient_preprocess report; its help says what they mean.
struct ReportArguments {
  std::string input;
  InputOptions options;
  int panels = kDefaultPanels, threads = 0;
  bool json = false;
};

constexpr double kDegree = kPi / 180;

ordered_json levelJson(const FlowLevel& level) {
  return {{"panels", level.panels},
          {"seconds", level.seconds},
          {"asymmetry", level.asymmetry},
          {"condition", level.condition > 0 ? ordered_json(level.condition) : ordered_json()},
          {"added_mass", matrixJson(level.added_mass)}};
}

std::string asJson(const MeshReport& report, const TriangleMesh& mesh) {
  ordered_json worst = ordered_json::array();
  for (const TriangleQuality& t : report.worst_triangles) {
    worst.push_back({{"triangle", t.triangle},
                     {"aspect", t.aspect},
                     {"smallest_angle", t.smallest_angle},
                     {"barycentre", vectorJson(t.barycentre)}});
  }
  ordered_json text{{"vertices", mesh.vertexCount()},
                    {"faces", mesh.triangleCount()},
                    {"size", vectorJson(mesh.extents())},
                    {"origin", vectorJson(report.origin)},
                    {"built", levelJson(report.built)}};
  if (report.other) {
    text["other"] = levelJson(*report.other);
    text["rotation_error"] = report.rotation_error;
    text["translation_error"] = report.translation_error;
    text["extrapolated"] = matrixJson(report.extrapolated);
  } else {
    text["other"] = nullptr;
  }
  if (report.build) {
    text["build"] = {{"panels", report.build->panels},
                     {"coarse_panels", report.build->coarse_panels},
                     {"rotation_error", report.build->rotation_error},
                     {"translation_error", report.build->translation_error},
                     {"added_mass", matrixJson(report.build->added_mass)}};
  } else {
    text["build"] = nullptr;
  }
  if (report.thinnest) {
    text["thinnest"] = {{"thickness", report.thinnest->thickness},
                        {"triangle", report.thinnest->triangle},
                        {"barycentre", vectorJson(report.thinnest->barycentre)}};
  }
  text["worst_triangles"] = worst;
  return jsonText(text);
}

std::string placeText(int triangle, const Eigen::Vector3d& point) {
  std::ostringstream text;
  text.precision(6);
  text << "triangle " << triangle << " at (" << point.x() << ", " << point.y() << ", " << point.z()
       << ")";
  return text.str();
}

std::string asTable(const MeshReport& report, const TriangleMesh& mesh) {
  std::ostringstream text;
  text.precision(3);
  const auto level = [&](const char* label, const FlowLevel& flow) {
    text << label << flow.panels << " panels, " << flow.seconds << " s, ";
    if (flow.condition > 0) {
      text << "condition " << flow.condition;
    } else {
      text << "condition not known (solved iteratively)";
    }
    text << ", asymmetry " << flow.asymmetry << "\n";
  };
  text << "mesh             " << mesh.vertexCount() << " vertices, " << mesh.triangleCount()
       << " faces, " << extentsText(mesh.extents()) << "\n";
  level("flow             ", report.built);
  const auto errors = [&](const char* label, double rotation, double translation) {
    text << label << 100 * rotation << " % in rotation, " << 100 * translation
         << " % in translation";
  };
  if (report.other) {
    level("compared with    ", *report.other);
    errors("estimated error  ", report.rotation_error, report.translation_error);
    text << "\n";
  } else {
    text << "estimated error  none: the mesh is too large to be solved on more panels\n";
  }
  if (report.build) {
    errors("error of build   ", report.build->rotation_error, report.build->translation_error);
    text << ", the difference to a build on " << report.build->coarse_panels << " panels\n";
  } else {
    text << "error of build   not known: it does not divide this mesh\n";
  }
  if (report.thinnest) {
    text << "thinnest part    " << report.thinnest->thickness << " m, "
         << placeText(report.thinnest->triangle, report.thinnest->barycentre) << "\n";
  }
  for (const TriangleQuality& t : report.worst_triangles) {
    text << "worst triangle   aspect " << t.aspect << ", smallest angle "
         << t.smallest_angle / kDegree << " degrees, " << placeText(t.triangle, t.barycentre)
         << "\n";
  }
  return text.str();
}

void runReport(const ReportArguments& arguments) {
  requirePositive("--scale", arguments.options.scale);
  requireDivisions("--panels", arguments.panels);
  requireThreads(arguments.threads);
  const ShapeDescription shape = describeInput(arguments.input, arguments.options);
  const CheckedMesh checked = makeShapeMesh(shape, arguments.options.scale);
  requireUsualSize(checked.mesh, isSheet(shape), shape.source);
  for (const std::string& warning : checked.warnings)
    std::cerr << "warning: " << plainLine(warning) << "\n";
  PotentialFlowSettings settings;
  settings.sheet = isSheet(shape);
  settings.max_panels = arguments.panels;
  settings.threads = arguments.threads;
  MeshReport report;
  {
    const ElapsedDisplay display("solving " + arguments.input);
    try {
      report = makeMeshReport(checked.mesh, settings);
    } catch (const std::runtime_error& error) {
      raiseInputError(arguments.input, error.what());
    }
  }
  std::cout << (arguments.json ? asJson(report, checked.mesh) : asTable(report, checked.mesh));
}

}  // namespace

void addReport(CLI::App& app) {
  const auto arguments = std::make_shared<ReportArguments>();
  CLI::App& command = *app.add_subcommand(
      "report", "Estimates the error of a mesh and shows its thinnest part and worst triangles");
  command.add_option("INPUT", arguments->input, "A mesh, or a JSON file with a shape")->required();
  addOption(command, "--scale", arguments->options.scale, "S",
            "Multiplies all lengths (default 1)");
  command.add_flag("--sheet", arguments->options.sheet,
                   "The mesh is an open surface of zero thickness");
  addOption(command, "--panels", arguments->panels, "N", "As for build (default 4200)");
  addOption(command, "--threads", arguments->threads, "N", "0: all cores (default)");
  addJson(command, arguments->json);
  command.callback([arguments] { runReport(*arguments); });
}

}  // namespace ambient
