// A page's table stays within its place, whatever stands in it; ticks are few, whatever numbers they stand between.
#include <cairo/cairo.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

#include "render/charts/axes.h"
#include "render/charts/chart.h"

namespace render::charts {
namespace {

constexpr Box kPlace{100, 50, 390, 160};  // [pt] the lower right of a page beside bars

/// Where the ink of what is drawn lies.
template <typename Draw>
Box ink_of_drawing(const Draw& draw) {
  cairo_surface_t* surface = cairo_recording_surface_create(CAIRO_CONTENT_COLOR_ALPHA, nullptr);
  cairo_t* c = cairo_create(surface);
  draw(Pen(c));
  Box out;
  cairo_recording_surface_ink_extents(surface, &out.x, &out.y, &out.width, &out.height);
  cairo_destroy(c);
  cairo_surface_destroy(surface);
  return out;
}

Box ink_of(const Table& table) {
  return ink_of_drawing([&table](const Pen& pen) { draw_table(pen, table, kPlace); });
}

Table table_of(const std::string& name, const std::string& value, int rows) {
  Table table{"Percentiles", {"measure", "5 %", "50 %", "95 %"}, {}, -1, ""};
  for (int r = 0; r < rows; ++r) table.rows.push_back({name, value, value, value});
  return table;
}

TEST(Table, WiderThanItsPlaceIsWrittenSmaller) {
  const Box ink = ink_of(table_of("head impact vehicle x [m]", "-1234.567 (-1234.568..-1234.566)", 5));
  EXPECT_LE(ink.right(), kPlace.right() + 1);  // a point for the thickness of lines and the edges of letters
  EXPECT_GE(ink.right(), kPlace.right() - 4) << "and fills it";
}

TEST(Table, KeepsItsSizeForRowsThatAreShown) {
  Table table = table_of("throw distance [m]", "12.8", 5);
  const Box before = ink_of(table);
  // rows below the last that has a place say nothing of the columns
  while (table.rows.size() < 40) table.rows.push_back(table.rows.front());
  const Box full = ink_of(table);
  table.rows.push_back(
      {"a name as long as no measure of the library has one, and longer than the place is wide by far, too", "1", "2", "3"});
  const Box after = ink_of(table);
  EXPECT_EQ(after.right(), full.right());
  EXPECT_EQ(after.bottom(), full.bottom());
  EXPECT_GT(full.bottom(), before.bottom());
  EXPECT_LE(full.bottom(), kPlace.bottom() + 1);
}

TEST(Chart, TheKeyOfNamedTicksStaysInItsPlace) {
  const Box place{100, 50, 178, 126};  // [pt] one of four charts side by side in two rows
  Chart chart;
  chart.title = "Residuals of the evidence";
  chart.y_label = "run less evidence, in tolerances: 95 % range";
  chart.lines.push_back({"", {}, false, true});
  for (int i = 1; i <= 7; ++i) {
    chart.names.push_back("rest place of the second car");
    chart.lines.front().points.push_back({static_cast<double>(i), 0, -2, 2});
    const Box ink = ink_of_drawing([&](const Pen& pen) { draw_chart(pen, chart, place); });
    EXPECT_GE(ink.x, place.x - 1) << i;
    EXPECT_LE(ink.right(), place.right() + 1) << i;
    EXPECT_LE(ink.bottom(), place.bottom() + 1) << i;
  }
}

TEST(Ticks, AreFewAndFiniteBetweenWhateverNumbers) {
  using Limits = std::numeric_limits<double>;
  EXPECT_EQ(ticks(0, 10, 5, false), (std::vector<double>{0, 2, 4, 6, 8, 10}));
  EXPECT_EQ(ticks(1e300, std::nextafter(1e300, Limits::infinity()), 6, false), std::vector<double>{1e300}) << "none lies between";
  EXPECT_EQ(ticks(-Limits::max(), Limits::max(), 1, false).size(), 1U);
  EXPECT_EQ(ticks(0, Limits::denorm_min(), 6, false).size(), 1U);
  EXPECT_TRUE(ticks(0, Limits::infinity(), 6, false).empty());
  EXPECT_TRUE(ticks(Limits::quiet_NaN(), 1, 6, true).empty());
  const std::vector<double> all = ticks(Limits::denorm_min(), Limits::max(), 6, true);
  EXPECT_LE(all.size(), 8U);
  for (const double tick : all) EXPECT_TRUE(std::isfinite(tick));
}

TEST(Ticks, AreWrittenWithTheirPowerOfTen) {
  EXPECT_EQ(tick_text(2e-6), "2\u00b710\u207b\u2076");
  EXPECT_EQ(tick_text(-1e5), "-10\u2075");
  EXPECT_EQ(tick_text(9.9999e5), "10\u2076") << "not ten times ten to the fifth";
  EXPECT_EQ(tick_text(5e-324), "4.94\u00b710\u207b\u00b3\u00b2\u2074");
  EXPECT_EQ(tick_text(0.5, 0.1), "0.5");
  EXPECT_EQ(tick_text(1, 5e-324), "1");
  EXPECT_EQ(tick_text(std::numeric_limits<double>::infinity()), "inf");
}

TEST(Page, ChartsHaveTheRoomThatLittleBelowLeaves) {
  Page page;
  EXPECT_EQ(height_below_charts(page, 400), 0);
  page.table = table_of("rest", "1", 2);
  const double two = height_below_charts(page, 400);
  EXPECT_LT(two, 100);  // two rows and their head are less than a quarter
  for (const int more : {3, 4, 5}) {
    page.table = table_of("rest", "1", more);
    EXPECT_GT(height_below_charts(page, 400), two);
  }
  page.table = table_of("rest", "1", 60);
  EXPECT_DOUBLE_EQ(height_below_charts(page, 400), 160);
  page.table = {};
  page.bars.rows.resize(3);
  EXPECT_NEAR(height_below_charts(page, 400), 105, 1e-9);
}

}  // namespace
}  // namespace render::charts
