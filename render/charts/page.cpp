// The page's layout, and its three files from one drawing.
#include "render/charts/page.h"

#include <cairo/cairo-pdf.h>
#include <cairo/cairo-svg.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <system_error>

#include "render/charts/chart.h"
#include "render/error.h"
#include "render/paper_file.h"

namespace render::charts {
namespace {

constexpr double kWidth = 841.89, kHeight = 595.28;  // [pt] A4, landscape
constexpr double kMargin = 34;
constexpr double kDotsPerPoint = 200.0 / 72;  // of the PNG

struct SurfaceDeleter {
  void operator()(cairo_surface_t* s) const { cairo_surface_destroy(s); }
};
struct CairoDeleter {
  void operator()(cairo_t* c) const { cairo_destroy(c); }
};
using SurfacePtr = std::unique_ptr<cairo_surface_t, SurfaceDeleter>;
using CairoPtr = std::unique_ptr<cairo_t, CairoDeleter>;

/// Charts side by side, as wide as each other.
void draw_grid(const Pen& pen, const std::vector<Chart>& grid, const Box& box) {
  constexpr double kGap = 20;
  const std::size_t rows = (grid.size() + 3) / 4, columns = (grid.size() + rows - 1) / rows;
  const double width = (box.width - kGap * static_cast<double>(columns - 1)) / static_cast<double>(columns);
  const double height = (box.height - 0.4 * kGap * static_cast<double>(rows - 1)) / static_cast<double>(rows);
  for (std::size_t i = 0; i < grid.size(); ++i) {
    const std::size_t row = i / columns, column = i % columns;
    draw_chart(pen, grid[i],
               {box.x + static_cast<double>(column) * (width + kGap), box.y + static_cast<double>(row) * (height + 0.4 * kGap),
                width, height});
  }
}

}  // namespace

double height_below_charts(const Page& page, double room) {
  constexpr double kHead = 60, kBar = 15, kRow = 11.2, kNote = 30;  // [pt] titles of two lines and heads of columns
  const double bars = page.bars.rows.empty() ? 0 : kHead + kBar * static_cast<double>(page.bars.rows.size());
  const double table = page.table.rows.empty() ? 0 : kHead + kRow * static_cast<double>(page.table.rows.size());
  return std::min(0.4 * room, std::max(bars, table + (page.table.note.empty() ? 0 : kNote)));
}

namespace {

void draw(const Page& page, cairo_t* c) {
  const Pen pen(c);
  cairo_set_source_rgb(c, 1, 1, 1);
  cairo_paint(c);
  pen.black();
  const double width = kWidth - 2 * kMargin;
  double y = kMargin - 6;
  y += pen.text(page.title, kMargin, y, 14, Align::left, true, width).height + 2;
  y += pen.text(page.subtitle, kMargin, y, 8.5, Align::left, false, width).height + 5;
  for (const std::string& finding : page.findings)
    y += pen.text("\u2022 " + finding, kMargin, y, 8.5, Align::left, false, width).height + 1.5;
  y += 7;
  const double bottom = kHeight - kMargin - 6;
  const bool charts = !page.left.title.empty() || !page.grid.empty();
  const double gap = 26, half = (width - gap) / 2;
  const double rows = 15.0 * static_cast<double>(std::max(page.upper_left.rows.size(), page.upper_right.rows.size()));
  const double split = y + (charts     ? bottom - y - height_below_charts(page, bottom - y)
                            : rows > 0 ? std::min(0.5 * (bottom - y), rows + 48)
                                       : 0);
  const Box left{kMargin, y, half, split - y - 8}, right{kMargin + half + gap, y, half, split - y - 8};
  draw_chart(pen, page.left, left);
  draw_chart(pen, page.right, right);
  if (!page.grid.empty()) draw_grid(pen, page.grid, {kMargin, y, width, split - y - 8});
  if (!charts) {
    draw_bars(pen, page.upper_left, left);
    draw_bars(pen, page.upper_right, right);
  }
  const double bars = page.bars.rows.empty() ? 0 : 0.46 * width + gap;
  draw_bars(pen, page.bars, {kMargin, split + 4, bars - gap, bottom - split - 8});
  draw_table(pen, page.table, {kMargin + bars, split + 4, width - bars, bottom - split - 8});
  pen.black(0.5);
  pen.line(kMargin, bottom + 4, kWidth - kMargin, bottom + 4, 0.5);
  pen.black();
  pen.text(page.footer, kMargin, bottom + 8, 6.5, Align::left, false, width);
}

void check(cairo_status_t status, const std::filesystem::path& file) {
  if (status != CAIRO_STATUS_SUCCESS)
    throw RenderError(fmt::format("writing the figure {}: {}", file.string(), cairo_status_to_string(status)));
}

/// Draws into a part of the file and gives it its name when it is whole.
template <typename Make, typename Finish>
std::string write(const Page& page, const std::filesystem::path& file, double scale, const Make& make, const Finish& finish) {
  PartFile part(file);
  PaperFile paper(part);
  {
    const SurfacePtr surface(make(&paper));
    check(cairo_surface_status(surface.get()), file);
    const CairoPtr cairo(cairo_create(surface.get()));
    cairo_scale(cairo.get(), scale, scale);
    draw(page, cairo.get());
    check(cairo_status(cairo.get()), file);
    check(finish(surface.get(), &paper), file);
  }
  check(paper.close(), file);
  part.publish();
  return file.string();
}

cairo_status_t finished(cairo_surface_t* surface, PaperFile*) {
  cairo_surface_finish(surface);
  return cairo_surface_status(surface);
}

}  // namespace

std::vector<std::string> write_page(const Page& page, const std::filesystem::path& base) {
  const auto pdf = [&page](PaperFile* file) {
    cairo_surface_t* surface = cairo_pdf_surface_create_for_stream(PaperFile::write, file, kWidth, kHeight);
    cairo_pdf_surface_set_metadata(surface, CAIRO_PDF_METADATA_CREATE_DATE, nullptr);  // equal figures, equal files
    cairo_pdf_surface_set_metadata(surface, CAIRO_PDF_METADATA_TITLE, page.title.c_str());
    cairo_pdf_surface_set_metadata(surface, CAIRO_PDF_METADATA_SUBJECT, page.footer.c_str());
    return surface;
  };
  const auto svg = [](PaperFile* file) { return cairo_svg_surface_create_for_stream(PaperFile::write, file, kWidth, kHeight); };
  const auto png = [](PaperFile*) {
    return cairo_image_surface_create(CAIRO_FORMAT_RGB24, static_cast<int>(std::lround(kWidth * kDotsPerPoint)),
                                      static_cast<int>(std::lround(kHeight * kDotsPerPoint)));
  };
  const auto save = [](cairo_surface_t* surface, PaperFile* file) {
    return cairo_surface_write_to_png_stream(surface, PaperFile::write, file);
  };
  return {write(page, base.string() + ".pdf", 1, pdf, finished), write(page, base.string() + ".svg", 1, svg, finished),
          write(page, base.string() + ".png", kDotsPerPoint, png, save)};
}

}  // namespace render::charts
