#include <iostream>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "bullet_ambient/base/plain_text.h"
#include "preprocess/base/output_file.h"
#include "preprocess/builder/elapsed_display.h"
#include "preprocess/builder/fluid_body_builder.h"
#include "preprocess/builder/parse_exit.h"
#include "preprocess/command_line/commands.h"
#include "preprocess/command_line/fluid_body_report.h"
#include "preprocess/command_line/option_values.h"
#include "preprocess/mesh/check/mesh_checks.h"
#include "preprocess/mesh/geometry.h"
#include "preprocess/mesh/holds/hold_search.h"
#include "preprocess/mesh/import/mesh_import.h"
#include "preprocess/mesh/input_error.h"
#include "preprocess/mesh/mass_properties.h"
#include "preprocess/mesh/wings/triangle_tree.h"
#include "preprocess/potential_flow/results/refined_flow.h"
#include "preprocess/shape/shape_mesh.h"

namespace ambient {
namespace {

using nlohmann::ordered_json;

/// How far the added mass of a mesh that can be built can be trusted, and what is worst about it:
/// solves the flow around it.
/// @throws std::runtime_error in one line that begins with `name`.
ordered_json estimateMesh(const TriangleMesh& mesh, const PotentialFlowSettings& settings,
                          const std::string& name) {
  const ElapsedDisplay display("solving " + name);
  ordered_json estimate;
  if (const auto flow = withSource(name, [&] { return estimateFlow(mesh, settings); })) {
    estimate = {{"panels", flow->panels},
                {"other_panels", flow->other_panels},
                {"rotation_error", flow->rotation_error},
                {"translation_error", flow->translation_error}};
  } else {
    estimate["error"] = "none: the mesh is too large to be solved on more panels";
  }
  if (const auto thinnest = settings.sheet ? std::nullopt : findThinnestPart(mesh))
    estimate["thinnest"] = {{"thickness", thinnest->thickness},
                            {"triangle", thinnest->triangle},
                            {"barycentre", vectorJson(thinnest->barycentre)}};
  for (const TriangleQuality& t : findWorstTriangles(mesh, 3)) {
    estimate["worst_triangles"].push_back({{"triangle", t.triangle},
                                           {"aspect", t.aspect},
                                           {"smallest_angle", t.smallest_angle},
                                           {"barycentre", vectorJson(t.barycentre)}});
  }
  return estimate;
}

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
  bool is_wrapped = false;  ///< of one as it is that is no closed body
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
  InputOptions strictly = options;
  strictly.strict = !options.wrap;
  const Outcome strict = tryOption(input, option, strictly);
  if (strict.usable || !option.empty() || options.strict) return strict;
  Outcome outcome = tryOption(input, option, options);
  outcome.is_wrapped = outcome.usable && outcome.usable->is_wrapped;
  return outcome;
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
  json["wrapped"] = outcome.is_wrapped;
  json["warnings"] = outcome.usable->warnings;
  return json;
}

/// The mesh file behind the input.
ImportedMesh importInput(const ShapeDescription& shape) {
  if (const auto* mesh = std::get_if<MeshFile>(&shape.geometry))
    return importMesh(mesh->file, mesh->scale);
  raiseInputError(shape.source, "only meshes are checked: a shape without one is right");
}

/// In metres as built.
CheckedMesh checkInput(const ReadInput& input, const ShapeDescription& shape) {
  TriangleMesh mesh = input.imported.mesh;
  mesh.vertices *= input.arguments.options.scale;
  CheckedMesh checked = checkMesh(mesh, shape.source, isSheet(shape));
  if (!isSheet(shape)) checked.addDefects(findCrossings(checked.mesh));
  return checked;
}

void writeObj(const CheckedMesh& checked, const std::string& file) {
  const BlockedSignals until_renamed;
  writeFile(file, defectsAsObj(checked));
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
  const CheckedMesh checked = checkInput(input, shape);
  if (!arguments.obj.empty()) writeObj(checked, arguments.obj);
  ordered_json facts = outcomeJson(asked);
  if (asked.usable && !arguments.json) {
    for (const std::string& warning : asked.usable->warnings)
      std::cerr << "warning: " << plainLine(warning) << "\n";
    facts.erase("warnings");
  }
  if (asked.usable && !isSheet(shape)) {
    const Vessel vessel =
        findHolds(asked.usable->mesh, holdsOf(arguments.options), arguments.input);
    facts["holds"] = holdsJson(vessel.holds);
    for (const std::string& line : vessel.lines) std::cerr << "warning: " << line << "\n";
  }
  facts["defects"] = ordered_json::array();
  for (const MeshDefect& defect : checked.defects) {
    facts["defects"].push_back(
        {{"kind", defect.kind}, {"text", defect.text}, {"triangles", defect.triangles}});
  }
  facts["remedies"] = ordered_json::array();
  if (!asked.usable)
    for (const Outcome& remedy : tryRemedies(input))
      facts["remedies"].push_back(outcomeJson(remedy));
  if (arguments.estimate && asked.usable) {
    PotentialFlowSettings settings;
    settings.sheet = isSheet(shape);
    settings.max_panels = arguments.panels;
    settings.threads = arguments.threads;
    facts["estimate"] = estimateMesh(asked.usable->mesh, settings, arguments.input);
  }
  std::cout << factsText(facts, arguments.json);
  return asked.usable ? 0 : 1;
}

}  // namespace

void addCheck(CLI::App& app) {
  const auto arguments = std::make_shared<CheckArguments>();
  CLI::App& command = *app.add_subcommand(
      "check", "Finds all defects of a mesh, and what build would do with it; estimates its error");
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
