// Values of the command line, read strictly: each refusal names the option, what was given and what to give.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace cli {

/// "0.2s", "200 ms", or a bare number of seconds. Not negative.
double parse_time(const std::string& option, const std::string& text);

/// "1280x720".
std::pair<int, int> parse_size(const std::string& option, const std::string& text);

/// Frames first, first + step ... up to last, both included; last -1: to the end.
struct FrameRange {
  int first = 0;
  int last = -1;
  int step = 1;
  bool holds(int frame) const { return frame >= first && (last < 0 || frame <= last) && (frame - first) % step == 0; }
};

/// As render farms write them: "7", "1-100", "1-100x5" or "1-100:5" (every fifth), "10-" and "-20" with an open end, "10:20" and
/// the like for FIRST:LAST, and lists "1-10,20,30-".
std::vector<FrameRange> parse_frames(const std::string& option, const std::string& text);

int parse_integer(const std::string& option, const std::string& text, int lower, int upper);
double parse_number(const std::string& option, const std::string& text, double lower, double upper);

}  // namespace cli
