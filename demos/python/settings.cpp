#include <sstream>
#include <stdexcept>

#include "bullet_ambient/base/plain_text.h"
#include "bullet_ambient/force/law/flow_settings.h"
#include "bullet_ambient/force/medium/medium.h"
#include "demos/python/bindings.h"
#include "demos/python/record.h"

namespace ambient {

// Not in an anonymous namespace, so that templates of record.h find these overloads by their
// argument.

static pybind11::object toPython(const PressureLaw& law) {
  return pybind11::str(wordOf(kPressureLawNames, law));
}

static void fromPython(pybind11::handle from, PressureLaw& to) {
  const auto word = from.cast<std::string>();
  const auto law = valueOf(kPressureLawNames, word);
  if (!law) throw std::invalid_argument("law is \"" + word + "\"; must be form or published");
  to = *law;
}

static void checkMedium(const Medium& medium) {
  const auto fault = faultOf(medium);
  if (!fault) return;
  std::ostringstream sentence;
  sentence << "Medium: " << fault->quantity << " [" << fault->unit << "] is " << fault->value
           << "; must be " << fault->limit;
  throw std::invalid_argument(sentence.str());
}

void bindSettings(pybind11::module_& module) {
  Record<Medium>(module, "Medium", "Fluid around a body; vectors in world axes.")
      .field("density", &Medium::density, "Density [kg/m^3], >= 0; default 0, a vacuum.")
      .field("viscosity", &Medium::viscosity,
             "Dynamic viscosity [Pa s], >= 0; 0: no skin friction.")
      .field("velocity", &Medium::velocity, "Velocity of the undisturbed flow at the body [m/s].")
      .field("acceleration", &Medium::acceleration, "Rate of change of that velocity [m/s^2].")
      .checkedBy(&checkMedium);
  Record<FlowSettings>(module, "FlowSettings", "Settings of the flow along the surface of a body.")
      .field(
          "separation_angle", &FlowSettings::separation_angle,
          "Separation angle, from pi/2 (default) to pi [rad]; larger: flow stays attached longer.")
      .field("skin_friction", &FlowSettings::skin_friction, "False: no skin friction.")
      .field("law", &FlowSettings::law, "Law of the pressure: 'form' (default) or 'published'.")
      .field("maximum_load_error", &FlowSettings::maximum_load_error,
             "Largest relative error of reduced loads, from 0 (sums all faces) to 1; default 0.01.")
      .field("stall_lag", &FlowSettings::stall_lag,
             "Time by which stall lags with the law 'form', in body lengths over speed; 0: none.");
  module.def("air", &air, "Returns air at 20 C and sea level.");
  module.def("water", &water, "Returns fresh water at 20 C.");
}

}  // namespace ambient
