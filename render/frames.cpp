#include "render/frames.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace render {
namespace {

constexpr double kLastPicture = 0.7;  // [s] of film
constexpr double kRounding = 1e-9;    // [s] times are sums of lengths, which are quotients

/// "shot.1 (camera above, speed 1e-12)", by the path it has in the scene.
std::string name_of(const Stage& stage, const Moment& first, int shot) {
  if (first.card >= 0) return fmt::format("card.{}", first.card);
  if (stage.shots.empty()) return "the whole run";
  return fmt::format("shot.{} (camera {}, speed {:.3g})", shot, first.camera, first.speed);
}

}  // namespace

Film::Film(const Stage& stage, double end_time, double fps) : fps_(fps) {
  double end = 0;  // [s] of film: cuts fall between frames and do not move the clock
  const auto append = [&](Moment first, double length, int shot) {
    const double begin = end;
    end += length;
    const double frames = std::ceil((end - kRounding) * fps);
    if (!(frames <= kMostFrames)) {
      throw FilmTooLong(
          fmt::format("with {} the film has {:.3g} frames at {:g} a second, more than the {} there can be; make it shorter or "
                      "faster, or take fewer frames a second",
                      name_of(stage, first, shot), frames, fps, kMostFrames));
    }
    if (frames > whole_) {
      stretches_.push_back({std::move(first), begin, whole_});
      whole_ = static_cast<int>(frames);
    }
  };
  int number = 0;
  const std::string& opening = stage.shots.empty() ? stage.cameras.front().name : stage.shots.front().camera;
  const auto cards = [&](bool at_end) {
    for (std::size_t c = 0; c < stage.cards.size(); ++c)
      if (stage.cards[c].at_end == at_end)
        append({at_end ? end_time : 0, opening, 0, Layout::single, "", static_cast<int>(c), number++}, stage.cards[c].hold, -1);
  };
  cards(false);
  std::vector<Shot> shots = stage.shots;
  // a run that diverged in its first step has one picture to show
  if (shots.empty()) shots.push_back({opening, 0, std::max(end_time, 1 / fps), 1, 0});
  for (std::size_t s = 0; s < shots.size(); ++s) {
    const Shot& shot = shots[s];
    // a run that came to rest early is not drawn out: the last picture stands for a moment, then the shot is over
    const double to = std::min(shot.to, std::max(shot.from, end_time + kLastPicture * shot.speed));
    append({shot.from, shot.camera, shot.speed, shot.layout, shot.second, -1, number++},
           shot.speed == 0 ? shot.hold : (to - shot.from) / shot.speed, static_cast<int>(s));
  }
  cards(true);
  size_ = whole_;
  runs_.push_back({0, 0});
}

Film::Film(const std::vector<Moment>& stills) : whole_(static_cast<int>(stills.size())), runs_{{0, 0}}, size_(whole_) {
  for (const Moment& still : stills) {
    const int frame = static_cast<int>(stretches_.size());
    stretches_.push_back({still, frame / fps_, frame});
  }
}

double Film::time_of(const Stretch& stretch, int number) const {
  return stretch.first.time + std::max(0.0, number / fps_ - stretch.begin) * stretch.first.speed;
}

FrameInterval Film::numbers_of(std::size_t s) const {
  return {stretches_[s].frame, (s + 1 < stretches_.size() ? stretches_[s + 1].frame : whole_) - 1};
}

int Film::number(int i) const {
  const auto run = std::prev(std::ranges::upper_bound(runs_, i, {}, &Run::at));
  return run->number + (i - run->at);
}

Moment Film::operator[](int i) const {
  const int n = number(i);
  const auto stretch = std::prev(std::ranges::upper_bound(stretches_, n, {}, &Stretch::frame));
  Moment moment = stretch->first;
  moment.time = time_of(*stretch, n);
  return moment;
}

int Film::below(int number) const {
  const auto next = std::ranges::upper_bound(runs_, number, {}, &Run::number);
  if (next == runs_.begin()) return 0;
  const auto run = std::prev(next);
  return std::min(run->at + (number - run->number), end_of(static_cast<std::size_t>(run - runs_.begin())));
}

Film Film::part(std::vector<FrameInterval> wanted) const {
  std::ranges::sort(wanted, {}, &FrameInterval::first);
  Film out = *this;
  out.runs_.clear();
  out.size_ = 0;
  int next = 0;  // the first number that has not been looked at
  for (const FrameInterval& interval : wanted) {
    const int first = std::max(interval.first, next), last = std::min(interval.last, whole_ - 1);
    if (last < first) continue;
    next = last + 1;
    for (int i = below(first), end = below(next); i < end;) {
      const auto run = static_cast<std::size_t>(std::prev(std::ranges::upper_bound(runs_, i, {}, &Run::at)) - runs_.begin());
      const int count = std::min(end, end_of(run)) - i;
      if (out.empty() || out.number(out.size_ - 1) + 1 != number(i)) out.runs_.push_back({out.size_, number(i)});
      out.size_ += count;
      i += count;
    }
  }
  return out;
}

Film Film::between(double from, double to) const {
  std::vector<FrameInterval> inside;
  for (std::size_t s = 0; s < stretches_.size(); ++s) {
    const auto [first, last] = numbers_of(s);
    const auto first_not_before = [&, begin = first, end = last + 1](auto before) {
      return first_without(begin, end, [&](int number) { return before(time_of(stretches_[s], number)); });
    };
    inside.push_back({first_not_before([&](double time) { return time < from - kRounding; }),
                      first_not_before([&](double time) { return time <= to + kRounding; }) - 1});
  }
  return part(std::move(inside));
}

std::vector<FrameInterval> Film::shots() const {
  std::vector<FrameInterval> out;
  for (std::size_t s = 0; s < stretches_.size(); ++s) {
    const auto [first, last] = numbers_of(s);
    if (const FrameInterval here{below(first), below(last + 1) - 1}; here.last >= here.first) out.push_back(here);
  }
  return out;
}

}  // namespace render
