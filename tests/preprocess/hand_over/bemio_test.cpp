#include <gtest/gtest.h>
#include <hdf5.h>

#include <algorithm>

#include "preprocess/hand_over.h"
#include "tests/preprocess/hand_over/handed_bodies.h"
#include "tests/support/temporary_folder.h"

namespace ambient::test {
namespace {

/// A file on disk, read by HDF5.
class BemioFile {
 public:
  BemioFile(const std::shared_ptr<const FluidBody>& body, const ExportSettings& settings) {
    const auto path = folder_ / "body.h5";
    exportFluidBody(body, ExportFormat::kBemio, settings).write(path);
    file_ = H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
    EXPECT_GE(file_, 0);
  }
  ~BemioFile() { H5Fclose(file_); }

  /// The numbers of a dataset, whose sizes must be these.
  std::vector<double> at(const std::string& path, const std::vector<hsize_t>& sizes) const {
    const hid_t data = H5Dopen2(file_, path.c_str(), H5P_DEFAULT), space = H5Dget_space(data);
    std::vector<hsize_t> found(static_cast<std::size_t>(H5Sget_simple_extent_ndims(space)));
    H5Sget_simple_extent_dims(space, found.data(), nullptr);
    EXPECT_EQ(found, sizes) << path;
    std::vector<double> values(static_cast<std::size_t>(H5Sget_simple_extent_npoints(space)));
    EXPECT_GE(H5Dread(data, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), 0);
    H5Sclose(space);
    H5Dclose(data);
    return values;
  }
  Matrix6 matrix(const std::string& path) const {
    using Rows = Eigen::Matrix<double, 6, 6, Eigen::RowMajor>;
    return Eigen::Map<const Rows>(at(path, {6, 6}).data());
  }
  Vector3 vector(const std::string& path) const {
    return Eigen::Map<const Eigen::Vector3d>(at(path, {3, 1}).data());
  }
  /// The latest of the times that are kept of an object; 0: none.
  time_t timeOf(const std::string& path) const {
    H5O_info_t info;
    EXPECT_GE(H5Oget_info_by_name(file_, path.c_str(), &info, H5P_DEFAULT), 0);
    return std::max({info.atime, info.mtime, info.ctime, info.btime});
  }
  double number(const std::string& path) const { return at(path, {1, 1}).at(0); }

 private:
  TemporaryFolder folder_;
  hid_t file_ = -1;
};

ExportSettings afloat(double draught) {
  ExportSettings settings = inSea();
  settings.draught = draught;
  return settings;
}

TEST(Bemio, HasTheHydrostaticsOfASphere) {
  ExportSettings settings = afloat(0.5);
  settings.centre_of_mass = {0.05, 0, -0.1};
  const BemioFile file(sphereBody(0.5), settings);
  const double pi = portable::acos(-1.0), volume = 2.0 / 3 * pi * 0.125, area = pi * 0.25;
  EXPECT_EQ(file.number("/simulation_parameters/rho"), kSeaDensity);
  EXPECT_EQ(file.number("/simulation_parameters/g"), kSeaGravity);
  EXPECT_EQ(file.number("/simulation_parameters/scaled"), 0);
  EXPECT_NEAR(file.number("/body1/properties/disp_vol"), volume, 1e-12);
  EXPECT_LT((file.vector("/body1/properties/cg") - Vector3(0.05, 0, -0.1)).norm(), 1e-12);
  EXPECT_LT((file.vector("/body1/properties/cb") - Vector3(0, 0, -0.375 * 0.5)).norm(), 1e-12);
  // All pressure goes through the middle, which is 0.1 m above and 0.05 m behind the centre of
  // mass. There the waterplane goes down as the bow does. The body is not in balance: its buoyancy
  // turns with it.
  Matrix6 stiffness = Matrix6::Zero();
  stiffness.diagonal() << 0, 0, area, volume * 0.1, volume * 0.1 + area * 0.05 * 0.05, 0;
  stiffness(2, 4) = stiffness(4, 2) = area * 0.05;
  stiffness(3, 5) = stiffness(5, 3) = volume * 0.05 / 2;
  const Matrix6 K = file.matrix("/body1/hydro_coeffs/linear_restoring_stiffness");
  EXPECT_LT((K - stiffness).norm(), 1e-12) << K;
}

// About the centre of mass, axes forward, left and up, per unit density.
TEST(Bemio, AddedMassHasTheKineticEnergyOfTheFluid) {
  const PlacedEllipsoid placed;
  ExportSettings settings = afloat(1000);  // deep
  settings.centre_of_mass = {0.3, 0.1, -0.2};
  settings.forward = -Vector3::UnitY();
  settings.up = Vector3::UnitX();
  const BemioFile file(bodyOf(placed), settings);
  OtherFrame frame{*settings.centre_of_mass, {}};
  frame.axes << settings.forward, settings.up.cross(settings.forward), settings.up;
  const Matrix6 K = file.matrix("/body1/hydro_coeffs/added_mass/inf_freq");
  EXPECT_LT(energyError(K, placed, frame), 1e-13);
  EXPECT_LT(file.vector("/body1/properties/cg").z(), -990);
}

TEST(Bemio, HasNoFrequencies) {
  const BemioFile file(sphereBody(0.5), afloat(0.5));
  EXPECT_TRUE(file.at("/simulation_parameters/w", {0, 1}).empty());
  EXPECT_TRUE(file.at("/body1/hydro_coeffs/added_mass/all", {6, 6, 0}).empty());
  EXPECT_TRUE(file.at("/body1/hydro_coeffs/radiation_damping/all", {6, 6, 0}).empty());
}

// A body has the same bytes at any time.
TEST(Bemio, HoldsNoTimes) {
  const BemioFile file(sphereBody(0.5), afloat(0.5));
  for (const char* path : {"/body1/properties/cg", "/body1", "/bem_data/code"})
    EXPECT_EQ(file.timeOf(path), 0) << path;
}

}  // namespace
}  // namespace ambient::test
