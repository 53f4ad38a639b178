#include <nlohmann/json.hpp>

#include "tests/preprocess/command_line/command_line.h"

namespace ambient {
namespace {

class Export : public CommandLine {
 protected:
  void SetUp() override {
    const ProgramResult built = run({"build", write("ball.json", sphereText()), "-o", ball()});
    ASSERT_EQ(built.exit_code, 0) << built.errors;
  }

  std::string ball() const { return path("ball.ambient"); }

  /// Arguments of an export of the ball to out.x.
  Arguments exporting(const std::string& format, const Arguments& more = {}) const {
    return appended({"export", ball(), "--format", format, "-o", path("out.x")}, more);
  }
};

TEST_F(Export, WritesToStandardOutputOrAFile) {
  for (const std::string format : {"sdf", "mjcf", "fossen"}) {
    const ProgramResult shown = run({"export", ball(), "--format", format});
    EXPECT_EQ(shown.exit_code, 0) << shown.errors;
    const ProgramResult written = run(exporting(format));
    EXPECT_EQ(written.exit_code, 0) << written.errors;
    EXPECT_EQ(bytesOfFile("out.x"), shown.output);
    // Errors of MJCF are shown beside the file, too.
    EXPECT_EQ(written.output.empty(), format != "mjcf") << written.output;
  }
}

TEST_F(Export, OptionsReachTheFile) {
  const Arguments options{"--density", "1000", "--viscosity", "0", "--gravity",        "10",
                          "--mass",    "300",  "--up",        "y", "--forward",        "-x",
                          "--draught", "0.6",  "--speed",     "2", "--centre-of-mass", "0.1",
                          "0.2",       "0.3"};
  ASSERT_EQ(run(exporting("fossen", options)).exit_code, 0);
  const auto made = nlohmann::json::parse(bytesOfFile("out.x"));
  EXPECT_EQ(made["density"], 1000);
  EXPECT_EQ(made["gravity"], 10);
  EXPECT_EQ(made["mass"], 300);
  EXPECT_EQ(made["draught"], 0.6);
  EXPECT_EQ(made["speed"], 2);
  // Forward -x, to starboard forward times up = -z, down -y.
  EXPECT_EQ(made["centre_of_gravity"], nlohmann::json({-0.1, -0.3, -0.2}));
}

TEST_F(Export, BadOptionsAreRefusedInOneLine) {
  expectUsageRefusals("options of export", {"export", ball(), "-o", path("out.x")});
}

TEST_F(Export, BadInputIsRefusedInOneLine) {
  const std::size_t before = fileCount();
  EXPECT_EQ(refusal(exporting("sdf", {"--centre-of-mass", "0", "nan", "0"})),
            ball() +
                ": fluid body 'ball': distance of the centre of mass [m] is nan, must be "
                "finite");
  EXPECT_NE(refusal({"export", path("none.ambient"), "--format", "sdf"}).find("none.ambient"),
            std::string::npos);
  EXPECT_EQ(fileCount(), before) << "a file was left behind";
}

TEST_F(Export, PlacesThatCannotBeWrittenAreRefused) {
  const std::string nowhere = path("none/out.sdf");
  EXPECT_EQ(refusal({"export", ball(), "--format", "sdf", "-o", nowhere}),
            nowhere + ": the directory \"" + path("none") + "\" does not exist");
  EXPECT_EQ(refusal({"export", ball(), "--format", "sdf", "-o", folder_.path().string()}),
            folder_.path().string() + ": is a directory");
  EXPECT_EQ(refusal({"export", ball(), "--format", "sdf", "-o", ball()}),
            ball() + ": the output would replace the input");
  EXPECT_EQ(refusal({"export", ball(), "--format", "sdf", "-o", "/dev/full"}),
            "/dev/full: is not a regular file");
}

}  // namespace
}  // namespace ambient
