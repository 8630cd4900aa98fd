// Values of the command line, read strictly: each refusal names the option, what was given and what to give.
#pragma once

#include <string>
#include <utility>

namespace cli {

/// "0.2s", "200 ms", or a bare number of seconds. Not negative.
double parse_time(const std::string& option, const std::string& text);

/// "1280x720".
std::pair<int, int> parse_size(const std::string& option, const std::string& text);

/// "10:20", "10:", ":20": first and last frame, both included; an open end is -1.
std::pair<int, int> parse_frames(const std::string& option, const std::string& text);

int parse_integer(const std::string& option, const std::string& text, int lower, int upper);
double parse_number(const std::string& option, const std::string& text, double lower, double upper);

}  // namespace cli
