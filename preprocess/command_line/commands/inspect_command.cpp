#include <algorithm>
#include <cmath>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/base/plain_text.h"
#include "bullet_ambient/fluid_body/file/fluid_body_file.h"
#include "bullet_ambient/fluid_body/fluid_body.h"
#include "bullet_ambient/force/medium/medium.h"
#include "bullet_ambient/spatial/symmetric_eigen.h"
#include "preprocess/base/fluid_body_writer.h"
#include "preprocess/builder/parse_exit.h"
#include "preprocess/command_line/commands.h"
#include "preprocess/command_line/fluid_body_report.h"
#include "preprocess/command_line/option_values.h"
#include "preprocess/floating/floating_body.h"
#include "preprocess/hand_over/glide.h"
#include "preprocess/hand_over/handed_body.h"
#include "preprocess/mesh/holds/vessel.h"
#include "preprocess/polar/polar.h"
#include "preprocess/potential_flow.h"
#include "preprocess/resistance/prepare.h"
#include "preprocess/resistance/separation.h"

namespace ambient {
namespace {

using nlohmann::ordered_json;

ordered_json modeJson(const SmallOscillation& mode) {
  ordered_json json{{"heave", mode.is_heave}, {"turn", vectorJson(mode.turn)}};
  json["period"] = std::isfinite(mode.period) ? ordered_json(mode.period) : ordered_json();
  return json;
}

/// Height of the lowest place of all rims above the water [m]; none without an opening.
std::optional<double> freeboardOf(const FluidBody& body, const SurfacePlane& plane) {
  std::optional<double> least;
  for (const Hold& hold : body.holds)
    for (const HoldOpening& opening : hold.openings)
      for (std::size_t i = 0; opening.to < 0 && i < opening.outline.size(); i += 3) {
        const double* corner = &opening.outline[i];
        const double height = -plane.depth({corner[0], corner[1], corner[2]});
        least = std::min(height, least.value_or(height));
      }
  return least;
}

/// Neutral modes, which have no period, are listed with `all_modes` alone.
ordered_json attitudeJson(const FluidBody& body, const FloatingAttitude& attitude, bool all_modes) {
  ordered_json json{{"up", vectorJson(attitude.up)},
                    {"alike", attitude.alike},
                    {"share", attitude.share},
                    {"draught", attitude.draught},
                    {"height_of_mass", attitude.height_of_mass},
                    {"waterplane_area", attitude.wet.waterplane.area},
                    {"metacentres", ordered_json::array()},
                    {"modes", ordered_json::array()}};
  if (const auto freeboard = freeboardOf(body, attitude.plane)) json["freeboard"] = *freeboard;
  for (const Metacentre& metacentre : attitude.metacentres)
    json["metacentres"].push_back(
        {{"height", metacentre.height}, {"axis", vectorJson(metacentre.axis)}});
  for (const SmallOscillation& mode : attitude.modes)
    if (all_modes || std::isfinite(mode.period)) json["modes"].push_back(modeJson(mode));
  return json;
}

/// The attitudes in which a body floats; none if it sinks.
ordered_json floatingFacts(const FloatingBody& body, bool all_modes) {
  ordered_json list = ordered_json::array();
  for (const FloatingAttitude& attitude : findFloatingAttitudes(body))
    list.push_back(attitudeJson(*body.shape, attitude, all_modes));
  return list;
}

/// Options of ambient_preprocess inspect; its help says what they mean.
struct InspectArguments {
  std::string file;
  std::optional<double> mass;          // [kg]
  std::vector<double> centre_of_mass;  // in F [m]; empty: spread evenly over the volume
  std::vector<double> inertia;         // xx yy zz xy xz yz [kg m^2]; empty: likewise
  std::vector<double> water;           // in its holds [m^3]
  double density = 998;                // [kg/m^3]
  double viscosity = 0;                // [Pa s]
  double gravity = 9.81;               // [m/s^2]
  std::string forward = "x", up = "z";
  bool fly = false, json = false;
};

Matrix3 inertiaOf(const InspectArguments& arguments) {
  const std::vector<double>& v = arguments.inertia;
  Matrix3 inertia;
  inertia << v[0], v[3], v[4], v[3], v[1], v[5], v[4], v[5], v[2];
  return inertia;
}

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
  if (!arguments.inertia.empty()) floating.inertia = inertiaOf(arguments);
  floating.density = arguments.density;
  floating.gravity = arguments.gravity;
  setWater(floating, arguments.water);
  return floating;
}

void warnOfMass(const FloatingBody& body, const ordered_json& attitudes) {
  const double air_mass = air().density * body.shape->volume;
  if (DisplacedMass{body.mass, air_mass}.isMuchLighter())
    std::cerr << "warning: it is lighter than the " << air_mass
              << " kg of air in its place: is its mesh in metres?\n";
  if (attitudes.empty())
    std::cerr << "it sinks: it displaces " << body.density * body.shape->volume << " kg"
              << (body.water.empty() ? "\n" : ", with the water in it\n");
  constexpr double kDownwards = -0.5;  // within 60 degrees
  if (!attitudes.empty() && attitudes[0]["up"][2] < kDownwards)
    std::cerr << "it floats with its z axis downwards in the likeliest attitude\n";
}

/// Adds to the axes of separation where smooth layers leave, laminar and turbulent, both ways. The
/// flow is solved once more: files hold only what the law takes from it.
void addLayerPlaces(const FluidBody& body, ordered_json& axes) {
  constexpr Eigen::Index kMostTriangles = 5000;  // takes a second
  const TriangleMesh mesh = meshOf(body.surface);
  const auto is_smooth = [](const ordered_json& axis) { return axis["smooth_share"] > 0; };
  if (std::none_of(axes.begin(), axes.end(), is_smooth) || mesh.triangleCount() > kMostTriangles)
    return;
  const MeshSeparation found = computeSeparation(
      mesh, solvePotentialFlow(mesh).potential.rightCols<3>(), body.viscous.separation.axes);
  for (std::size_t way = 0; way < found.leaves_at.size(); ++way) {
    ordered_json& axis = axes[way / 2];
    const LayerPlaces& places = found.leaves_at[way];
    if (is_smooth(axis)) axis["leaves_at"].push_back({places.laminar, places.turbulent});
  }
}

/// Returns the body with mass and fluid of the arguments. @throws UsageError for numbers that are
/// not physical
HandedBody inFlight(const FluidBody& body, const InspectArguments& arguments) {
  ExportSettings settings;
  settings.medium = {arguments.density, arguments.viscosity, Vector3::Zero(), Vector3::Zero()};
  settings.gravity = arguments.gravity;
  settings.mass = arguments.mass;
  if (!arguments.centre_of_mass.empty())
    settings.centre_of_mass =
        Vector3(Eigen::Map<const Eigen::Vector3d>(arguments.centre_of_mass.data()));
  const Matrix3 axes = flightAxesOf(arguments.forward, arguments.up);
  settings.forward = axes.col(0);
  settings.up = axes.col(2);
  HandedBody handed = handedBody(std::make_shared<const FluidBody>(body), settings);
  if (!arguments.inertia.empty()) handed.inertia = inertiaOf(arguments);
  const double least = symmetricEigen<3>(handed.inertia).values[0];
  if (!(least > 0)) raiseUsageError("--inertia", "smallest moment ", least, " must be above 0");
  return handed;
}

ordered_json glideJson(const Glide& glide) {
  constexpr double kRadian = 180 / kPi;
  return {{"speed", glide.speed},
          {"incidence", kRadian * glide.incidence},
          {"glide_angle", kRadian * glide.angle},
          {"glide_ratio", glide.ratio}};
}

ordered_json swingJson(const Swing& swing) {
  return {{"frequency", swing.frequency}, {"damping", swing.damping}, {"period", swing.period}};
}

/// `names`: of the swings, the quickest first.
ordered_json modesJson(const GlideModes& modes, std::vector<const char*> names) {
  ordered_json json;
  for (std::size_t i = 0; i < modes.swings.size(); ++i) json[names[i]] = swingJson(modes.swings[i]);
  if (!modes.rates.empty()) json["rates"] = modes.rates;
  return json;
}

/// One swing alone is the slow one if a motion that does not swing is quicker.
ordered_json pitchingJson(const GlideModes& modes) {
  const bool is_alone = modes.swings.size() == 1;
  if (is_alone && -modes.rates[0] > modes.swings[0].frequency) return modesJson(modes, {"phugoid"});
  return modesJson(modes, {"short_period", "phugoid"});
}

/// Chord of the largest wing, or the length along forward [m].
double chordOf(const HandedBody& body) {
  const std::vector<Wing>& wings = body.shape->wings;
  const auto isSmaller = [](const Wing& a, const Wing& b) {
    return a.span * a.chord < b.span * b.chord;
  };
  if (!wings.empty()) return std::max_element(wings.begin(), wings.end(), isSmaller)->chord;
  return usualReference(*body.shape, body.axes()).length;
}

ordered_json stabilityJson(const HandedBody& body, const GlideStability& stability) {
  ordered_json json{{"neutral_point", vectorJson(stability.neutral_point)},
                    {"static_margin", stability.static_margin},
                    {"margin_over_chord", stability.static_margin / chordOf(body)}};
  json["pitching"] = pitchingJson(stability.pitching);
  json["sideways"] = modesJson(stability.sideways, {"dutch_roll", "slow_roll"});
  return json;
}

/// Says on standard error if there is no trim.
ordered_json flyingFacts(const HandedBody& body) {
  const GlidePlan plan = planGlide(body);
  ordered_json json;
  if (plan.trim)
    json = {{"trim", glideJson(*plan.trim)}, {"stability", stabilityJson(body, plan.stability)}};
  else
    std::cerr << "it has no trim: at no upright incidence from -" << plan.kWidest << " to "
              << plan.kWidest << " degrees it is in balance; its nose goes "
              << (plan.goes_nose_up ? "up: move its mass ahead\n" : "down: move its mass back\n");
  if (plan.best) json["best_glide"] = glideJson(*plan.best);
  return json;
}

void runInspect(const InspectArguments& arguments) {
  const FluidBody body = readPrepared(arguments.file);
  ordered_json facts = bodyFacts(body);
  if (facts.contains("viscous_flow")) addLayerPlaces(body, facts["viscous_flow"]["separation"]);
  if (arguments.fly) {
    facts["flying"] = flyingFacts(inFlight(body, arguments));
  } else if (arguments.mass) {
    const FloatingBody floating = onWater(body, arguments);
    facts["floating"] = floatingFacts(floating, arguments.json);
    if (!arguments.json) warnOfMass(floating, facts["floating"]);
  }
  std::cout << factsText(facts, arguments.json);
}

/// Fills in what --fly takes for granted. @throws UsageError for options that are missing
void useAir(const CLI::App& command, InspectArguments& arguments) {
  if (!arguments.mass) raiseUsageError("--fly", "needs --mass");
  if (command.count("--density") != command.count("--viscosity"))
    raiseUsageError("--fly", "needs both --density and --viscosity of a fluid, or none: air");
  if (command.count("--density") > 0) return;
  arguments.density = air().density;
  arguments.viscosity = air().viscosity;
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
  addOption(command, "--water", arguments->water, "V,V,...",
            "With --mass: water in its holds, in their order [m^3]; default: none")
      ->delimiter(',');
  command.add_option("--density", arguments->density,
                     "With --mass: of the water, or with --fly of the fluid [kg/m^3] (default 998; "
                     "1.204 with --fly)");
  command.add_option("--gravity", arguments->gravity, "With --mass: [m/s^2]")
      ->capture_default_str();
  command.add_flag("--fly", arguments->fly,
                   "With --mass: shows how it glides, in place of how it floats");
  addOption(command, "--viscosity", arguments->viscosity, "MU",
            "With --fly: of the fluid [Pa s] (default: of air, 1.82e-5)");
  addOption(command, "--forward", arguments->forward, "AXIS",
            "With --fly: the body's forward axis (default x)");
  addOption(command, "--up", arguments->up, "AXIS",
            "With --fly: the body's upward axis (default z)");
  addJson(command, arguments->json);
  command.callback([arguments, &command] {
    if (arguments->fly) useAir(command, *arguments);
    runInspect(*arguments);
  });
}

namespace {

/// True if the flow leaves a body's smooth sides where only a build knows.
bool lacksLayers(const FluidBody& body) {
  return body.sphere_radius == 0 && body.volume > 0 && body.form.shape.edges < 0.5 &&
         body.form.shape.wing < 1 && body.viscous.separation.smooth_base.isZero(0);
}

void upgrade(const std::string& file) {
  const bool is_new = isComplete(readFluidBody(file));
  std::string said = is_new ? ": is up to date" : ": upgraded";
  if (!is_new) {
    const FluidBody body = readPrepared(file);
    const BlockedSignals until_renamed;
    writeFluidBody(body, file);
    if (lacksLayers(body))
      said +=
          "; it has no drag crisis: where the flow leaves its smooth sides only a new build finds";
  }
  std::cout << plainLine(file) << said << "\n";
}

}  // namespace

void addUpgrade(CLI::App& app) {
  const auto files = std::make_shared<std::vector<std::string>>();
  CLI::App& command = *app.add_subcommand(
      "upgrade", "Completes .ambient files of earlier versions, which the runtime refuses");
  command.add_option("FILE.ambient", *files, "The files, which are written anew in place")
      ->required();
  command.callback([files] {
    for (const std::string& file : *files) upgrade(file);
  });
}

}  // namespace ambient
