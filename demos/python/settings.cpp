#include <stdexcept>

#include "bullet_ambient/base/plain_text.h"
#include "bullet_ambient/force/law/flow_settings.h"
#include "bullet_ambient/force/medium/medium.h"
#include "demos/python/bindings.h"
#include "demos/python/record.h"

namespace ambient {

// Outside the anonymous namespace: templates of record.h find these overloads by their argument.

static pybind11::object toPython(const PressureLaw& law) {
  return pybind11::str(wordOf(kPressureLawNames, law));
}

static void fromPython(pybind11::handle from, PressureLaw& to) {
  const auto word = from.cast<std::string>();
  const auto law = valueOf(kPressureLawNames, word);
  if (!law) throw std::invalid_argument("law is \"" + word + "\"; must be form or published");
  to = *law;
}

void bindSettings(pybind11::module_& module) {
  Record<Medium>(module, "Medium", "The fluid around a body; vectors in world axes.")
      .field("density", &Medium::density, "[kg/m^3], >= 0; default 0, a vacuum")
      .field("viscosity", &Medium::viscosity, "dynamic [Pa s], >= 0; 0: no skin friction")
      .field("velocity", &Medium::velocity, "of the undisturbed flow at the body [m/s]")
      .field("acceleration", &Medium::acceleration, "its rate of change [m/s^2]");
  Record<FlowSettings>(module, "FlowSettings", "How the flow follows the surface of a body.")
      .field("separation_angle", &FlowSettings::separation_angle,
             "from pi/2 (default) to pi [rad]; larger: more attachment")
      .field("skin_friction", &FlowSettings::skin_friction, "whether there is any")
      .field("law", &FlowSettings::law, "of the pressure: 'form' (default) or 'published'")
      .field("maximum_load_error", &FlowSettings::maximum_load_error,
             "that reduced loads may make, from 0 (all faces) to 1; default 0.01")
      .field("stall_lag", &FlowSettings::stall_lag,
             "of the law 'form', in body lengths over speed; 0: none");
  module.def("air", &air, "Air at 20 C and sea level.");
  module.def("water", &water, "Fresh water at 20 C.");
}

}  // namespace ambient
