// Whatever numbers a run gives, a chart of them has few ticks, and everything on it has a place.
#include <cairo/cairo.h>

#include <array>
#include <cmath>
#include <cstring>
#include <limits>

#include "render/charts/axes.h"
#include "render/charts/chart.h"
#include "tests/fuzz/targets.h"

namespace fuzz {
namespace {

/// Values out of bytes, as long as there are any; then zeros.
class Feed {
 public:
  explicit Feed(std::string_view bytes) : left_(bytes) {}

  unsigned byte() {
    if (left_.empty()) return 0;
    const auto out = static_cast<unsigned char>(left_.front());
    left_.remove_prefix(1);
    return out;
  }
  /// One of those that break arithmetic, one close beside the last, or the next eight bytes as they are.
  double number() {
    using Limits = std::numeric_limits<double>;
    constexpr double kOdd[] = {0,
                               -0.0,
                               1,
                               -1,
                               0.1,
                               1e5,
                               Limits::infinity(),
                               -Limits::infinity(),
                               Limits::quiet_NaN(),
                               Limits::max(),
                               -Limits::max(),
                               Limits::min(),
                               Limits::denorm_min(),
                               1e100,
                               1e-100,
                               9.999999e22};
    const unsigned what = byte();
    if (what < std::size(kOdd)) return last_ = kOdd[what];
    if (what == std::size(kOdd)) return last_ = std::nextafter(last_, Limits::infinity());
    if (what < 128) return last_ = 0.25 * (static_cast<double>(what) - 70);
    std::array<char, sizeof(double)> raw{};
    for (char& c : raw) c = static_cast<char>(byte());
    std::memcpy(&last_, raw.data(), sizeof last_);
    return last_;
  }
  std::string text() {
    std::string out(left_.substr(0, byte() % 12));
    left_.remove_prefix(std::min(left_.size(), out.size()));
    return out;
  }

 private:
  std::string_view left_;
  double last_ = 1;
};

render::charts::Chart chart_of(Feed& feed) {
  render::charts::Chart out;
  const unsigned kind = feed.byte(), points = feed.byte() % 8;
  out.log_x = kind & 1;
  out.log_y = kind & 2;
  out.title = "t" + feed.text();
  out.y_label = feed.text();
  for (unsigned i = (kind >> 2) % 3; i > 0; --i) {
    render::charts::Line line{kind & 128 ? feed.text() : "", {}, (kind & 16) == 0, false, 1};
    for (unsigned k = 0; k < points; ++k) line.points.push_back({feed.number(), feed.number(), feed.number(), feed.number()});
    out.lines.push_back(line);
  }
  if (kind & 32) {
    render::charts::Band band;
    for (unsigned k = 0; k < points; ++k) band.points.push_back({feed.number(), 0, feed.number(), feed.number()});
    out.bands.push_back(band);
    out.levels.push_back({0, feed.number(), feed.text()});
  }
  if (kind & 64) {
    out.marks.push_back({feed.number(), feed.number(), feed.text()});
    out.top.push_back({feed.number(), 0, feed.text()});
    if (kind & 16) out.names = {"one", feed.text()};
  }
  return out;
}

/// The axis a chart lays through all of these numbers, its ticks and the places of the numbers.
void check_axis(const std::vector<double>& numbers, bool logarithmic) {
  using render::charts::Axis;
  Axis axis;
  axis.log = logarithmic;
  for (const double n : numbers) axis.take(n);
  if (axis.empty()) return;
  axis.widen();
  axis.to = 200;
  demand(std::isfinite(axis.low) && axis.high > axis.low, "an axis has a span");
  const std::vector<double> at = render::charts::ticks(axis.low, axis.high, 6, logarithmic);
  demand(!at.empty() && at.size() <= 24, "an axis has some ticks and not many");
  for (const double tick : at) {
    demand(std::isfinite(axis.at(tick)), "a tick has a place");
    demand(!render::charts::tick_text(tick, at.size() > 1 ? at[1] - at[0] : 0).empty(), "a tick has a text");
  }
  for (const double n : numbers) demand(!Axis::shows(n) || std::isfinite(axis.at(n)), "what is shown has a place");
}

/// A tiny picture that is drawn on again and again.
class Paper {
 public:
  Paper() : surface_(cairo_image_surface_create(CAIRO_FORMAT_A8, 160, 120)), cairo_(cairo_create(surface_)) {}
  ~Paper() {
    cairo_destroy(cairo_);
    cairo_surface_destroy(surface_);
  }
  Paper(const Paper&) = delete;
  cairo_t* cairo() const { return cairo_; }

 private:
  cairo_surface_t* surface_;
  cairo_t* cairo_;
};

}  // namespace

void chart(std::string_view bytes) {
  Feed feed(bytes);
  const render::charts::Chart drawn = chart_of(feed);
  std::vector<double> x, y;
  for (const auto& line : drawn.lines)
    for (const auto& p : line.points) {
      x.push_back(p.x);
      y.insert(y.end(), {p.y, p.low, p.high});
    }
  for (const bool logarithmic : {false, true}) {
    check_axis(x, logarithmic);
    check_axis(y, logarithmic);
  }
  // spans no chart has asked for
  const double low = feed.number(), high = feed.number();
  for (const bool logarithmic : {false, true})
    for (const double tick : render::charts::ticks(low, high, static_cast<int>(feed.byte() % 12), logarithmic))
      demand(std::isfinite(tick), "a tick is a number");
  demand(!render::charts::tick_text(low, high).empty(), "a number has a text");
  static const Paper paper;
  cairo_save(paper.cairo());
  draw_chart(render::charts::Pen(paper.cairo()), drawn, {2, 2, 156, 116});
  cairo_restore(paper.cairo());
  demand(cairo_status(paper.cairo()) == CAIRO_STATUS_SUCCESS, "a chart can be drawn");
}

}  // namespace fuzz
