#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "bullet_ambient/fluid_body/added_mass_parts.h"
#include "bullet_ambient/spatial/vector_types.h"

namespace ambient {

/// List of numbers. Copies share their memory until one of them is to be changed, own().
template <class Number>
class SharedList {
 public:
  using List = std::vector<Number>;

  SharedList() = default;
  SharedList(List numbers) {
    if (!numbers.empty()) list_ = std::make_shared<List>(std::move(numbers));
  }
  SharedList(std::initializer_list<Number> numbers) : SharedList(List(numbers)) {}
  template <class Iterator>
  SharedList(Iterator begin, Iterator end) : SharedList(List(begin, end)) {}

  operator const List&() const { return get(); }
  const List& get() const {
    static const List kNone;
    return list_ ? *list_ : kNone;
  }
  /// Returns the list to change it; no copy sees that.
  List& own() {
    if (!list_ || list_.use_count() > 1) list_ = std::make_shared<List>(get());
    return *list_;
  }

  std::size_t size() const { return get().size(); }
  bool empty() const { return get().empty(); }
  const Number* data() const { return get().data(); }
  const Number& operator[](std::size_t i) const { return (*list_)[i]; }
  auto begin() const { return get().begin(); }
  auto end() const { return get().end(); }
  friend bool operator==(const SharedList& a, const SharedList& b) { return a.get() == b.get(); }
  friend bool operator!=(const SharedList& a, const SharedList& b) { return !(a == b); }

 private:
  std::shared_ptr<List> list_;  ///< null: empty
};

/// Triangles of a shape in F: for drawing, hydrostatics and the form law.
struct Surface {
  std::vector<double> vertices;        ///< x, y, z per vertex [m]
  SharedList<std::int32_t> triangles;  ///< three vertex indices per triangle, counter-clockwise
                                       ///< from the fluid
};

/// An opening of a hold: where water comes in over its rim or through it.
struct HoldOpening {
  std::vector<double> outline;    ///< x, y, z of its corners, counter-clockwise from outside [m]
  std::vector<std::int32_t> lid;  ///< triangles across it: three corners of the outline each
  int to = -1;                    ///< the hold that it leads to; -1: the fluid outside
};

/// A room inside a body that keeps water out or in up to its openings. Per unit density, in F.
struct Hold {
  std::string name;
  Surface surface;          ///< its walls and lids, closed, counter-clockwise from outside the hold
  double volume = 0;        ///< [m^3]
  Vector3 centre{0, 0, 0};  ///< of its volume [m]
  /// Inertia of the fluid that fills it, about its centre, as it resists turning, docs/theory.md
  /// eq. (133) [m^5].
  Matrix3 turning_inertia = Matrix3::Zero();
  std::vector<HoldOpening> openings;  ///< each once: one between two holds is the first hold's
};

/// Inertia of the fluid in a closed box as it resists turning, per mass, docs/theory.md eq. (133)
/// [m^2].
/// @param a,b squares of the sides across the axis [m^2]
double boxTurning(double a, double b) noexcept;

/// Flow past a body that moves one way, as boundary layers change it; docs/theory.md eq. (97) to
/// (99). On its frontal area and D_A, without unit. The first four of a state of the layers:
/// laminar; laminar to its separation and turbulent from there (a bubble); turbulent from the nose,
/// smooth and rough (four times the growth).
struct SeparationWay {
  static constexpr std::size_t kNumbers = 8;
  double wake_laminar = 0, wake_bubble = 0, wake_turbulent = 0,
         wake_rough = 0;  ///< k_L, k_B, k_1, k_4
  double thickness =
      0;  ///< N: momentum thickness where the laminar layer leaves, over D_A Re^(-1/2)
  double friction_laminar = 0;    ///< f_L, times Re^(-1/2)
  double friction_bubble = 0;     ///< f_B, times Re^(-1/5)
  double friction_turbulent = 0;  ///< f_T, times Re^(-1/5)
};

/// Where boundary layers leave a shape that moves along an axis of its added mass, either way;
/// docs/theory.md eq. (97) to (100). Without unit: the same for a larger shape.
struct Separation {
  Matrix3 axes{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};  ///< columns q_j, right-handed
  std::array<SeparationWay, 6> ways;              ///< of +q_1, -q_1, +q_2, ...
  Vector3 smooth_base{0, 0, 0};  ///< B_j in [0, 1]: 0 where edges make all of the base
};

/// Sizes of a surface that Reynolds numbers, areas and the twist of separated flow are made of;
/// docs/theory.md eq. (101). Both sides of a sheet count.
struct SurfaceNumbers {
  double diameter = 0;       ///< D_A = sqrt(area/pi): of the ball with this area [m]
  Vector3 frontal{0, 0, 0};  ///< A_j: half of the projected area of all faces along q_j [m^2]
  Vector3 moments{0, 0, 0};  ///< m_j: mean square of the place along q_j [m^2]
  Matrix3 gyration =
      Matrix3::Zero();  ///< G: mean of |r|^2 I - r r^T about the centre of reaction [m^2]
};

/// Numbers of a shape for a fluid with viscosity, docs/theory.md section 18. Frame F.
struct ViscousForm {
  static constexpr std::size_t kNumbers = 116;
  /// Resistance in creeping flow about F's origin, rotation first, per unit viscosity: as Re -> 0
  /// the wrench is -mu R (w, v). Symmetric, positive semi-definite [m^3, m^2, m]. 0: not known.
  Matrix6 resistance = Matrix6::Zero();
  Vector3 centre_of_reaction{0, 0, 0};  ///< where the coupling of R is symmetric [m]
  Separation separation;  ///< smooth_base is 0 where it is not known: all of the base is by edges
  SurfaceNumbers surface;
  double sharp_share = 1;  ///< eps': how far edges and thin plates fix where the flow leaves
  /// True if `smooth_base` is that of a simple shape, whose rims are no edges in (J1).
  bool is_primitive = false;

