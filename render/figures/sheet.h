// A4 paper for a vector drawing, in millimetres, written as PDF and SVG from the same strokes.
#pragma once

#include <cairo/cairo.h>

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "render/stage.h"

namespace render {

constexpr double kSheetWidth = 297, kSheetHeight = 210;  // [mm] A4, landscape
constexpr double kMargin = 12;                           // [mm]

/// Draws on both; unit millimetre, origin top left. Written as a part, renamed when whole. Returns the files.
std::vector<std::string> write_sheets(const std::filesystem::path& folder, const std::string& name, const std::string& title,
                                      const std::function<void(cairo_t*)>& draw);

/// Title above, "simulation, not measured" and provenance at the foot.
void draw_frame_of_sheet(cairo_t*, const Stage&, const std::string& title);
/// [mm] of the scene's title beneath it, which is written smaller where the sheet is too narrow.
double width_of_title(cairo_t*, const Stage&);

enum class Align { left, centre, right };
/// `size` [mm]; the point is the base line's left, middle or right end.
void draw_text(cairo_t*, double x, double y, const std::string&, double size, Align = Align::left);
double text_width(cairo_t*, const std::string&, double size);
/// The text if it is no wider than that [mm], else with an ellipsis in place of its middle: names may differ at either end.
std::string shortened(cairo_t*, const std::string&, double size, double width);
void draw_line(cairo_t*, double x0, double y0, double x1, double y1);
void grey(cairo_t*, double lightness);
/// One of six marks that differ in shape: disc, square, triangle, diamond, cross, ring.
void draw_mark(cairo_t*, int shape, double x, double y, double size);
/// One of six line styles: full, dashed, dotted, dash-dotted ...
constexpr int kLineStyles = 6;
void set_dashes(cairo_t*, int style);

/// A part of the body by its name, for marks and legends: 0 head, 1 trunk, 2 arm, 3 thigh, 4 lower leg, 5 other.
int part_of(const std::string& body_name);
const char* name_of_part(int part);

}  // namespace render
