#include "cli/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <ctime>

#include "cli/process.h"

namespace cli {
namespace {

constexpr double kBarPeriod = 0.1;   // [s] the eye needs no more
constexpr double kLinePeriod = 5.0;  // [s] a log stays readable
constexpr int kBarWidth = 24;        // [characters]

}  // namespace

double clock_seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

double computed_seconds() {
  timespec t{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

std::string readable_time(double seconds) {
  if (seconds < 10) return fmt::format("{:.1f} s", seconds);
  if (seconds < 100) return fmt::format("{:.0f} s", seconds);
  const int whole = static_cast<int>(std::min(seconds, 359999.0));
  return fmt::format("{}:{:02}:{:02}", whole / 3600, whole / 60 % 60, whole % 60);
}

Progress::Progress(std::string verb, std::string unit, double total, ShowProgress show)
    : verb_(std::move(verb)),
      unit_(std::move(unit)),
      total_(total),
      start_(clock_seconds()),
      last_written_(start_),
      shown_(show != ShowProgress::never),
      bar_(isatty(STDERR_FILENO) != 0),
      colour_(bar_ && std::getenv("NO_COLOR") == nullptr),
      always_(show == ShowProgress::always) {}

void Progress::at(double done) {
  if (!shown_) return;
  const double now = clock_seconds();
  if (now - last_written_ < (bar_ ? kBarPeriod : kLinePeriod)) return;
  write(done, now);
}

void Progress::finish(double done) {
  if (!shown_ || (!wrote_ && !always_)) return;
  write(done, clock_seconds());
  if (bar_) fmt::print(stderr, "\n");
  shown_ = false;
}

std::string Progress::line(double done, double elapsed) const {
  const double share = total_ > 0 ? std::clamp(done / total_, 0.0, 1.0) : 1.0;
  const double rate = elapsed > 0 ? done / elapsed : 0;
  const std::string amount =
      unit_ == "s" ? fmt::format("{:.2f} of {:.2f} s", done, total_) : fmt::format("{:.0f} of {:.0f} {}", done, total_, unit_);
  const std::string left = rate > 0 && share < 1 ? fmt::format(", {} left", readable_time((total_ - done) / rate)) : "";
  return fmt::format("{:3.0f} %  {}, {:.3g} {}/s{}", 100 * share, amount, rate, unit_, left);
}

void Progress::write(double done, double now) {
  last_written_ = now;
  wrote_ = true;
  const std::string text = line(done, now - start_);
  if (!bar_) {
    fmt::print(stderr, "{} {}\n", verb_, text);
    return;
  }
  const int full = static_cast<int>(kBarWidth * (total_ > 0 ? std::clamp(done / total_, 0.0, 1.0) : 1.0));
  const std::string bar = std::string(full, '#') + std::string(kBarWidth - full, '.');
  // back to the start of the line and clear it, so that a shorter line leaves nothing behind
  write_to_terminal(fmt::format("\r\x1b[K{} [{}{}{}] {}", verb_, colour_ ? "\x1b[32m" : "", bar, colour_ ? "\x1b[0m" : "", text));
}

}  // namespace cli
