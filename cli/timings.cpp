#include "cli/timings.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

namespace cli {
namespace {

render::FrameCost divided(render::FrameCost cost, int frames) {
  for (double& ms : cost) ms /= std::max(1, frames);
  return cost;
}

/// A frame like most: not the one with which its worker began, unless there are no others.
render::FrameCost usual(const render::FilmCost& cost) {
  return cost.later_frames > 0 ? divided(cost.later, cost.later_frames) : divided(cost.first, cost.first_frames);
}

double encode_ms(const render::FilmCost& cost) {
  return cost.encode_ms / std::max(1, cost.first_frames + cost.later_frames);
}

}  // namespace

void add(const render::FilmCost& cost, render::FilmCost& sum) {
  sum.workers = std::max(sum.workers, cost.workers);
  sum.first_frames += cost.first_frames;
  sum.later_frames += cost.later_frames;
  render::add(cost.first, sum.first);
  render::add(cost.later, sum.later);
  sum.encode_ms += cost.encode_ms;
  sum.wall_s += cost.wall_s;
}

std::string timings_text(const render::FilmCost& cost) {
  const render::FrameCost frame = usual(cost);
  const double encode = encode_ms(cost), all = render::together(frame) + encode;
  std::string out = fmt::format("{:<12} {:>8} {:>7}\n", "pass", "ms", "share");
  const auto row = [&](const char* name, double ms) {
    out += fmt::format("{:<12} {:>8.1f} {:>5.0f} %\n", name, ms, 100 * ms / all);
  };
  for (std::size_t i = 0; i < render::kPasses; ++i) row(render::kPassNames[i], frame[i]);
  row("encode", encode);
  row("together", all);
  const int frames = cost.first_frames + cost.later_frames;
  out += fmt::format("processor time a frame, mean of {}; the first of each of {} processes took {:.0f} ms\n",
                     cost.later_frames > 0 ? cost.later_frames : cost.first_frames, cost.workers,
                     render::together(divided(cost.first, cost.first_frames)));
  out += fmt::format("{} frames in {:.2f} s of the clock, {:.1f} a second\n", frames, cost.wall_s, frames / cost.wall_s);
  return out;
}

nlohmann::ordered_json timings_json(const render::FilmCost& cost) {
  nlohmann::ordered_json frame;
  const render::FrameCost mean = usual(cost);
  for (std::size_t i = 0; i < render::kPasses; ++i) frame[render::kPassNames[i]] = mean[i];
  frame["encode"] = encode_ms(cost);
  return {{"workers", cost.workers},
          {"frame_ms", frame},
          {"first_frame_ms", render::together(divided(cost.first, cost.first_frames))},
          {"wall_s", cost.wall_s}};
}

}  // namespace cli