  bool isKnown() const { return !resistance.isZero(0); }
  /// All numbers in the order above, matrices by columns, which is that of files.
  std::array<double*, kNumbers> numbers();
  std::array<const double*, kNumbers> numbers() const;
};

/// Correction of the added mass at the surface of still water, docs/theory.md eq. (61a): boundary
/// elements minus the sum over parts (60). Per unit density, about F's origin.
struct WaterlineTable {
  /// Immersion from which on the surface is ignored; see `immersions`.
  static constexpr double kDeep = 3;

  /// Subdivisions of the lattice of the surface's normals in F; 0: there is no table.
  int subdivisions = 0;
  /// Immersions eta: depth of the lowest point over the height of the body. Ascending, in
  /// (0, kDeep); at kDeep the correction is 0.
  std::vector<double> immersions;
  /// Symmetric matrices; index: normal times number of immersions, plus immersion.
  std::vector<Matrix6> corrections;

  bool empty() const { return subdivisions == 0; }
};

/// Place in a fluid body for the tables that loads make of it: made on first use, shared by all
/// worlds of the process, freed with the fluid body. A copy of the fluid body begins without.
class TablesSlot {
 public:
  TablesSlot() = default;
  TablesSlot(const TablesSlot&) {}
  TablesSlot& operator=(const TablesSlot&) {
    tables_ = nullptr;
    return *this;
  }

  /// Returns the tables; makes empty ones at the first call, by whichever thread comes first.
  template <class Tables>
  Tables& get() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (!tables_) tables_ = std::make_shared<Tables>();
    return *static_cast<Tables*>(tables_.get());
  }

 private:
  mutable std::mutex mutex_;
  mutable std::shared_ptr<void> tables_;
};

