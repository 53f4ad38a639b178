#include <iostream>
#include <memory>
#include <optional>
#include <sstream>

#include "bullet_ambient/base/plain_text.h"
#include "preprocess/base/output_file.h"
#include "preprocess/builder/blocked_signals.h"
#include "preprocess/command_line/commands.h"
#include "preprocess/command_line/input_shape.h"
#include "preprocess/command_line/json_numbers.h"
#include "preprocess/command_line/mesh_estimate.h"
#include "preprocess/command_line/option_values.h"
#include "preprocess/command_line/output_place.h"
#include "preprocess/mesh/check/mesh_diagnosis.h"
#include "preprocess/mesh/import/mesh_import.h"
#include "preprocess/mesh/input_error.h"
#include "preprocess/mesh/mass_properties.h"
#include "preprocess/mesh/usual_size.h"
#include "preprocess/shape/shape_mesh.h"

namespace ambient {
namespace {

using nlohmann::ordered_json;

/// Options of ambient_preprocess check; its help says what they mean.
struct CheckArguments {
  std::string input;
  InputOptions options;
  std::string obj;
  bool estimate = false;
  int panels = kDefaultPanels, threads = 0;
  bool json = false;
};

/// The input, read once.
struct ReadInput {
  const CheckArguments& arguments;
  ImportedMesh imported;
};

/// Result of trying to use the input with one option.
struct Outcome {
  std::string option;                 ///< empty: as it is
  std::optional<CheckedMesh> usable;  ///< what would be built
  std::string refusal;
};

/// Reads and checks the input with the options as build would, without solving the flow.
Outcome tryOption(const ReadInput& input, const std::string& option, const InputOptions& options) {
  Outcome outcome{option, std::nullopt, {}};
  try {
    const ShapeDescription shape = describeInput(input.arguments.input, options);
    CheckedMesh checked = makeShapeMesh(shape, input.imported, input.arguments.options.scale);
    requireUsualSize(checked.mesh, isSheet(shape), shape.source);
    outcome.usable = std::move(checked);
  } catch (const std::runtime_error& error) {
    outcome.refusal = error.what();
  }
  return outcome;
}

Outcome tryAsAsked(const ReadInput& input) {
  const InputOptions& options = input.arguments.options;
  std::string option = options.sheet ? "--sheet" : options.hull ? "--hull" : "";
  if (options.wrap) option = *options.wrap == kDefaultWrap ? "--wrap" : "--wrap " + *options.wrap;
  return tryOption(input, option, options);
}

/// Tries the options that may make an input usable that cannot be built as it is.
std::vector<Outcome> tryRemedies(const ReadInput& input) {
  const InputOptions& asked = input.arguments.options;
  if (asked.sheet || asked.hull || asked.wrap) return {};
  std::vector<Outcome> remedies;
  const auto add = [&](const char* option, const InputOptions& options) {
    remedies.push_back(tryOption(input, option, options));
  };
  if (!hasExtension(input.arguments.input, ".json"))
    add("--sheet", {true, false, std::nullopt, asked.scale});
  add("--hull", {false, true, std::nullopt, asked.scale});
  add("--wrap", {false, false, kDefaultWrap, asked.scale});
  return remedies;
}

double volumeOf(const Outcome& outcome) {
  return outcome.option == "--sheet" ? 0 : computeMassProperties(outcome.usable->mesh).volume;
}

ordered_json outcomeJson(const Outcome& outcome) {
  ordered_json json{{"option", outcome.option}, {"usable", outcome.usable.has_value()}};
  if (!outcome.usable) {
    json["refusal"] = outcome.refusal;
    return json;
  }
  json["faces"] = outcome.usable->mesh.triangleCount();
  json["size"] = vectorJson(outcome.usable->mesh.extents());
  json["volume"] = volumeOf(outcome);
  json["warnings"] = outcome.usable->warnings;
  return json;
}

std::string asJson(const Outcome& asked, const std::vector<MeshDefect>& defects,
                   const std::vector<Outcome>& remedies,
                   const std::optional<MeshEstimate>& estimate) {
  ordered_json text = outcomeJson(asked);
  text["defects"] = ordered_json::array();
  for (const MeshDefect& defect : defects) {
    text["defects"].push_back(
        {{"kind", defect.kind}, {"text", defect.text}, {"triangles", defect.triangles}});
  }
  text["remedies"] = ordered_json::array();
  for (const Outcome& remedy : remedies) text["remedies"].push_back(outcomeJson(remedy));
  if (estimate) text["estimate"] = estimateJson(*estimate);
  return jsonText(text);
}

std::string lineOf(const std::string& label, const Outcome& outcome) {
  std::ostringstream text;
  text.precision(4);
  text << label << std::string(label.size() < 17 ? 17 - label.size() : 1, ' ');
  if (!outcome.usable) return text.str() + plainLine(outcome.refusal) + "\n";
  const TriangleMesh& mesh = outcome.usable->mesh;
  text << "usable: " << mesh.triangleCount() << " faces, " << extentsText(mesh.extents());
  if (outcome.option != "--sheet") text << ", volume " << volumeOf(outcome) << " m^3";
  return text.str() + "\n";
}

std::string asTable(const Outcome& asked, const std::vector<MeshDefect>& defects,
                    const std::vector<Outcome>& remedies,
                    const std::optional<MeshEstimate>& estimate) {
  std::string text;
  for (const MeshDefect& defect : defects)
    text += "defect           " + plainLine(defect.text) + "\n";
  if (asked.usable || defects.empty())
    text += lineOf(asked.option.empty() ? "as it is" : asked.option, asked);
  for (const Outcome& remedy : remedies)
    if (remedy.usable) text += lineOf("with " + remedy.option, remedy);
  if (estimate) text += estimateTable(*estimate);
  if (!asked.usable)
    text += "cannot be built" + std::string(asked.option.empty() ? " as it is" : " so") + "\n";
  return text;
}

/// The mesh file behind the input.
ImportedMesh importInput(const ShapeDescription& shape) {
  if (const auto* mesh = std::get_if<MeshFile>(&shape.geometry))
    return importMesh(mesh->file, mesh->scale);
  if (const auto* sheet = std::get_if<MeshSheet>(&shape.geometry))
    return importMesh(sheet->file, sheet->scale);
  raiseInputError(shape.source, "only meshes are checked: a shape without one is right");
}

/// In metres as built.
MeshDiagnosis diagnoseInput(const ReadInput& input, const ShapeDescription& shape) {
  TriangleMesh mesh = input.imported.mesh;
  mesh.vertices *= input.arguments.options.scale;
  return diagnoseMesh(mesh, shape.source, {isSheet(shape)});
}

void writeObj(const MeshDiagnosis& diagnosis, const std::string& file) {
  const BlockedSignals until_renamed;
  writeFile(file, defectsAsObj(diagnosis));
}

/// Estimates the error of what would be built, where that was asked for and something would.
std::optional<MeshEstimate> estimateOf(const CheckArguments& arguments,
                                       const ShapeDescription& shape, const Outcome& asked) {
  if (!arguments.estimate || !asked.usable) return std::nullopt;
  PotentialFlowSettings settings;
  settings.sheet = isSheet(shape);
  settings.max_panels = arguments.panels;
  settings.threads = arguments.threads;
  return estimateMesh(asked.usable->mesh, settings, arguments.input);
}

/// Returns the exit status: 1 if the input cannot be built.
int runCheck(const CheckArguments& arguments) {
  requirePositive("--scale", arguments.options.scale);
  requireDivisions("--panels", arguments.panels);
  requireThreads(arguments.threads);
  if (!arguments.obj.empty()) {
    if (!hasExtension(arguments.obj, ".obj"))
      raiseUsageError("--obj", "\"", arguments.obj, "\" does not end in .obj");
    requireWritablePlace(arguments.obj, arguments.input);
  }
  const ShapeDescription shape = describeInput(arguments.input, arguments.options);
  const ReadInput input{arguments, importInput(shape)};
  const Outcome asked = tryAsAsked(input);
  const MeshDiagnosis diagnosis = diagnoseInput(input, shape);
  const std::vector<Outcome> remedies = asked.usable ? std::vector<Outcome>() : tryRemedies(input);
  if (!arguments.obj.empty()) writeObj(diagnosis, arguments.obj);
  if (asked.usable && !arguments.json) {
    for (const std::string& warning : asked.usable->warnings)
      std::cerr << "warning: " << plainLine(warning) << "\n";
  }
  const std::optional<MeshEstimate> estimate = estimateOf(arguments, shape, asked);
  std::cout << (arguments.json ? asJson(asked, diagnosis.defects, remedies, estimate)
                               : asTable(asked, diagnosis.defects, remedies, estimate));
  return asked.usable ? 0 : 1;
}

}  // namespace

void addCheck(CLI::App& app) {
  const auto arguments = std::make_shared<CheckArguments>();
  CLI::App& command = *app.add_subcommand(
      "check", "Finds all defects of a mesh, and what would mend them; estimates its error");
  command.add_option("INPUT", arguments->input, "A mesh, or a JSON file with one")->required();
  addInputOptions(command, arguments->options);
  addOption(command, "--obj", arguments->obj, "OUT.obj",
            "Write the triangles of the defects into this file");
  command.add_flag("--estimate", arguments->estimate,
                   "Solve the flow and estimate the error of a build; show the thinnest part and "
                   "the worst triangles");
  addOption(command, "--panels", arguments->panels, "N", "For --estimate, as for build");
  addOption(command, "--threads", arguments->threads, "N",
            "For --estimate; 0: all cores (default)");
  addJson(command, arguments->json);
  command.callback([arguments] {
    if (const int status = runCheck(*arguments); status != 0) throw CLI::RuntimeError(status);
  });
}

}  // namespace ambient
