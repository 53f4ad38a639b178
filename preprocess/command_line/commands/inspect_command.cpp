#include <cmath>
#include <cstdio>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "bullet_ambient/fluid_body/displaced_mass.h"
#include "bullet_ambient/force/medium/medium.h"
#include "preprocess/command_line/commands.h"
#include "preprocess/command_line/fluid_body_report.h"
#include "preprocess/floating/floating_body.h"
#include "preprocess/resistance/prepare.h"

namespace ambient {
namespace {

using nlohmann::ordered_json;

constexpr int kMostAlike = 48;  // by the symmetry of a box; more: it turns freely

template <class... Numbers>
std::string line(const char* format, Numbers... numbers) {
  char text[200];
  std::snprintf(text, sizeof text, format, numbers...);
  return text;
}

// Components of a unit vector to four decimals: what is below is noise of the search.
std::string directionText(const Vector3& v) {
  const auto rounded = [](double x) { return std::round(1e4 * x) / 1e4 + 0.0; };
  return line("%.4g, %.4g, %.4g", rounded(v.x()), rounded(v.y()), rounded(v.z()));
}

// Period of a mode of body and added mass, without damping by waves; "none" where nothing turns the
// body back.
std::string modeText(const SmallOscillation& mode) {
  const bool has_period = std::isfinite(mode.period);
  if (!has_period && mode.turn.isZero(0)) return "";  // nothing to tell
  const bool is_heave = mode.is_heave && has_period;
  return "    period          " +
         (has_period ? line("%.4g s, ", mode.period) : std::string("none, ")) +
         (is_heave ? "heave" : "turn about " + directionText(mode.turn)) + "\n";
}

std::string attitudeText(const FloatingAttitude& attitude) {
  std::string text = "  up is " + directionText(attitude.up);
  if (attitude.up.z() < -attitude.up.head<2>().norm()) text += ", z downwards";
  if (attitude.alike > kMostAlike) {
    text += ", or turned freely";
  } else if (attitude.alike > 1) {
    text += line(", and %d alike", attitude.alike - 1);
  }
  text += line("; reached from %.0f %% of all attitudes\n", 100 * attitude.share);
  text += line("    draught         %.5g m\n", attitude.draught);
  text += line("    centre of mass  %.5g m above the water\n", attitude.height_of_mass);
  text += line("    waterplane      %.5g m^2\n", attitude.wet.waterplane.area);
  for (const Metacentre& metacentre : attitude.metacentres)
    text += line("    GM              %.4g m, about ", metacentre.height) +
            directionText(metacentre.axis) + "\n";
  for (const SmallOscillation& mode : attitude.modes) text += modeText(mode);
  return text;
}

ordered_json modeJson(const SmallOscillation& mode) {
  ordered_json json{{"heave", mode.is_heave}, {"turn", vectorJson(mode.turn)}};
  json["period"] = std::isfinite(mode.period) ? ordered_json(mode.period) : ordered_json();
  return json;
}

ordered_json attitudeJson(const FloatingAttitude& attitude) {
  ordered_json json{{"up", vectorJson(attitude.up)},
                    {"alike", attitude.alike},
                    {"share", attitude.share},
                    {"draught", attitude.draught},
                    {"height_of_mass", attitude.height_of_mass},
                    {"waterplane_area", attitude.wet.waterplane.area},
                    {"metacentres", ordered_json::array()},
                    {"modes", ordered_json::array()}};
  for (const Metacentre& metacentre : attitude.metacentres)
    json["metacentres"].push_back(
        {{"height", metacentre.height}, {"axis", vectorJson(metacentre.axis)}});
  for (const SmallOscillation& mode : attitude.modes) json["modes"].push_back(modeJson(mode));
  return json;
}

/// Returns a text about how a body floats: its attitudes with draught, metacentric heights and
/// periods.
std::string floatingTable(const FloatingBody& body) {
  std::string text = line("with %.6g kg on water of %.6g kg/m^3\n", body.mass, body.density);
  const double air_mass = air().density * body.shape->volume;
  if (DisplacedMass{body.mass, air_mass}.isMuchLighter())
    text += line("  it is lighter than the %.6g kg of air in its place: is its mesh in metres?\n",
                 air_mass);
  const auto attitudes = findFloatingAttitudes(body);
  if (attitudes.empty())
    return text + line("  it sinks: it displaces %.6g kg\n", body.density * body.shape->volume);
  for (const FloatingAttitude& attitude : attitudes) text += attitudeText(attitude);
  return text;
}

/// Returns the facts of floatingTable() in JSON: a list with one entry per attitude, empty if the
/// body sinks.
ordered_json floatingJson(const FloatingBody& body) {
  ordered_json list = ordered_json::array();
  for (const FloatingAttitude& attitude : findFloatingAttitudes(body))
    list.push_back(attitudeJson(attitude));
  return list;
}

/// Options of ambient_preprocess inspect; its help says what they mean.
struct InspectArguments {
  std::string file;
  std::optional<double> mass;          // [kg]
  std::vector<double> centre_of_mass;  // in F [m]; empty: spread evenly over the volume
  std::vector<double> inertia;         // xx yy zz xy xz yz [kg m^2]; empty: likewise
  double density = 998;                // [kg/m^3]
  double gravity = 9.81;               // [m/s^2]
  bool json = false;
};

/// Returns the body with mass and water of the arguments. Inertia that is not given is that of a
/// mass spread evenly over the volume, even if its centre is given.
FloatingBody onWater(const FluidBody& body, const InspectArguments& arguments) {
  FloatingBody floating;
  floating.shape = std::make_shared<FluidBody>(body);
  floating.mass = *arguments.mass;
  floating.centre_of_mass = body.uniform_mass.centre;
  if (!arguments.centre_of_mass.empty())
    floating.centre_of_mass = Eigen::Map<const Eigen::Vector3d>(arguments.centre_of_mass.data());
  floating.inertia = floating.mass * body.uniform_mass.inertia;
  if (const std::vector<double>& v = arguments.inertia; !v.empty())
    floating.inertia << v[0], v[3], v[4], v[3], v[1], v[5], v[4], v[5], v[2];
  floating.density = arguments.density;
  floating.gravity = arguments.gravity;
  return floating;
}

std::string inspectionJson(const FluidBody& body, const InspectArguments& arguments) {
  std::string text = reportJson(body, std::nullopt);
  if (!arguments.mass) return text;
  auto report = nlohmann::ordered_json::parse(text);
  report["floating"] = floatingJson(onWater(body, arguments));
  return jsonText(report);
}

void runInspect(const InspectArguments& arguments) {
  const FluidBody body = readPrepared(arguments.file);
  if (arguments.json) {
    std::cout << inspectionJson(body, arguments);
    return;
  }
  std::string table = reportTable(body, arguments.file);
  if (arguments.mass) table += floatingTable(onWater(body, arguments));
  std::cout << table;
}

}  // namespace

void addInspect(CLI::App& app) {
  const auto arguments = std::make_shared<InspectArguments>();
  CLI::App& command = *app.add_subcommand("inspect", "Shows what an .ambient file holds");
  command.add_option("FILE", arguments->file, "An .ambient file")->required();
  command.add_option("--mass", arguments->mass, "Shows how a body of this mass floats [kg]");
  addOption(command, "--centre-of-mass", arguments->centre_of_mass, "X Y Z",
            "With --mass: in the body's frame [m]; default: that of a mass spread evenly")
      ->expected(3);
  addOption(command, "--inertia", arguments->inertia, "XX YY ZZ XY XZ YZ",
            "With --mass: about the centre of mass, in the body's axes [kg m^2]; default: likewise")
      ->expected(6);
  command.add_option("--density", arguments->density, "With --mass: of the water [kg/m^3]")
      ->capture_default_str();
  command.add_option("--gravity", arguments->gravity, "With --mass: [m/s^2]")
      ->capture_default_str();
  addJson(command, arguments->json);
  command.callback([arguments] { runInspect(*arguments); });
}

}  // namespace ambient
