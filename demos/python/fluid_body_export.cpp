#include <pybind11/stl.h>

#include "demos/python/arrays.h"
#include "demos/python/bindings.h"
#include "preprocess/hand_over/export_fluid_body.h"
#include "preprocess/polar/polar.h"

namespace ambient {
namespace {

namespace py = pybind11;

// NOLINTNEXTLINE(readability-function-size): one parameter for each argument in Python
py::object exportAs(const std::shared_ptr<FluidBody>& body, const std::string& format_name,
                    const py::object& path, const py::object& medium, double gravity,
                    const std::optional<double>& mass, const py::object& centre_of_mass,
                    const std::string& forward, const std::string& up,
                    const std::optional<double>& draught, const std::optional<double>& speed) {
  const ExportFormat format = exportFormatOf(format_name);
  ExportSettings settings{medium.is_none() ? water() : mediumFrom(medium),
                          gravity,
                          mass,
                          std::nullopt,
                          axisNamed(forward),
                          axisNamed(up),
                          draught,
                          speed};
  if (!centre_of_mass.is_none())
    settings.centre_of_mass = vectorFrom(py::cast<InputArray>(centre_of_mass), "centre_of_mass");
  const ExportedBody made = exportFluidBody(body, format, settings);
  if (!path.is_none()) writeOrOsError([&] { made.write(pathFrom(path)); });
  return py::str(made.bytes);
}

}  // namespace

void bindExport(py::class_<FluidBody, std::shared_ptr<FluidBody>>& type) {
  type.def(
      "export", &exportAs, py::arg("format"), py::arg("path") = py::none(), py::kw_only(),
      py::arg("medium") = py::none(), py::arg("gravity") = 9.81, py::arg("mass") = py::none(),
      py::arg("centre_of_mass") = py::none(), py::arg("forward") = "x", py::arg("up") = "z",
      py::arg("draught") = py::none(), py::arg("speed") = py::none(),
      R"(Converts the body to the format of another program; docs/file_format.md lists what each format leaves out.

Parameters
----------
format : "sdf" (SDFormat, Gazebo), "mjcf" (MuJoCo) or "fossen" (JSON)
path : file that is also written, completely or not at all
medium : only its density and viscosity are used; default: water()
gravity : [m/s^2]
mass : [kg]; default: mass of the displaced fluid
centre_of_mass : (3,) in F [m]; default: centre of a mass spread evenly
forward, up : axes of F with a sign
draught : depth of the lowest point below the surface of the fluid [m]; default: no surface is near
speed : along forward [m/s], for the linearised drag of "fossen"

Returns the text of the file. Raises ValueError in one line if a number is not physical or the body
has no parts for a draught.

>>> import json
>>> ball = FluidBody.from_shape({"type": "sphere", "radius": 0.1})
>>> matrices = json.loads(ball.export("fossen"))
>>> round(matrices["M_A"][0][0] / matrices["mass"], 3)
0.5
)");
}

}  // namespace ambient
