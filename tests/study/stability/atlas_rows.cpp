#include "tests/study/stability/atlas_rows.h"

namespace ambient {
namespace {

const std::vector<double> kHertz{30, 60, 120, 240, 960};
const std::vector<double> kDensityRatios{1e-3, 1e-2, 0.1, 1, 10, 100, 1e3, 1e4};
const std::vector<double> kSpeeds{0, 0.1, 1, 10, 100, 340};
const std::vector<double> kSpins{0, 1, 10, 100, 1000, 5000};

AtlasRow wideRow(const char* name, const char* what) {
  AtlasRow row;
  row.name = name;
  row.what = what;
  row.hertz = kHertz;
  row.density_ratios = kDensityRatios;
  row.speeds = kSpeeds;
  row.spins = kSpins;
  return row;
}

std::vector<AtlasRow> makeRows() {
  AtlasRow wide = wideRow("wide", "wide ranges of everything");
  AtlasRow published = wideRow("published", "the same by the published law");
  published.law = PressureLaw::kPublished;
  AtlasRow slow = wideRow("slow", "the same in steps of 1/15 s");
  slow.hertz = {15};
  AtlasRow density = wideRow("density", "1e-6, 1e-5, 1e5 and 1e6 times as dense as the fluid");
  density.density_ratios = {1e-6, 1e-5, 1e5, 1e6};
  AtlasRow needle = wideRow("needle", "ellipsoids 1000 times as long as thick");
  needle.is_needle = true;
  AtlasRow stack = wideRow("stack", "two boxes, the upper one of 1000 or 1/1000 of the mass");
  stack.load_ratios = {1e3, 1e-3};
  stack.settings = {AtlasSetting::kOnPlane};
  stack.speeds = {0, 0.1, 1};
  stack.spins = {0, 0.1, 1};
  return {wide, published, slow, density, needle, stack};
}

}  // namespace

const std::vector<AtlasRow>& atlasRows() {
  static const std::vector<AtlasRow> rows = makeRows();
  return rows;
}

AtlasCase AtlasCaseGenerator::next() {
  AtlasCase c;
  // Number of shapes before the needle, the last one.
  const std::size_t others = shapes_.size() - 1;
  const std::size_t shape = engine_() % others;
  c.shape = &shapes_[row_.is_needle ? others : shape];
  c.setting = static_cast<AtlasSetting>(engine_() % kAtlasSettings);
  if (!row_.settings.empty()) c.setting = any(row_.settings);
  c.law = row_.law;
  c.water = engine_() % 2 == 1;
  c.density_ratio = any(row_.density_ratios);
  c.size = any(std::vector<double>{1e-3, 1e-2, 0.1, 1, 10, 100});
  c.speed = any(row_.speeds);
  c.spin = any(row_.spins);
  c.step = 1 / any(row_.hertz);
  c.seed = static_cast<unsigned>(engine_());
  if (row_.load_ratios.size() > 1) c.load_ratio = any(row_.load_ratios);
  return c;
}

}  // namespace ambient
