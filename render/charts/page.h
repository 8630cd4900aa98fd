// Figures for print: a page of charts as plain data, drawn by one code path to PDF, SVG and PNG. Told apart by marker, dash and
// hatching first and by colour second, so that a black-and-white copy says the same.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace render::charts {

struct Point {
  double x = 0, y = 0;
  double low = 0, high = 0;  // ends of an upright bar; equal: none
};

struct Line {
  std::string label;
  std::vector<Point> points;
  bool joined = true;  // a line through the points
  bool emphasised = false;
  double marker = 1;  // size of the points, 0: none; a cloud of a thousand wants small ones
};

/// Shaded between low and high.
struct Band {
  std::string label;
  std::vector<Point> points;  // x, low, high
};

struct Mark {
  double x = 0, y = 0;
  std::string text;
};

struct Chart {
  std::string title, x_label, y_label;
  bool log_x = false, log_y = false;
  std::vector<Band> bands;
  std::vector<Line> lines;
  std::vector<Mark> marks;          // ringed points with a word
  std::vector<Mark> levels;         // horizontal lines at y with a word; x is not used
  std::string top_label;            // of a second scale along the upper edge
  std::vector<Mark> top;            // its ticks at x; y is not used
  std::vector<std::string> names;   // of x = 1, 2, ...: the only ticks, with a key below in place of x_label
  std::string empty = "no values";  // shown when there is nothing to draw
};

/// One row of a bar picture: parts side by side, each with its value in words in a column of its own.
struct Bar {
  std::string label;                // left of the bar
  std::vector<double> parts;        // lengths from the left, in the order of Bars::parts
  std::vector<std::string> values;  // right of the bar, in the same order
};
struct Bars {
  std::string title;
  std::vector<std::string> parts;  // names of the parts, head of their columns
  std::vector<Bar> rows;
};

struct Table {
  std::string title;
  std::vector<std::string> head;
  std::vector<std::vector<std::string>> rows;
  int emphasised = -1;  // row in bold
  std::string note;
};

/// A4, landscape. Two charts above, bars and table below; or two bar pictures above and a table over the whole width.
struct Page {
  std::string title, subtitle;
  std::vector<std::string> findings;  // sentences between the title and the charts
  Chart left, right;
  Bars upper_left, upper_right;  // in place of charts that have no title
  std::vector<Chart> grid;       // in place of all of these, in rows of at most four
  Bars bars;
  Table table;
  std::string footer;
};

/// Writes BASE.pdf, BASE.svg and BASE.png, each whole or not at all. Returns their names. Throws RenderError.
std::vector<std::string> write_page(const Page&, const std::filesystem::path& base);

}  // namespace render::charts
