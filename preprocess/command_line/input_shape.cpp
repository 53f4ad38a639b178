#include "preprocess/command_line/input_shape.h"

#include <algorithm>
#include <cctype>

#include "preprocess/mesh/input_error.h"
#include "preprocess/shape/shape_mesh.h"
#include "preprocess/shape/shape_reader.h"

namespace ambient {

bool hasExtension(const std::filesystem::path& file, const std::string& extension) {
  std::string own = file.extension().string();
  std::transform(own.begin(), own.end(), own.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return own == extension;
}

ShapeDescription describeInput(const std::filesystem::path& input, bool sheet) {
  if (!hasExtension(input, ".json")) {
    ShapeDescription mesh;
    if (sheet) {
      mesh.geometry = MeshSheetShape{input, 1};
    } else {
      mesh.geometry = MeshShape{input, 1};
    }
    mesh.source = input.string();
    return mesh;
  }
  ShapeDescription shape = readShapeFile(input);
  if (std::holds_alternative<FluidBodyShape>(shape.geometry)) {
    raiseInputError(shape.source, "a shape \"fluid_body\" is built already");
  }
  if (sheet && !isSheet(shape)) {
    raiseInputError(shape.source, "--sheet needs a shape of type \"sheet\"");
  }
  return shape;
}

}  // namespace ambient
