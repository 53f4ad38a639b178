#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <string>

#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/force/medium/waves.h"
#include "tests/support/refusal_of.h"

namespace ambient::test {
namespace {

WaveSpectrum northSea(double enhancement, int components) {
  WaveSpectrum spectrum;
  spectrum.significant_height = 2.4;
  spectrum.peak_period = 8;
  spectrum.peak_enhancement = enhancement;
  spectrum.components = components;
  return spectrum;
}

double frequencyOf(const WaveComponent& wave) { return 2 * kPi / wave.period; }

TEST(WaveSpectrum, HasTheEnergyOfItsSignificantHeight) {
  for (const double gamma : {1.0, 3.3, 7.0}) {
    double variance = 0;
    for (const WaveComponent& wave : wavesOf(northSea(gamma, 37)))
      variance += wave.amplitude * wave.amplitude / 2;
    EXPECT_NEAR(variance, 2.4 * 2.4 / 16, 1e-13);
  }
}

TEST(WaveSpectrum, OfAFullyDevelopedSeaHasItsClosedForm) {
  // Pierson and Moskowitz: the energy below omega is exp(-5/4 (omega_p / omega)^4) of the total.
  const auto waves = wavesOf(northSea(1, 40));
  for (std::size_t i = 0; i < waves.size(); ++i) {
    const double ratio = 8 / waves[i].period;
    EXPECT_NEAR(std::exp(-1.25 * std::pow(ratio, -4)), (static_cast<double>(i) + 0.5) / 40, 1e-12);
  }
  // Mean frequency of the spectrum: (5/4)^(1/4) Gamma(3/4) omega_p.
  const auto many = wavesOf(northSea(1, 20000));
  const double mean = std::accumulate(
      many.begin(), many.end(), 0.0,
      [](double sum, const WaveComponent& wave) { return sum + frequencyOf(wave) / 20000; });
  EXPECT_NEAR(mean, std::pow(1.25, 0.25) * std::tgamma(0.75) * 2 * kPi / 8, 2e-4);
}

// S(omega) of Hasselmann et al. (1973) up to a factor, with omega in omega_p.
double jonswap(double ratio, double gamma) {
  const double sigma = ratio <= 1 ? 0.07 : 0.09;
  const double peak = std::exp(-std::pow((ratio - 1) / sigma, 2) / 2);
  return std::pow(ratio, -5) * std::exp(-1.25 * std::pow(ratio, -4)) * std::pow(gamma, peak);
}

double energyBetween(double from, double to, double gamma) {
  constexpr int kSteps = 100000;
  const double step = (to - from) / kSteps;
  double sum = 0;
  for (int i = 0; i < kSteps; ++i) sum += step * jonswap(from + (i + 0.5) * step, gamma);
  return sum;
}

TEST(WaveSpectrum, DividesTheEnergyIntoEqualParts) {
  constexpr double kLow = 0.2, kHigh = 40;  // leaves out 1e-20 and 1e-7 of the energy
  for (const double gamma : {2.0, 3.3, 7.0}) {
    const double all = energyBetween(kLow, kHigh, gamma);
    const auto waves = wavesOf(northSea(gamma, 25));
    for (std::size_t i = 0; i < waves.size(); ++i)
      EXPECT_NEAR(energyBetween(kLow, 8 / waves[i].period, gamma) / all,
                  (static_cast<double>(i) + 0.5) / 25, 1e-5);
  }
}

TEST(WaveSpectrum, IsDensestAtItsPeak) {
  const auto waves = wavesOf(northSea(3.3, 1000));
  std::vector<double> gaps;
  for (std::size_t i = 0; i + 1 < waves.size(); ++i)
    gaps.push_back(frequencyOf(waves[i + 1]) - frequencyOf(waves[i]));
  const auto narrowest =
      static_cast<std::size_t>(std::min_element(gaps.begin(), gaps.end()) - gaps.begin());
  EXPECT_NEAR(waves[narrowest].period, 8, 0.05);
}

TEST(WaveSpectrum, MakesASeaOfItsSignificantHeight) {
  const AiryWaves sea({}, wavesOf(northSea(3.3, 50)));
  double sum = 0, squares = 0;
  constexpr int kSamples = 40000;
  for (int i = 0; i < kSamples; ++i) {
    const double height = sea.sample({0, 0, 0}, 0.73 * i).height;
    sum += height / kSamples;
    squares += height * height / kSamples;
  }
  EXPECT_NEAR(sum, 0, 0.01);
  EXPECT_NEAR(4 * std::sqrt(squares), 2.4, 0.02);
}

TEST(WaveSpectrum, HasThePhasesOfItsSeed) {
  WaveSpectrum spectrum = northSea(3.3, 8);
  const auto first = wavesOf(spectrum), again = wavesOf(spectrum);
  spectrum.seed = 2;
  const auto other = wavesOf(spectrum);
  for (std::size_t i = 0; i < first.size(); ++i) {
    EXPECT_EQ(first[i].phase, again[i].phase);
    EXPECT_NE(first[i].phase, other[i].phase);
    EXPECT_EQ(first[i].period, other[i].period);
    EXPECT_GE(first[i].phase, 0);
    EXPECT_LT(first[i].phase, 2 * kPi);
  }
}

std::string complaintAbout(const WaveSpectrum& spectrum) {
  return test::refusalOf<std::invalid_argument>([&] { wavesOf(spectrum); });
}

TEST(WaveSpectrum, RefusesWhatIsNoSea) {
  WaveSpectrum spectrum = northSea(3.3, 0);
  EXPECT_EQ(complaintAbout(spectrum),
            "spectrum of waves: number of components is 0; must be between 1 and 100000");
  spectrum = northSea(0.5, 10);
  EXPECT_EQ(complaintAbout(spectrum),
            "spectrum of waves: peak enhancement is 0.5; must be at least 1 and finite");
  spectrum = northSea(3.3, 10);
  spectrum.peak_period = 0;
  EXPECT_EQ(complaintAbout(spectrum),
            "spectrum of waves: peak period [s] is 0; must be positive and finite");
  spectrum = northSea(3.3, 10);
  spectrum.significant_height = HUGE_VAL;
  EXPECT_EQ(
      complaintAbout(spectrum),
      "spectrum of waves: significant height [m] is inf; must be zero or positive and finite");
}

}  // namespace
}  // namespace ambient::test
