#include <nlohmann/json.hpp>

#include "preprocess/shape/json_schema.h"
#include "preprocess/shape/shape_mesh.h"
#include "preprocess/shape/shape_reader.h"
#include "tests/fuzz/targets/fuzz_file.h"

namespace ambient::test {
namespace {

// Limit of faces: finer meshes run the same code and take long.
constexpr int kMostFaces = 500;

void readAndMesh(std::string_view bytes) {
  mayRefuse([&] {
    const nlohmann::json document = parseJson(std::string(bytes), "fuzz");
    const ShapeDescription shape = readShape(document, "no_such_folder", "fuzz");
    if (shape.faces <= kMostFaces && fileOf(shape).empty()) makeShapeMesh(shape);
  });
}

}  // namespace
}  // namespace ambient::test

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  ambient::test::readAndMesh(ambient::test::textOf(data, size));
  return 0;
}
