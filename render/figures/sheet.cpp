#include "render/figures/sheet.h"

#include <cairo/cairo-pdf.h>
#include <cairo/cairo-svg.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "render/error.h"
#include "render/paper_file.h"
#include "render/text/fonts.h"

namespace render {
namespace {

constexpr double kPoint = 72 / 25.4;  // points a millimetre

template <class Make>
void write_one(const Make& make, const std::filesystem::path& file, const std::function<void(cairo_t*)>& draw) {
  PartFile part(file);
  PaperFile paper(part);
  cairo_surface_t* surface = make(PaperFile::write, &paper, kSheetWidth * kPoint, kSheetHeight * kPoint);
  cairo_t* c = cairo_create(surface);
  cairo_scale(c, kPoint, kPoint);
  cairo_select_font_face(c, "DejaVu Sans", CAIRO_FONT_SLANT_NORMAL, CAIRO_FONT_WEIGHT_NORMAL);
  cairo_set_line_join(c, CAIRO_LINE_JOIN_ROUND);
  draw(c);
  cairo_show_page(c);
  cairo_destroy(c);
  cairo_surface_finish(surface);
  const cairo_status_t drawn = cairo_surface_status(surface), written = paper.close();
  const cairo_status_t status = drawn != CAIRO_STATUS_SUCCESS ? drawn : written;
  cairo_surface_destroy(surface);
  if (status != CAIRO_STATUS_SUCCESS) throw RenderError("cannot write " + file.string() + ": " + cairo_status_to_string(status));
  part.publish();
}

}  // namespace

std::vector<std::string> write_sheets(const std::filesystem::path& folder, const std::string& name, const std::string& title,
                                      const std::function<void(cairo_t*)>& draw) {
  require_font();
  const std::filesystem::path pdf = folder / (name + ".pdf"), svg = folder / (name + ".svg");
  const auto titled = [&title](cairo_write_func_t write, void* file, double width, double height) {
    cairo_surface_t* paper = cairo_pdf_surface_create_for_stream(write, file, width, height);
    cairo_pdf_surface_set_metadata(paper, CAIRO_PDF_METADATA_CREATE_DATE, nullptr);  // equal figures, equal files
    cairo_pdf_surface_set_metadata(paper, CAIRO_PDF_METADATA_TITLE, title.c_str());
    return paper;
  };
  write_one(titled, pdf, draw);
  write_one(cairo_svg_surface_create_for_stream, svg, draw);
  return {pdf.string(), svg.string()};
}

namespace {

constexpr double kWritable = kSheetWidth - 2 * kMargin, kTitle = 3.6;  // [mm]

}  // namespace

double width_of_title(cairo_t* c, const Stage& stage) {
  return std::min(text_width(c, stage.title, kTitle), kWritable);
}

void draw_frame_of_sheet(cairo_t* c, const Stage& stage, const std::string& title) {
  cairo_set_source_rgb(c, 1, 1, 1);
  cairo_paint(c);
  grey(c, 0);
  draw_text(c, kMargin, kMargin + 3, title, 5);
  grey(c, 0.3);
  const double width = text_width(c, stage.title, kTitle);
  draw_text(c, kMargin, kMargin + 9, stage.title, width > kWritable ? kTitle * kWritable / width : kTitle);
  draw_text(c, kMargin, kSheetHeight - 7, "Simulation, not measured at the scene", 2.8);
  draw_text(c, kSheetWidth - kMargin, kSheetHeight - 7, stage.provenance, 2.8, Align::right);
  double y = kSheetHeight - 7;  // between the two, from the foot up
  for (const std::string& warning : stage.warnings) {
    grey(c, 0);
    draw_text(c, kSheetWidth / 2, y, "Warning: " + warning, 3.2, Align::centre);
    y -= 5;
  }
}

double text_width(cairo_t* c, const std::string& text, double size) {
  cairo_set_font_size(c, size);
  cairo_text_extents_t extents;
  cairo_text_extents(c, text.c_str(), &extents);
  return extents.x_advance;
}

void draw_text(cairo_t* c, double x, double y, const std::string& text, double size, Align align) {
  const double width = text_width(c, text, size);
  cairo_move_to(c, x - (align == Align::left ? 0 : align == Align::centre ? width / 2 : width), y);
  cairo_show_text(c, text.c_str());
  cairo_new_path(c);
}

std::string shortened(cairo_t* c, const std::string& text, double size, double width) {
  if (text_width(c, text, size) <= width) return text;
  std::vector<std::size_t> begins;  // of the letters, in UTF-8
  for (std::size_t i = 0; i < text.size(); ++i)
    if ((static_cast<unsigned char>(text[i]) & 0xC0) != 0x80) begins.push_back(i);
  std::string out = "\u2026";
  for (std::size_t kept = begins.size() - 1; kept > 1; --kept) {
    const std::size_t head = begins[(kept + 1) / 2], tail = begins[begins.size() - kept / 2];
    out = text.substr(0, head) + "\u2026" + text.substr(tail);
    if (text_width(c, out, size) <= width) break;
  }
  return out;
}

void draw_line(cairo_t* c, double x0, double y0, double x1, double y1) {
  cairo_move_to(c, x0, y0);
  cairo_line_to(c, x1, y1);
  cairo_stroke(c);
}

void grey(cairo_t* c, double lightness) {
  cairo_set_source_rgb(c, lightness, lightness, lightness);
}

void draw_mark(cairo_t* c, int shape, double x, double y, double s) {
  cairo_set_line_width(c, 0.35);
  switch (shape) {
    case 0:
      cairo_arc(c, x, y, s, 0, 2 * M_PI);
      break;
    case 1:
      cairo_rectangle(c, x - 0.9 * s, y - 0.9 * s, 1.8 * s, 1.8 * s);
      break;
    case 2:
      cairo_move_to(c, x, y - 1.15 * s);
      cairo_line_to(c, x + s, y + 0.75 * s);
      cairo_line_to(c, x - s, y + 0.75 * s);
      cairo_close_path(c);
      break;
    case 3:
      cairo_move_to(c, x, y - 1.25 * s);
      cairo_line_to(c, x + 1.25 * s, y);
      cairo_line_to(c, x, y + 1.25 * s);
      cairo_line_to(c, x - 1.25 * s, y);
      cairo_close_path(c);
      break;
    case 4:
      cairo_rectangle(c, x - 1.2 * s, y - 0.4 * s, 2.4 * s, 0.8 * s);
      break;
    default:
      cairo_rectangle(c, x - 0.4 * s, y - 1.2 * s, 0.8 * s, 2.4 * s);
  }
  cairo_fill_preserve(c);
  grey(c, 0);
  cairo_stroke(c);
}

void set_dashes(cairo_t* c, int style) {
  static const std::array<std::vector<double>, kLineStyles> kStyles{
      {{}, {3, 1.4}, {0.8, 1.0}, {4, 1.2, 0.8, 1.2}, {1.8, 0.8}, {5, 1, 0.8, 1, 0.8, 1}}};
  const std::vector<double>& dashes = kStyles[static_cast<std::size_t>(style) % kStyles.size()];
  cairo_set_dash(c, dashes.data(), static_cast<int>(dashes.size()), 0);
}

int part_of(const std::string& name) {
  auto has = [&](const char* part) { return name.find(part) != std::string::npos; };
  if (has("head") || has("neck")) return 0;
  if (has("torso") || has("hips") || has("waist")) return 1;
  if (has("arm") || has("hand")) return 2;
  if (has("thigh") || has("femur")) return 3;
  if (has("calf") || has("foot") || has("knee") || has("leg")) return 4;
  return 5;
}

const char* name_of_part(int part) {
  constexpr std::array kNames{"head, neck", "trunk", "arms", "thighs", "lower legs, feet", "other"};
  return kNames[static_cast<std::size_t>(part)];
}

}  // namespace render
