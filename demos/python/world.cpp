#include <pybind11/stl.h>

#include <optional>

#include "demos/python/arrays.h"
#include "demos/python/bindings.h"
#include "demos/python/motion.h"
#include "demos/python/python_world.h"
#include "demos/scene/scene_reader.h"
#include "demos/simulation/output/motion_recorder.h"
#include "demos/simulation/scene_run.h"

namespace ambient {
namespace {

namespace py = pybind11;

/// One body of a world; keeps the world alive.
struct PythonBody {
  std::shared_ptr<PythonWorld> world;
  std::size_t index = 0;

  MotionSample sample() const { return world->sample(index); }
};

Motion motionNow(const PythonWorld& world) {
  const std::vector<MotionSample> samples = world.simulation().sample();
  Motion motion({static_cast<py::ssize_t>(samples.size())});
  for (std::size_t i = 0; i < samples.size(); ++i) motion.set(i, samples[i]);
  return motion;
}

Motion run(PythonWorld& world, double duration, std::optional<double> output_step) {
  const double step = output_step.value_or(world.scene().output_step);
  if (!(duration > 0) || !(step >= world.scene().time_step))
    throw py::value_error("duration must be above 0 and output_step at least the time step, " +
                          std::to_string(world.scene().time_step) + " s");
  constexpr double kMostSteps = 1e9;  // as of scenes
  if (!(duration / world.scene().time_step <= kMostSteps))
    throw py::value_error("duration / time_step must be <= 1e9 steps");
  Simulation& simulation = world.simulation();
  MotionRecorder recorder(timesOf(simulation.time(), duration, step), world.scene().time_step);
  recorder.add(simulation.sample());
  world.step(countSteps(duration, world.scene().time_step),
             [&](const Simulation& now) { recorder.add(now.sample()); });
  return motionOf(recorder.motion());
}

py::dict bodiesOf(const std::shared_ptr<PythonWorld>& world) {
  py::dict bodies;
  std::size_t index = 0;
  for (const BodyDef& body : world->scene().bodies)
    bodies[py::str(body.name)] = PythonBody{world, index++};
  return bodies;
}

void applyForce(const PythonBody& body, const InputArray& force, const py::object& at) {
  const Vector3 point =
      at.is_none() ? body.sample().position : vectorFrom(at.cast<InputArray>(), "at");
  body.world->simulation().applyForce(body.index, vectorFrom(force, "force"), point);
}

void setBodyPose(const PythonBody& body, const InputArray& position,
                 const py::object& orientation) {
  const Quaternion q = orientation.is_none() ? body.sample().orientation
                                             : quaternionFrom(orientation.cast<InputArray>());
  body.world->simulation().setPose(body.index, vectorFrom(position, "position"), q);
}

PythonRobot loadUrdf(const std::shared_ptr<PythonWorld>& world, const py::object& path,
                     const py::kwargs& settings) {
  if (!world->simulation().takesRobots())
    throw py::value_error("load_urdf: a scene without robots needs World(scene, robots=True)");
  py::dict robot = settings;
  robot["urdf"] = py::module_::import("os.path").attr("abspath")(path);
  requireReadable(robot["urdf"].cast<std::string>());
  const Scene& before = world->scene();
  py::list robots =
      py::module_::import("json").attr("loads")(before.text).attr("get")("robots", py::list());
  robots.append(robot);
  world->addRobots(parseScene(before.text, before.file, {{"robots", jsonFrom(robots, "robots")}}));
  return {world, robots.size() - 1};
}

py::dict robotsOf(const std::shared_ptr<PythonWorld>& world) {
  py::dict robots;
  std::size_t index = 0;
  for (const RobotDef& robot : world->scene().robots)
    robots[py::str(robot.name)] = PythonRobot{world, index++};
  return robots;
}

py::dict workOf(const PythonBody& body) {
  const AmbientCounters work = body.world->simulation().work(body.index);
  py::dict counts;
  for (const auto& [name, count] : kWorkCounts) counts[name] = work.*count;
  counts["energy_removed"] = work.energy_removed;
  return counts;
}

py::dict wrenchOf(const PythonBody& body) {
  const FluidWrench read = body.world->simulation().wrench(body.index);
  py::dict parts;
  for (const auto& [name, part] : kWrenchParts) parts[name] = arrayOf((read.*part).vector());
  return parts;
}

py::dict wetOf(const PythonBody& body) {
  const WetState wet = body.world->simulation().wet(body.index);
  py::dict state;
  state["volume"] = wet.volume;
  state["share"] = wet.share;
  state["draught"] = wet.draught;
  state["area"] = wet.area;
  state["centre_of_buoyancy"] = arrayOf(wet.centre_of_buoyancy);
  state["region"] = static_cast<int>(wet.region);
  return state;
}

py::list waterInHolds(const PythonBody& body) {
  py::list holds;
  for (const HoldWater& hold : body.world->simulation().holds(body.index)) {
    py::dict facts;
    facts["volume"] = hold.volume;
    facts["capacity"] = hold.capacity;
    facts["inflow"] = hold.inflow;
    facts["flooded"] = hold.flooded;
    facts["drained"] = hold.drained;
    facts["area"] = hold.area;
    facts["freeboard"] = hold.freeboard;
    facts["has_trapped_air"] = hold.has_trapped_air;
    facts["air_pressure"] = hold.air_pressure;
    facts["centre"] = arrayOf(hold.centre);
    facts["level"] = arrayOf(hold.level);
    facts["normal"] = arrayOf(hold.normal);
    holds.append(facts);
  }
  return holds;
}

const Immersed& vesselOf(const PythonBody& body) {
  return body.world->simulation().vessel(body.index);
}

void bindHolds(py::class_<PythonBody>& type) {
  type.def_property_readonly(
          "holds", &waterInHolds,
          R"(Water in the holds of a vessel, a list of dicts; empty for other bodies.

"volume" and "capacity" [m^3], "inflow" from outside in the last step, "flooded" and "drained" in all [m^3], "area" of the
level [m^2], "freeboard" of the lowest opening above it [m] (inf: none is open), "has_trapped_air", "air_pressure" [Pa],
"centre" (3,) of the water, "level" (3,), a point of it [m], and its "normal" (3,); world axes.)")
      .def(
          "set_water",
          [](const PythonBody& b, int hold, double volume) { vesselOf(b).setWater(hold, volume); },
          py::arg("hold"), py::arg("volume"),
          "Fills or empties a hold [m^3]; ValueError if the water does not fit.")
      .def(
          "pump", [](const PythonBody& b, int hold, double rate) { vesselOf(b).pump(hold, rate); },
          py::arg("hold"), py::arg("rate"),
          "Pumps water from the sea into a hold, or out of it (negative), until another rate is "
          "set [m^3/s].")
      .def(
          "set_opening",
          [](const PythonBody& b, int hold, int opening, bool is_open) {
            vesselOf(b).setOpening(hold, opening, is_open);
          },
          py::arg("hold"), py::arg("opening"), py::arg("is_open"),
          "Shuts or opens an opening of a hold: its own in their order, then those added.")
      .def(
          "add_opening",
          [](const PythonBody& b, int hold, const InputArray& place, const InputArray& normal,
             double area) {
            return vesselOf(b).addOpening(hold, vectorFrom(place, "place"),
                                          vectorFrom(normal, "normal"), area);
          },
          py::arg("hold"), py::arg("place"), py::arg("normal"), py::arg("area"),
          "Makes a round hole at a place (3,) [m] with a direction (3,) out of the hold, both in "
          "the frame of the fluid body, and an area [m^2]. Returns its number for set_opening().");
}

void bindForces(py::class_<PythonBody>& type) {
  type.def(
          "apply_force", &applyForce, py::arg("force"), py::arg("at") = py::none(),
          "Adds a force (3,) [N] at a point (3,) [m] for one step; default: at the centre of mass.")
      .def(
          "apply_torque",
          [](const PythonBody& b, const InputArray& torque) {
            b.world->simulation().applyTorque(b.index, vectorFrom(torque, "torque"));
          },
          py::arg("torque"), "Adds a torque (3,) [N m] for one step.")
      .def("set_pose", &setBodyPose, py::arg("position"), py::arg("orientation") = py::none(),
           "Puts the centre of mass to a position (3,) [m], with an orientation (4,) w, x, y, z; "
           "default: the present one. Not of a link: Robot.set_pose() moves all of them.")
      .def(
          "set_twist",
          [](const PythonBody& b, const InputArray& twist) {
            b.world->simulation().setTwist(b.index, twistFrom(twist));
          },
          py::arg("twist"),
          "Sets the twist (6,): angular velocity [rad/s], then velocity of the centre of mass "
          "[m/s]. Not of a link.")
      .def(
          "set_medium",
          [](const PythonBody& b, const py::object& medium) {
            b.world->simulation().setMedium(b.index, mediumFrom(medium));
          },
          py::arg("medium"),
          "Changes the fluid around the body where it is in no water or region of the scene. The "
          "velocity of the body stays.");
}

void bindBody(py::module_& module) {
  py::class_<PythonBody> type(module, "Body",
                              "One body of a world in its present state; world axes.");
  bindForces(type);
  bindHolds(type);
  type.def_property_readonly(
          "position", [](const PythonBody& b) { return arrayOf(b.sample().position); },
          "Position (3,) of the centre of mass [m].")
      .def_property_readonly(
          "orientation",
          [](const PythonBody& b) {
            const Quaternion q = b.sample().orientation;
            return arrayOf(Eigen::Vector4d(q.w(), q.x(), q.y(), q.z()));
          },
          "Unit quaternion (4,) w, x, y, z from the shape's axes to the world's.")
      .def_property_readonly(
          "twist", [](const PythonBody& b) { return arrayOf(b.sample().twist.vector()); },
          "Twist (6,): angular velocity [rad/s], then velocity of the centre of mass [m/s].")
      .def_property_readonly(
          "kinetic_energy",
          [](const PythonBody& b) { return b.world->simulation().vessel(b.index).kineticEnergy(); },
          "Kinetic energy [J] of the body and of the fluid that it moves, which is relative to the "
          "flow. Raises ValueError without a fluid.")
      .def_property_readonly(
          "work", &workOf,
          "Counts of the fluid's work so far, and the energy that bounds have removed [J].")
      .def(
          "read_wrench",
          [](const PythonBody& b, bool is_read) {
            b.world->simulation().readWrench(b.index, is_read);
          },
          py::arg("is_read") = true,
          "Computes `wrench` in each step from the next one on; False: no longer.")
      .def_property_readonly("wrench", &wrenchOf,
                             R"(Mean wrenches on the body in the last step, by part.

Each (6,): torque about the centre of mass [N m], then force [N], world axes. "pressure", "friction", "buoyancy", "waves",
"wind" and "added_mass" come from the fluid, "constraints" from contacts and joints. Together with gravity and applied
forces they are the rate of change of the body's momentum. Raises RuntimeError without read_wrench().

>>> with World(Scene("sphere_fall")) as world:
...     ball = world.bodies["ball"]
...     ball.read_wrench()
...     world.step()
...     bool(ball.wrench["buoyancy"][5] > 0)
True
)")
      .def_property_readonly(
          "wet", &wetOf,
          R"(Part of the body that is in its fluid, below the surface if there is one.

"volume" [m^3], "share" of its volume, "draught" [m] of its lowest point (inf: no surface), "area" [m^2],
"centre_of_buoyancy" (3,) [m] and "region" (-1: none).)");
}

void bindWorldMotion(py::class_<PythonWorld, std::shared_ptr<PythonWorld>>& type) {
  type.def_property_readonly(
          "position", [](const PythonWorld& w) { return motionNow(w).position; },
          "Positions (B, 3) of the centres of mass in world axes [m].")
      .def_property_readonly(
          "orientation", [](const PythonWorld& w) { return motionNow(w).orientation; },
          "Unit quaternions (B, 4) w, x, y, z from the shapes' axes to the world's.")
      .def_property_readonly(
          "orientation_xyzw",
          [](const PythonWorld& w) { return scalarLast(motionNow(w).orientation); },
          "Unit quaternions (B, 4) x, y, z, w, the order of SciPy and PyBullet.")
      .def_property_readonly(
          "twist", [](const PythonWorld& w) { return motionNow(w).twist; },
          "Twists (B, 6): angular velocity [rad/s], then velocity of the centre of mass [m/s], in "
          "world axes.");
}

void bindWorldRobots(py::class_<PythonWorld, std::shared_ptr<PythonWorld>>& type) {
  type.def(
          "load_urdf", &loadUrdf, py::arg("path"),
          R"(Adds the robot of a URDF file, at any time. Its links that collide are bodies NAME/LINK.

Keywords are the keys of robots in scenes: name, position, orientation, fixed_base, joint_positions,
motors, medium, law and so on. File names in keywords are relative to the scene's folder, `path` to the
current folder. States that were saved before cannot be restored any more.

>>> world = World(Scene("pool"), robots=True)
>>> robot = world.load_urdf("data/robots/rudder_boat.urdf", name="boat", position=[0, 0, 0.5])
>>> robot.joints
['helm', 'left_axle', 'right_axle']
)")
      .def_property_readonly("robots", &robotsOf, "Robots by name, in the order of the scene.");
}

py::array commandsOf(const PythonWorld& world) {
  const Thrusters& thrusters = world.simulation().thrusters();
  Eigen::VectorXd commands(static_cast<Eigen::Index>(thrusters.size()));
  for (std::size_t i = 0; i < thrusters.size(); ++i)
    commands[static_cast<Eigen::Index>(i)] = thrusters.command(i);
  return arrayOf(commands);
}

void setCommands(PythonWorld& world, const InputArray& commands) {
  Thrusters& thrusters = world.simulation().thrusters();
  if (commands.ndim() != 1 || commands.shape(0) != static_cast<py::ssize_t>(thrusters.size()))
    throw py::value_error("commands have shape " + shapeText(commands) +
                          "; must be one for each of " + std::to_string(thrusters.size()) +
                          " thrusters");
  for (std::size_t i = 0; i < thrusters.size(); ++i) thrusters.command(i, commands.data()[i]);
}

/// An array of a number of each thruster.
template <class Number>
py::array ofThrusters(const PythonWorld& world, const Number& number) {
  const std::vector<ThrusterState>& states = world.simulation().thrusters().states();
  Eigen::VectorXd numbers(static_cast<Eigen::Index>(states.size()));
  std::transform(states.begin(), states.end(), numbers.begin(), number);
  return arrayOf(numbers);
}

void bindThrusters(py::class_<PythonWorld, std::shared_ptr<PythonWorld>>& type) {
  type.def_property_readonly(
          "thrusters",
          [](const PythonWorld& w) {
            std::vector<std::string> names;
            for (const ThrusterDef& def : w.scene().thrusters) names.push_back(def.name);
            return names;
          },
          "Names of the thrusters (T), in the order of the scene.")
      .def_property(
          "commands", &commandsOf, &setCommands,
          "Commands (T,) of the thrusters, which hold until others are set; at first those of "
          "the scene. Their thrusts follow by the curve and the lag of the scene.")
      .def_property_readonly(
          "thrusts",
          [](const PythonWorld& w) {
            return ofThrusters(w, [](const ThrusterState& s) { return s.load.thrust; });
          },
          "Thrusts (T,) in the last step [N], without what dry discs lose.")
      .def_property_readonly(
          "turns",
          [](const PythonWorld& w) {
            return ofThrusters(w, [](const ThrusterState& s) { return s.drive; });
          },
          "What follows the commands (T,): turns of propellers by numbers [1/s]; of an ideal disc "
          "the thrust that it would have at rest, of other thrusters their thrust [N].")
      .def_property_readonly(
          "powers",
          [](const PythonWorld& w) {
            return ofThrusters(w, [](const ThrusterState& s) { return s.load.power; });
          },
          "Powers (T,) of the shafts of propellers in the last step [W], without what dry discs "
          "lose; 0 of thrusters that have none.");
}

/// An array of a number of each foil.
template <class Number>
py::array ofFoils(const PythonWorld& world, const Number& number) {
  const SceneFoils& foils = world.simulation().foils();
  Eigen::VectorXd numbers(static_cast<Eigen::Index>(foils.size()));
  for (std::size_t i = 0; i < foils.size(); ++i)
    numbers[static_cast<Eigen::Index>(i)] = number(foils, i);
  return arrayOf(numbers);
}

void setFoilCommands(PythonWorld& world, const InputArray& commands) {
  SceneFoils& foils = world.simulation().foils();
  if (commands.ndim() != 1 || commands.shape(0) != static_cast<py::ssize_t>(foils.size()))
    throw py::value_error("foil_commands have shape " + shapeText(commands) +
                          "; must be one for each of " + std::to_string(foils.size()) + " foils");
  for (std::size_t i = 0; i < foils.size(); ++i) foils.command(i, commands.data()[i]);
}

void bindFoils(py::class_<PythonWorld, std::shared_ptr<PythonWorld>>& type) {
  type.def_property_readonly(
          "foils",
          [](const PythonWorld& w) {
            std::vector<std::string> names;
            for (const FoilDef& def : w.scene().foils) names.push_back(def.name);
            return names;
          },
          "Names of the foils (F), in the order of the scene.")
      .def_property(
          "foil_commands",
          [](const PythonWorld& w) {
            return ofFoils(w, [](const SceneFoils& f, std::size_t i) { return f.command(i); });
          },
          &setFoilCommands,
          "Commands (F,) of the foils, which hold until others are set; at first those of the "
          "scene. The angles of those with a curve follow by it and the lag of the scene.")
      .def_property_readonly(
          "foil_angles",
          [](const PythonWorld& w) {
            return ofFoils(w, [](const SceneFoils& f, std::size_t i) { return f.angle(i); });
          },
          "Angles (F,) of the foils about their spans [rad].");
}

void bindStates(py::class_<PythonWorld, std::shared_ptr<PythonWorld>>& type) {
  type.def(
          "state", [](const PythonWorld& w) { return py::bytes(w.simulation().saveState()); },
          "Returns all that changes from step to step, for restore().")
      .def(
          "restore",
          [](PythonWorld& w, const py::bytes& state) {
            w.simulation().restoreState(std::string(state));
          },
          py::arg("state"),
          "Restores a state of this world or of another one of the same scene. The motion then "
          "goes on bit for bit, except where bodies touch each other with several parts of robots' "
          "links.")
      .def(
          "lines",
          [](const PythonWorld& w, const std::vector<std::string>& drawing) {
            return linesOf(w.simulation(), drawing);
          },
          py::arg("drawing") = py::tuple(), kLinesText);
}

}  // namespace

void bindWorld(py::module_& module) {
  bindBody(module);
  py::class_<PythonWorld, std::shared_ptr<PythonWorld>> type(
      module, "World",
      R"(Bullet world with the B bodies of a scene in their fluid, in the order of the scene.

Other threads of Python run while it steps. One thread at a time may use a world.

Parameters
----------
scene : Scene
cache : folder in which fluid bodies are stored and found again; default: the user's, docs/python.md
robots : True: load_urdf() may be called; contacts of a scene without robots then differ in the last bits

>>> with World(Scene("sphere_fall")) as world:
...     world.bodies["ball"].apply_force([1, 0, 0])
...     world.step()
...     bool(world.position[0, 0] > 0)
True
)");
  bindWorldMotion(type);
  bindWorldRobots(type);
  bindThrusters(type);
  bindFoils(type);
  bindStates(type);
  type.def(
      "set_regions", [](PythonWorld& w, const Scene& scene) { w.setRegions(scene); },
      py::arg("scene"),
      "Takes water and regions from another scene from the next step on, such as "
      "world.scene.replace({\"water.level\": 0.5}).");
  type.def(py::init([](const py::object& scene, const py::object& cache, bool robots) {
             if (!py::isinstance<Scene>(scene))
               throw py::type_error("World takes a Scene, as in World(Scene(...))");
             return std::make_shared<PythonWorld>(scene.cast<const Scene&>(), folderFrom(cache),
                                                  robots);
           }),
           py::arg("scene"), py::kw_only(), py::arg("cache") = py::none(),
           py::arg("robots") = false)
      .def(
          "step", [](PythonWorld& w, long long n) { w.step(n, [](const Simulation&) {}); },
          py::arg("n") = 1,
          "Makes n steps of the scene's time step. Raises FloatingPointError if a state is not "
          "finite.")
      .def("run", &run, py::arg("duration"), py::arg("output_step") = py::none(),
           "Makes steps for `duration` [s]. Returns the motion at multiples of the output step [s] "
           "and at the end.")
      .def_property_readonly(
          "time", [](const PythonWorld& w) { return w.simulation().time(); }, "Time [s].")
      .def_property_readonly("bodies", &bodiesOf, "Bodies by name, in the order of the scene.")
      .def_property_readonly("scene", &PythonWorld::scene,
                             "Scene of the world, with the robots that were added.")
      .def_property_readonly(
          "warning", [](const PythonWorld& w) { return w.simulation().warning(); },
          "All reports of the library, a sentence a line; empty: none.")
      .def("close", &PythonWorld::close,
           "Frees the memory of the world, which cannot be used afterwards.")
      .def("__enter__", [](const std::shared_ptr<PythonWorld>& w) { return w; })
      .def("__exit__", [](PythonWorld& w, const py::args&) { w.close(); });
}

}  // namespace ambient
