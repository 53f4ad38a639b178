#include <hdf5.h>

#include <mutex>
#include <stdexcept>
#include <vector>

#include "bullet_ambient/spatial/inertia.h"
#include "preprocess/hand_over/formats.h"
#include "preprocess/hand_over/number_text.h"

namespace ambient {
namespace {

using Sizes = std::vector<hsize_t>;

/// A handle of HDF5 that closes itself. @throws std::runtime_error if there is none.
class Handle {
 public:
  Handle(hid_t id, herr_t (*close)(hid_t)) : id_(id), close_(close) {
    if (id < 0) throw std::runtime_error("HDF5 has failed to make a BEMIO file in memory");
  }
  ~Handle() { close_(id_); }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  operator hid_t() const { return id_; }  // NOLINT: as HDF5 has it

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

void check(herr_t status) {
  if (status < 0) throw std::runtime_error("HDF5 has failed to make a BEMIO file in memory");
}

/// An HDF5 file in memory. Its bytes hold no times.
class MemoryFile {
 public:
  MemoryFile() : access_(H5Pcreate(H5P_FILE_ACCESS), H5Pclose), file_(made(access_), H5Fclose) {}

  /// A dataset of doubles, row by row, with the attributes that BEMIO gives it.
  void numbers(const std::string& path, const Sizes& sizes, const std::vector<double>& values,
               const char* description, const char* units) const {
    const Handle space(H5Screate_simple(static_cast<int>(sizes.size()), sizes.data(), nullptr),
                       H5Sclose);
    const Handle data = dataset(path, H5T_IEEE_F64LE, space);
    if (!values.empty())
      check(H5Dwrite(data, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()));
    attribute(data, "description", description);
    attribute(data, "units", units);
  }

  void text(const std::string& path, const std::string& value) const {
    const Handle type = textType(value), space(H5Screate(H5S_SCALAR), H5Sclose);
    const Handle data = dataset(path, type, space);
    check(H5Dwrite(data, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, value.data()));
  }

  std::string bytes() const {
    check(H5Fflush(file_, H5F_SCOPE_GLOBAL));
    const ssize_t size = H5Fget_file_image(file_, nullptr, 0);
    check(size < 0 ? -1 : 0);
    std::string bytes(static_cast<std::size_t>(size), '\0');
    check(H5Fget_file_image(file_, bytes.data(), bytes.size()) < 0 ? -1 : 0);
    return bytes;
  }

 private:
  static hid_t made(hid_t access) {
    constexpr std::size_t kGrowth = 1 << 16;
    check(H5Pset_fapl_core(access, kGrowth, false));
    return H5Fcreate("bemio.h5", H5F_ACC_TRUNC, H5P_DEFAULT, access);
  }

  Handle dataset(const std::string& path, hid_t type, hid_t space) const {
    const Handle links(H5Pcreate(H5P_LINK_CREATE), H5Pclose);
    const Handle creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
    check(H5Pset_create_intermediate_group(links, 1));
    check(H5Pset_obj_track_times(creation, false));
    return {H5Dcreate2(file_, path.c_str(), type, space, links, creation, H5P_DEFAULT), H5Dclose};
  }

  static Handle textType(const std::string& value) {
    const hid_t type = H5Tcopy(H5T_C_S1);
    if (type >= 0) check(H5Tset_size(type, value.size()));
    return {type, H5Tclose};
  }

  static void attribute(hid_t data, const char* name, const std::string& value) {
    if (value.empty()) return;
    const Handle type = textType(value), space(H5Screate(H5S_SCALAR), H5Sclose);
    const Handle made(H5Acreate2(data, name, type, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
    check(H5Awrite(made, type, value.data()));
  }

  Handle access_, file_;
};

std::vector<double> rowByRow(const Matrix6& matrix) {
  std::vector<double> values;
  for (int i = 0; i < 36; ++i) values.push_back(matrix(i / 6, i % 6) + 0.0);
  return values;
}

// A point of F in the frame of the water: axes forward, left and up, origin in the surface below or
// above that of F.
std::vector<double> aboveWater(const HandedBody& body, const Vector3& point) {
  const Vector3 in_axes = body.axes().transpose() * point;
  return {in_axes.x() + 0.0, in_axes.y() + 0.0, -body.plane.depth(point)};
}

void addProperties(const MemoryFile& file, const HandedBody& body) {
  const std::string group = "/body1/properties/";
  const auto number = [&](const char* name, double value, const char* description,
                          const char* units) {
    file.numbers(group + name, {1, 1}, {value}, description, units);
  };
  file.text(group + "name", body.name);
  number("body_number", 1, "Number of rigid body", "");
  number("dof", 6, "Degrees of freedom", "");
  number("dof_start", 1, "Degrees of freedom", "");
  number("dof_end", 6, "Degrees of freedom", "");
  number("disp_vol", body.wet.volume, "Displaced volume", "m^3");
  file.numbers(group + "cg", {3, 1}, aboveWater(body, body.weight.centre), "Center of gravity",
               "m");
  file.numbers(group + "cb", {3, 1}, aboveWater(body, body.middle()), "Center of buoyancy", "m");
}

// Without frequencies: what depends on them is empty.
void addCoefficients(const MemoryFile& file, const HandedBody& body) {
  const std::string group = "/body1/hydro_coeffs/";
  const double density = body.settings.medium.density;
  const Matrix3 turn = body.axes().transpose();
  const Vector3& centre = body.weight.centre;
  const Matrix6 added = FrameOffset{turn, -(turn * centre)}.inertiaToB(body.added_mass) / density;
  const Matrix6 stiffness =
      rotateAxes(restoringStiffness(body.wet, body.plane, body.weight, centre), turn) /
      (density * body.settings.gravity);
  file.numbers(group + "linear_restoring_stiffness", {6, 6}, rowByRow(linearFirst(stiffness)),
               "Hydrostatic stiffness matrix (normalized by rho*g)", "N/m");
  file.numbers(group + "added_mass/inf_freq", {6, 6}, rowByRow(linearFirst(added)),
               "Infinite frequency added mass (normalized by rho)", "kg");
  file.numbers(group + "added_mass/all", {6, 6, 0}, {}, "Added mass (normalized by rho)", "kg");
  file.numbers(group + "radiation_damping/all", {6, 6, 0}, {},
               "Radiation damping (normalized by rho*w)", "N-s/m");
}

}  // namespace

ExportedBody makeBemio(const HandedBody& body) {
  static std::mutex one_at_a_time;  // HDF5 is mostly built for one thread
  const std::lock_guard<std::mutex> lock(one_at_a_time);
  const MemoryFile file;
  const std::string group = "/simulation_parameters/";
  file.text("/bem_data/code", "bullet_ambient");
  file.text(group + "water_depth", "infinite");
  file.numbers(group + "scaled", {1, 1}, {0}, "", "");
  file.numbers(group + "g", {1, 1}, {body.settings.gravity}, "Gravitational acceleration", "m/s^2");
  file.numbers(group + "rho", {1, 1}, {body.settings.medium.density}, "Water density", "kg/m^3");
  file.numbers(group + "T", {0, 1}, {}, "Wave periods", "s");
  file.numbers(group + "w", {0, 1}, {}, "Wave frequencies", "rad/s");
  file.numbers(group + "wave_dir", {0, 1}, {}, "Wave direction", "deg");
  addProperties(file, body);
  addCoefficients(file, body);
  return {file.bytes(), ""};
}

}  // namespace ambient