/// Faces that carry the fluid loads, as a structure of arrays with one entry per face.
/// Frame: fluid body frame F. Normals and centroids determine the slip matrix of the paper's
/// appendix (3F x 6), U_i = -(I - n n^T) [-[c]x, I], which is not stored.
struct FaceTable {
  SharedList<double> normal_x, normal_y, normal_z;         ///< unit normals into the fluid
  std::vector<double> centroid_x, centroid_y, centroid_z;  ///< barycentres [m]
  std::vector<double> area;                                ///< [m^2]
  /// 0 on a round surface, 1 on a flat one or at an edge, more on long flat sides; docs/theory.md
  /// eq. (45). In [0, 2]; empty: not known.
  std::vector<double> sharpness;

  std::size_t size() const { return area.size(); }
  /// All columns in the order above, except sharpness, which can be computed from the surface.
  std::array<const std::vector<double>*, 7> columns() const {
    return {&normal_x.get(),
            &normal_y.get(),
            &normal_z.get(),
            &centroid_x,
            &centroid_y,
            &centroid_z,
            &area};
  }
  Vector3 normal(std::size_t i) const { return {normal_x[i], normal_y[i], normal_z[i]}; }
  Vector3 centroid(std::size_t i) const { return {centroid_x[i], centroid_y[i], centroid_z[i]}; }
  void reserve(std::size_t faces);
  void add(const Vector3& normal, const Vector3& centroid, double area);
};

/// Numbers of a shape that tell the form law a wing from a block, and a slender hull from both;
/// docs/theory.md eq. (45a) to (45d). All follow from added mass, faces and surface. Frame F.
struct FormShape {
  static constexpr std::size_t kNumbers = 19;
  double wing = 0;           ///< W in [0, 1]: 1 of a thin plate, 0 of a body as thick as it is wide
  double edges = 1;          ///< E in [0, 1]: 0 of a smooth body, 1 of a sheet
  double aspect = 1;         ///< L >= 1: span over chord
  double chord = 0;          ///< c_w [m]
  Vector3 facing{0, 0, 0};   ///< z: normal of the mean plane, either way; unit length
  Vector3 span{0, 0, 0};     ///< h: longest direction of that plane, either way; unit length
  Vector3 slender{0, 0, 0};  ///< m: long axis of a smooth slender body; length in [0, 1]
  Vector3 pitching{0, 0, 0};  ///< a: axis of pitching of a wing, along the span; length in [0, 1]
  Vector3 centre{0, 0, 0};    ///< centre of volume [m]

  bool isWing() const { return wing > 0; }
  bool isSlender() const { return !slender.isZero(0); }
  /// Returns mu of a face, eq. (43d): its arm in pitching [m].
  double pitchingArm(const Vector3& normal, const Vector3& place) const;
  /// All numbers in the order above, which is that of files.
  std::array<double*, kNumbers> numbers();
  std::array<const double*, kNumbers> numbers() const;
};

/// Thin part of a shape that lifts where it is: a wing, a fin, a blade; docs/theory.md section 21.
/// Frame F.
struct Wing {
  static constexpr std::size_t kNumbers = 14;
  std::string name;            ///< of the node or group in the mesh file; may be empty
  Vector3 facing{0, 0, 1};     ///< z: normal of its mean plane, either way; unit length
  Vector3 span_axis{0, 1, 0};  ///< h: away from the joint, if it has one; unit length, across z
  Vector3 centre{0, 0, 0};     ///< of its mean surface [m]
  double span = 0;             ///< b [m]
  double chord = 0;            ///< c [m]
  double thickness = 0;        ///< t, mean [m]
  double aspect = 1;           ///< L of eq. (156), with the image in what it is joined to
  double body_lift = 1;        ///< kappa of eq. (157): 1 to 2
  bool is_joined = false;      ///< to the rest of the body or to another part
  double camber = 0;           ///< zeta: rise of the mean line towards z over the chord, eq. (166)
  /// Round end of its section: 1 towards h x z, -1 the other way, 2 both; 0: none. Such a wing acts
  /// by its mean surface, eq. (161b), (161e).
  double nose = 0;

