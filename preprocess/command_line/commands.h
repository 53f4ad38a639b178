#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "bullet_ambient/spatial/pi.h"
#include "preprocess/builder/fluid_body_builder.h"

namespace ambient {

/// ambient_preprocess build
struct BuildArguments {
  std::string input;                        ///< a mesh, or a JSON file with a shape
  std::string output;                       ///< the .ambient file
  double scale = 1;                         ///< multiplies all lengths
  std::string origin = "centre-of-volume";  ///< or x,y,z in the mesh's frame [m]
  bool sheet = false;                       ///< the mesh is an open surface of zero thickness
  bool hull = false;                        ///< the convex hull stands for the mesh
  std::optional<std::string> wrap;          ///< a closed surface does, of that size [m]
  int least_faces = 0;                      ///< the mesh is divided into at least so many
  int panels = kDefaultPanels;              ///< at most so many for the flow; 0: the triangles
  std::vector<int> levels;                  ///< of reduced loads: their numbers of clusters
  double separation_angle = kPi / 2;        ///< of the levels, from pi/2 to pi [rad]
  std::vector<double> drag;                 ///< measured: one, or one per axis; empty: none
  int threads = 0;                          ///< 0: all cores
  std::string solver;                       ///< dense or hierarchical; empty: by the panels
  std::optional<double> memory;             ///< for the flow [GB]; none: what is available
  int waterline = 0;                        ///< subdivisions of the waterline table; 0: none
  bool no_tables = false;                   ///< of the added mass of boxes, cylinders and so on
  bool no_margins = false;                  ///< of a world: hulls and cones without their margins
  bool rebuild = false;                     ///< also where nothing has changed
  bool json = false;
};

/// ambient_preprocess inspect
struct InspectArguments {
  std::string file;
  std::optional<double> mass;          ///< [kg]; none: it is not put on water
  std::vector<double> centre_of_mass;  ///< x, y, z in F [m]; empty: spread evenly over the volume
  double density = 998;                ///< of the water [kg/m^3]
  double gravity = 9.81;               ///< [m/s^2]
  bool json = false;
};

/// ambient_preprocess loads
struct LoadsArguments {
  std::string file;
  std::array<double, 6> twist{};  ///< relative to the fluid, angular velocity first [rad/s, m/s]
  double density = 0;             ///< [kg/m^3]
  double viscosity = 0;           ///< [Pa s]
  double separation_angle = kPi / 2;  ///< from pi/2 to pi [rad]
  std::string law = "published";      ///< of the pressure: or form
  bool no_friction = false;
  bool json = false;
};

/// ambient_preprocess polar
struct PolarArguments {
  std::string file;
  std::string attack = "-90:90:5";  ///< an angle or FROM:TO:STEP [degrees]
  std::string side_slip = "0";
  std::string forward = "x", up = "z";  ///< axes of F, with a sign
  double density = 1;                   ///< [kg/m^3]; matters with viscosity only
  double speed = 1;                     ///< [m/s]; the same
  double viscosity = 0;                 ///< [Pa s]
  double separation_angle = kPi / 2;    ///< from pi/2 to pi [rad]
  std::string law = "published";        ///< of the pressure: or form
  double reference_area = 0;            ///< [m^2]; 0: seen along `up`
  double reference_length = 0;          ///< [m]; 0: extent along `forward`
};

/// ambient_preprocess compare
struct CompareArguments {
  std::string first, second;
  double tolerance = 1e-6;        ///< relative
  std::string law = "published";  ///< of the pressure: or form
  bool json = false;
};

/// ambient_preprocess report
struct ReportArguments {
  std::string input;    ///< as of build
  std::string picture;  ///< an SVG file of the potential to write; empty: none
  double scale = 1;
  bool sheet = false;
  int panels = kDefaultPanels;
  int threads = 0;
  bool json = false;
};

/// ambient_preprocess check
struct CheckArguments {
  std::string input;  ///< a mesh, or a JSON file with one
  double scale = 1;
  bool sheet = false, hull = false;  ///< as of build
  std::optional<std::string> wrap;
  std::string obj;  ///< a file for the triangles of the defects; empty: none
  bool json = false;
};

/// Each of these does one command, with its result on standard output, messages and progress on
/// standard error.
/// @throws UsageError in one line that names the option, the value and the limit.
/// @throws std::runtime_error in one line that names the file, the entity and the limit.
/// @returns the exit status, where bad input need not be the end.
int runBuild(const BuildArguments& arguments);
/// build of a .bullet file into a folder; 1 if a shape failed.
int runWorldBuild(const BuildArguments& arguments);
void runInspect(const InspectArguments& arguments);
void runLoads(const LoadsArguments& arguments);
void runReport(const ReportArguments& arguments);
/// 1 if the input cannot be built.
int runCheck(const CheckArguments& arguments);
void runPolar(const PolarArguments& arguments);
/// 1 if the files differ beyond the tolerance.
int runCompare(const CompareArguments& arguments);

}  // namespace ambient
