// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numeric>
#include <set>
#include <string>

#include "orbitutte/export/palette.h"
#include "orbitutte/page/svg_chart.h"
#include "orbitutte/report/chart_numbers.h"
#include "orbitutte/report/charts.h"
#include "sample_embeddings.h"

namespace orbitutte::chart_test {
namespace {

using test::sample_embedding;
using ::testing::ElementsAre;

std::vector<std::string> texts_of(const std::vector<ChartTick>& ticks) {
  std::vector<std::string> texts;
  for (const ChartTick& tick : ticks) texts.push_back(tick.text);
  return texts;
}

TEST(ChartNumbers, StepsAreRound) {
  EXPECT_DOUBLE_EQ(round_step(0.27, 5), 0.1);
  EXPECT_DOUBLE_EQ(round_step(10, 5), 2);
  EXPECT_DOUBLE_EQ(round_step(11, 5), 5);
  EXPECT_DOUBLE_EQ(round_step(100, 5), 20);
}

TEST(ChartNumbers, OctavesAreFractionsOrPowersAndReachBothEnds) {
  EXPECT_THAT(texts_of(octave_ticks(3)), ElementsAre("1/8", "1/4", "1/2", "1", "2", "4", "8"));
  EXPECT_THAT(texts_of(octave_ticks(12)), ElementsAre("2⁻¹²", "2⁻⁸", "2⁻⁴", "2⁰", "2⁴", "2⁸", "2¹²"));
  for (const double range : {1, 2, 3, 4, 6, 9, 12, 15}) EXPECT_EQ(octave_ticks(range).back().at, range);
}

TEST(ChartNumbers, QuantilesOfNothingAreZero) {
  EXPECT_EQ(quantile({}, 0.5), 0);
  EXPECT_EQ(quantile({3, 1, 2}, 0.5), 2);
  EXPECT_EQ(quantile_of_magnitudes({-3, 1, 2}, 1), 3);
}

TEST(Charts, HistogramsCountEveryFaceOnAxesThatHoldAllMaps) {
  const std::vector<double> narrow = {-0.3, 0, 0.1, 0.4}, wide = {-30, -3, -1, 0, 1, 2, 3};
  for (const std::vector<double>& values : {narrow, wide}) {
    const std::vector<double> shares = shares_by_bin(values, 2);
    EXPECT_NEAR(std::accumulate(shares.begin(), shares.end(), 0.0), 1, 1e-12);
  }
  EXPECT_NEAR(shares_by_bin(wide, 2).front(), 2.0 / 7, 1e-12) << "what lies beyond is in the outermost bin";
  const HistogramAxes both = histogram_axes({narrow, wide}), swapped = histogram_axes({wide, narrow});
  for (const std::vector<double>& values : {narrow, wide}) {
    const HistogramAxes own = histogram_axes({values});
    EXPECT_GE(both.range, own.range);
    EXPECT_GE(both.colours, own.colours);
    for (const double share : shares_by_bin(values, both.range)) EXPECT_LE(share, both.highest);
  }
  EXPECT_EQ(both.range, swapped.range);
  EXPECT_EQ(both.highest, swapped.highest);
  EXPECT_EQ(both.lowest, -30);
  EXPECT_GT(histogram_axes({}).highest, 0);
}

TEST(Charts, HistogramsMarkMedianAndMeanAndSayWhereFacesLieBeyond) {
  const Chart chart = area_histogram({-30, -1, 0, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1,
                                      1,   1,  1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1});
  EXPECT_EQ(chart.lines.at(0).label, "median 2");
  EXPECT_EQ(chart.lines.at(0).points.at(0)[0], 1);
  EXPECT_EQ(chart.lines.at(1).label, fmt::format("geometric mean {:.3g}", std::exp2(6.0 / 40)));
  EXPECT_TRUE(chart.x.ticks.front().text.starts_with("≤ "));
  EXPECT_FALSE(chart.x.ticks.back().text.starts_with("≥ "));
}

TEST(Charts, ConvergenceLeavesOutWhatIsNotPositive) {
  const Chart chart = convergence_chart({{2, 1, 0}, {1.5, 0, 0}, {1, 1e-3, 0}});
  EXPECT_EQ(chart.lines.at(0).points.size(), 2U) << "the last energy has no excess";
  EXPECT_EQ(chart.lines.at(1).points.size(), 2U) << "a gradient of zero has no logarithm";
  EXPECT_EQ(chart.y.low, -3);
  EXPECT_EQ(chart.y.high, 0);
}

TEST(Charts, NothingToShowGivesAnEmptyChartAndNoSvg) {
  EXPECT_TRUE(area_histogram({}).is_empty());
  EXPECT_TRUE(convergence_chart({}).is_empty());
  EXPECT_TRUE(convergence_chart({{0, 0, 0}, {0, 0, 0}}).is_empty());
  EXPECT_TRUE(convergence_chart({{1, std::numeric_limits<double>::quiet_NaN(), 0}}).is_empty());
  EXPECT_EQ(svg_chart({}), Content(false));
  EXPECT_FALSE(convergence_chart({{1, 1e-3, 0}}).is_empty());
}

TEST(ColourScales, HoldNineTenthsOfTheFaces) {
  for (const std::string signature : {"432", "*532", "5*"}) {
    const test::SampleEmbedding& sample = sample_embedding(signature);
    const std::vector<FaceDistortion> faces =
        measure_triangles(test::unjudged(sample.mesh), sample.embedding());
    for (const Measure measure : {Measure::area, Measure::angle}) {
      const std::vector<double> values = values_of(measure, faces);
      const ColourScale scale = colour_scale(measure, values);
      double inside = 0;
      for (const double value : values) inside += std::abs(value) <= scale.axis.high ? 1 : 0;
      if (scale.axis.high < 6) EXPECT_GE(inside, 0.89 * static_cast<double>(faces.size())) << signature;
    }
  }
}

TEST(ColourScales, OfSeveralMapsIsThatOfTheWidest) {
  const std::vector<double> narrow = {0.1, -0.2}, wide = {3, -2.5};
  EXPECT_EQ(common_colour_scale(Measure::area, {narrow, wide}).axis.high,
            colour_scale(Measure::area, wide).axis.high);
  EXPECT_EQ(common_colour_scale(Measure::area, {wide, narrow}).axis.high,
            colour_scale(Measure::area, wide).axis.high);
}

TEST(Colours, MapsAreMonotoneInLightness) {
  double previous = 2;
  for (int k = 0; k <= 100; ++k) {
    const double t = k / 100.0;
    const double sequential = lightness(sequential_colour(t));
    EXPECT_LT(sequential, previous);
    previous = sequential;
    EXPECT_NEAR(lightness(diverging_colour(t)), lightness(diverging_colour(-t)), 0.01);
    if (k > 0) EXPECT_LT(lightness(diverging_colour(t)), lightness(diverging_colour(t - 0.01)));
  }
}

TEST(Colours, EncodingToSrgbAndBackIsExact) {
  for (int c = 0; c < 256; ++c) {
    const auto channel = static_cast<std::uint8_t>(c);
    EXPECT_EQ(srgb(linear({channel, 17, 255})), (Rgb{channel, 17, 255}));
  }
  EXPECT_EQ(hexadecimal({0, 92, 160}), "#005ca0");
}

TEST(Colours, TwelveMarksAreToldApartAndBearWhiteNumbers) {
  constexpr int count = 12;
  std::set<std::string> different;
  for (int c = 0; c < count; ++c) {
    const Colour colour = linear(cone_colour(c));
    different.insert(hexadecimal(cone_colour(c)));
    const double luminance = 0.2126 * colour[0] + 0.7152 * colour[1] + 0.0722 * colour[2];
    EXPECT_GT(1.05 / (luminance + 0.05), 3) << c;
    for (int d = 0; d < c; ++d) {
      const Rgb x = cone_colour(c), y = cone_colour(d);
      const double away = std::hypot(x.red - y.red, x.green - y.green, x.blue - y.blue);
      EXPECT_GT(away, 45) << c << " and " << d;
    }
  }
  EXPECT_EQ(different.size(), static_cast<std::size_t>(count));
}

TEST(Colours, LinesOfChartsStandOutFromTheirGround) {
  for (const ChartTone tone : {ChartTone::energy, ChartTone::gradient}) {
    EXPECT_LT(lightness(linear(tone_colour(tone))), 0.65) << "on white";
    EXPECT_GT(lightness(linear(on_dark(tone_colour(tone)))), 0.7) << "on a dark ground";
  }
}

}  // namespace
}  // namespace orbitutte::chart_test