  /// Returns k of eq. (156), its added mass along z per unit density [m^3].
  double plateMass() const;
  /// All numbers but is_joined in the order above, which is that of files.
  std::array<double*, kNumbers> numbers();
  std::array<const double*, kNumbers> numbers() const;
};

/// Surface as the form law and hydrostatics see it: follows from the other fields of a fluid body
/// and is made by prepare() of the preprocessor.
struct SurfaceForm {
  FormShape shape;
  /// Faces that the form law is summed over, with sharpness; see formLawFaces() of the
  /// preprocessor.
  FaceTable faces;
  /// Triangles for hydrostatics, three indices of vertices of the surface each: those of the
  /// surface, with fans of few triangles in place of flat sides.
  SharedList<std::int32_t> hull;
  /// Part of each of `faces`: 0 the rest, else the number of its wing from 1 on; empty: no wings.
  std::vector<std::uint8_t> part_of_face;
  FormShape rest;  ///< of a body with wings: shape of what is no wing
  /// W of each wing, eq. (158).
  std::vector<double> wing_shares;
};

/// Revision of the form law that levels are fitted to. 1: eq. (43) for every body; 2: with wings
/// and slender hulls.
constexpr int kFormLawRevision = 3;

/// Smaller set of faces that replaces all faces in the sums of the form law.
struct FormLevel {
  FaceTable faces;  ///< with sharpness
  /// 99th percentile of the load error over motions, relative to 1/2 rho sum A_i |u_i|^2.
  double p99_error = 0;
  int law_revision = kFormLawRevision;  ///< an earlier one is used for blocks only
};

/// Distribution of a mass of 1 kg: centre of mass [m] in F, and inertia about that centre
/// [kg m^2 per kg = m^2] in F's axes.
struct MassDistribution {
  Vector3 centre{0, 0, 0};
  Matrix3 inertia = Matrix3::Zero();
};

/// Most wings of a fluid body.
constexpr std::size_t kMostWings = 255;
/// Largest camber of a wing or foil, either way.
constexpr double kMostCamber = 0.2;

/// Record of how a fluid body was made.
struct Provenance {
  std::string source;                  ///< file name or shape description, without directories
  std::uint64_t source_hash = 0;       ///< FNV-1a of the source's bytes
  std::string settings;                ///< solver settings, as text
  std::string generator;               ///< program and version that made the fluid body
  std::vector<std::string> said = {};  ///< what a user should know of it, one line each
};

/// Largest measured drag coefficient; keeps its products with the motion finite.
constexpr double kLargestDrag = 1e6;

