#include <iostream>
#include <optional>
#include <sstream>

#include "bullet_ambient/fluid_body/output_file.h"
#include "bullet_ambient/fluid_body/plain_text.h"
#include "preprocess/builder/blocked_signals.h"
#include "preprocess/command_line/commands.h"
#include "preprocess/command_line/input_shape.h"
#include "preprocess/command_line/json_numbers.h"
#include "preprocess/command_line/option_values.h"
#include "preprocess/command_line/output_place.h"
#include "preprocess/mesh/input_error.h"
#include "preprocess/mesh/mass_properties.h"
#include "preprocess/mesh/mesh_diagnosis.h"
#include "preprocess/mesh/mesh_import.h"
#include "preprocess/mesh/usual_size.h"
#include "preprocess/shape/shape_mesh.h"

namespace ambient {
namespace {

using nlohmann::ordered_json;

/// The input, read once.
struct ReadInput {
  const CheckArguments& arguments;
  ImportedMesh imported;
};

/// What one way to take the input comes to.
struct Outcome {
  std::string option;                 ///< empty: as it is
  std::optional<CheckedMesh> usable;  ///< what would be built
  std::string refusal;
};

/// As build would, up to the flow.
Outcome tryOption(const ReadInput& input, const std::string& option, const InputOptions& options) {
  Outcome outcome{option, std::nullopt, {}};
  try {
    const ShapeDescription shape = describeInput(input.arguments.input, options);
    CheckedMesh checked = makeShapeMesh(shape, input.imported, input.arguments.scale);
    requireUsualSize(checked.mesh, isSheet(shape), shape.source);
    outcome.usable = std::move(checked);
  } catch (const std::runtime_error& error) {
    outcome.refusal = error.what();
  }
  return outcome;
}

InputOptions optionsOf(const CheckArguments& arguments) {
  return {arguments.sheet, arguments.hull, arguments.wrap, arguments.scale};
}

Outcome tryAsAsked(const ReadInput& input) {
  const CheckArguments& arguments = input.arguments;
  std::string option = arguments.sheet ? "--sheet" : arguments.hull ? "--hull" : "";
  if (arguments.wrap)
    option = *arguments.wrap == kDefaultWrap ? "--wrap" : "--wrap " + *arguments.wrap;
  return tryOption(input, option, optionsOf(arguments));
}

/// What would mend an input that cannot be built as it is.
std::vector<Outcome> tryRemedies(const ReadInput& input) {
  const CheckArguments& arguments = input.arguments;
  if (arguments.sheet || arguments.hull || arguments.wrap) return {};
  std::vector<Outcome> remedies;
  const auto add = [&](const char* option, InputOptions options) {
    options.scale = arguments.scale;
    remedies.push_back(tryOption(input, option, options));
  };
  if (!hasExtension(arguments.input, ".json")) add("--sheet", {true, false, std::nullopt, 1});
  add("--hull", {false, true, std::nullopt, 1});
  add("--wrap", {false, false, kDefaultWrap, 1});
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
                   const std::vector<Outcome>& remedies) {
  ordered_json text = outcomeJson(asked);
  text["defects"] = ordered_json::array();
  for (const MeshDefect& defect : defects) {
    text["defects"].push_back(
        {{"kind", defect.kind}, {"text", defect.text}, {"triangles", defect.triangles}});
  }
  text["remedies"] = ordered_json::array();
  for (const Outcome& remedy : remedies) text["remedies"].push_back(outcomeJson(remedy));
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
                    const std::vector<Outcome>& remedies) {
  std::string text;
  for (const MeshDefect& defect : defects)
    text += "defect           " + plainLine(defect.text) + "\n";
  if (asked.usable || defects.empty())
    text += lineOf(asked.option.empty() ? "as it is" : asked.option, asked);
  for (const Outcome& remedy : remedies)
    if (remedy.usable) text += lineOf("with " + remedy.option, remedy);
  if (!asked.usable)
    text += "cannot be built" + std::string(asked.option.empty() ? " as it is" : " so") + "\n";
  return text;
}

/// The mesh file behind the input.
ImportedMesh importInput(const ShapeDescription& shape) {
  if (const auto* mesh = std::get_if<MeshShape>(&shape.geometry))
    return importMesh(mesh->file, mesh->scale);
  if (const auto* sheet = std::get_if<MeshSheetShape>(&shape.geometry))
    return importMesh(sheet->file, sheet->scale);
  raiseInputError(shape.source, "only meshes are checked: a shape without one is right");
}

/// In metres as built.
MeshDiagnosis diagnoseInput(const ReadInput& input, const ShapeDescription& shape) {
  TriangleMesh mesh = input.imported.mesh;
  mesh.vertices *= input.arguments.scale;
  return diagnoseMesh(mesh, shape.source, {isSheet(shape)});
}

void writeObj(const MeshDiagnosis& diagnosis, const std::string& file) {
  const BlockedSignals until_renamed;
  OutputFile obj(file);
  obj.write(defectsAsObj(diagnosis));
  obj.commit();
}

}  // namespace

int runCheck(const CheckArguments& arguments) {
  requirePositive("--scale", arguments.scale);
  if (!arguments.obj.empty()) {
    if (!hasExtension(arguments.obj, ".obj"))
      raiseUsageError("--obj", "\"", arguments.obj, "\" does not end in .obj");
    requireWritablePlace(arguments.obj, arguments.input);
  }
  const ShapeDescription shape = describeInput(arguments.input, optionsOf(arguments));
  const ReadInput input{arguments, importInput(shape)};
  const Outcome asked = tryAsAsked(input);
  const MeshDiagnosis diagnosis = diagnoseInput(input, shape);
  const std::vector<Outcome> remedies = asked.usable ? std::vector<Outcome>() : tryRemedies(input);
  if (!arguments.obj.empty()) writeObj(diagnosis, arguments.obj);
  if (asked.usable && !arguments.json) {
    for (const std::string& warning : asked.usable->warnings)
      std::cerr << "warning: " << plainLine(warning) << "\n";
  }
  std::cout << (arguments.json ? asJson(asked, diagnosis.defects, remedies)
                               : asTable(asked, diagnosis.defects, remedies));
  return asked.usable ? 0 : 1;
}

}  // namespace ambient
