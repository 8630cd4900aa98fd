// How far a long piece of work is, on standard error: a bar on a terminal, a line every few seconds elsewhere.
#pragma once

#include <string>

namespace cli {

enum class ShowProgress { automatic, always, never };

/// Seconds on a clock that never jumps. The engine has none of its own.
double clock_seconds();

/// [s] this process has computed. On an idle core it passes as the clock does; what others take of a busy one is left out.
double computed_seconds();

/// "8.4 s", "85 s", "0:02:43".
std::string readable_time(double seconds);

class Progress {
 public:
  /// "simulate", "s" of 4.0; "draw", "frames" of 120.
  Progress(std::string verb, std::string unit, double total, ShowProgress);
  /// Cheap: looks at the clock, writes only when it is time.
  void at(double done);
  /// Ends the bar's line. A piece of work too short for a line says nothing, unless asked to always.
  void finish(double done);

 private:
  std::string line(double done, double elapsed) const;
  void write(double done, double now);

  std::string verb_;
  std::string unit_;
  double total_;
  double start_;
  double last_written_;
  bool shown_;
  bool bar_;
  bool colour_;
  bool always_;
  bool wrote_ = false;
};

}  // namespace cli