/// Data of one shape for the fluid loads: plain data, per unit fluid density, independent of mass
/// and medium. Frame F: axes of the source mesh, origin chosen by the builder (default: centre of
/// volume).
struct FluidBody {
  std::string name;
  Provenance provenance;
  Matrix6 added_mass =
      Matrix6::Zero();   ///< K_fluid / rho about F's origin, symmetric positive semi-definite
  double asymmetry = 0;  ///< largest |K - K^T| before symmetrising, over the largest |K| [1]
  double volume = 0;     ///< displaced volume [m^3], with that of the holds; 0 for a sheet
  double area = 0;       ///< wetted area [m^2]
  Vector3 centre_of_volume{0, 0, 0};  ///< in F [m]
  Vector3 origin{0, 0, 0};            ///< F's origin in the source mesh's frame [m]
  MassDistribution uniform_mass;      ///< uniform density inside
  MassDistribution surface_mass;      ///< uniform mass per area
  FaceTable faces;                    ///< empty: no loads, unless they are left out
  bool omits_faces = false;           ///< true: `faces` are left out, `surface` has them: facesOf()
  Surface surface;
  SurfaceForm form;                    ///< made by prepare(); spheres need none
  ViscousForm viscous;                 ///< made by prepare(); spheres need none
  std::vector<FormLevel> form_levels;  ///< fewer faces for the form law; may be empty
  /// Radius of a sphere about the centre of volume [m]; 0: the body is no sphere. Loads on a sphere
  /// have a closed form, docs/theory.md section 10; faces and levels are not evaluated.
  double sphere_radius = 0;
  /// Measured drag coefficients along the axes of F, on half the projected area of all faces, which
  /// is the frontal area of a convex body; setMeasuredDrag() takes them on the frontal area of any.
  /// The drag of the form law is scaled to them, eq. (51). All three are positive, at most
  /// kLargestDrag, or all are 0: not measured.
  Vector3 drag{0, 0, 0};
  /// Parts of the added mass, one per patch of the surface, for bodies that the water's surface
  /// cuts. The sum of all parts is the added mass up to discretisation; empty: not known.
  AddedMassParts added_mass_parts;
  /// Correction to the sum over added_mass_parts at the surface of the water; may be empty.
  WaterlineTable waterline;
  /// Rooms that keep water out or in; surface, faces, volume, area and added mass are those of the
  /// closed vessel, with lids across their openings. Empty: none.
  std::vector<Hold> holds;
  /// Parts that the form law lifts one by one, at most kMostWings; empty: the body is one part.
  std::vector<Wing> wings;
  /// The part of each triangle of the surface, 0 or the number of its wing from 1 on; empty without
  /// wings. Both sides of a sheet are one part.
  std::vector<std::uint8_t> part_of_triangle;
  TablesSlot tables;  ///< of the loads; a fluid body that loads were made of must not change
};

/// Sizes of the bounding box of the body's surface along the axes of F [m]; 0 without a surface.
Vector3 extentsOf(const FluidBody& body);

/// Returns the axis of a body of revolution, through the centre of volume: the one spin that moves
/// next to no fluid. Unit vector, either way, in F; 0: the body is none, or a sphere.
Vector3 axisOfRevolution(const FluidBody& body);

/// Returns the shape enlarged by s = `factor` about F's origin: areas grow by s^2, volumes by s^3,
/// added mass by s^3 to s^5, see scaleShape(). The factor is appended to provenance.settings.
/// @throws std::invalid_argument if the factor is not positive and finite, or leaves no finite
/// area, volume and added mass above zero.
FluidBody scaled(const FluidBody& body, double factor);

/// Returns the faces of a body; if it omits them, those of the triangles of its surface, without
/// sharpness. Cost then: O(F).
FaceTable facesOf(const FluidBody& body);

/// Returns the body, or a copy with its faces if it omits them.
std::shared_ptr<const FluidBody> withFaces(const std::shared_ptr<const FluidBody>& body);

/// Throws std::invalid_argument: one line that names the fluid body, the value and the limit.
[[noreturn]] void reject(const FluidBody& body, const std::string& what, double value,
                         const char* limit);

/// Returns true if the form is there, or nothing needs one: a sphere, or a body without faces and
/// surface.
bool isPrepared(const FluidBody& body);

/// Throws std::invalid_argument, in one line that tells how to make the form, unless isPrepared().
void requirePrepared(const FluidBody& body);

/// FNV-1a hash of all data that influence motion: added mass, volume, area, centre of volume,
/// faces, form, viscous form, levels, drag, sphere radius, surface triangles, parts of the added
/// mass, waterline table, holds and wings. Name and provenance do not count. Saved states hold the
/// hash to recognise their fluid body. Detects accidental change, not forgery.
std::uint64_t contentHash(const FluidBody& body);

/// Mass of a body, and mass of the medium that it displaces; afloat: of the fluid above the
/// surface, since it may float however light it is, but not on air.
struct DisplacedMass {
  double body = 0;    ///< [kg]
  double medium = 0;  ///< [kg]

  bool isLighter() const { return body < medium; }
  /// True if the body has less than half the mass of the medium and so rises fast, which is hardly
  /// meant in air.
  bool isMuchLighter() const { return 2 * body < medium; }
};

}  // namespace ambient
