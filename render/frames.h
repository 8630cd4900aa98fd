// The frames of a film, by number. Each is computed when it is asked for: a film of any length takes the same memory.
#pragma once

#include <stdexcept>
#include <string>
#include <vector>

#include "render/stage.h"

namespace render {

/// What the film shows in one frame: simulated time, the camera, and the slow-motion factor of the shot.
struct Moment {
  double time = 0;     // [s]
  std::string camera;  // name in Stage::cameras
  double speed = 1;    // [-] burnt into the caption when not 1
  Layout layout = Layout::single;
  std::string second{};  // the other camera of a shared picture
  int card = -1;         // index into Stage::cards: a page of text in place of the scene
  int shot = -1;         // which shot this belongs to; chapters begin where it changes
};

/// From the first to the last, both included.
struct FrameInterval {
  int first = 0;
  int last = 0;
};

/// A year of film at 30 frames a second. Numbers of frames and their sums stay far from where an int ends.
constexpr int kMostFrames = 1'000'000'000;

/// A film of more frames than kMostFrames: the message names the shot that is one too many, and its speed.
struct FilmTooLong : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Frames of a film, all or a part. A part never moves the clock: its frames keep their numbers and moments.
class Film {
 public:
  /// The shots of the stage, between its cards (or the whole run from the first camera), of a run that ends at `end_time` [s].
  /// Throws FilmTooLong.
  Film(const Stage&, double end_time, double fps);
  /// Stills: a frame each.
  explicit Film(const std::vector<Moment>&);

  int size() const { return size_; }
  bool empty() const { return size_ == 0; }
  /// The i-th frame's moment, and its number in the whole film.
  Moment operator[](int i) const;
  int number(int i) const;
  bool holds(int number) const { return below(number + 1) > below(number); }

  /// Of these frames the ones with the numbers wanted, each once, in the order of the film.
  Film part(std::vector<FrameInterval> wanted) const;
  /// Of these frames the ones that show the simulated times from .. to [s].
  Film between(double from, double to) const;

  /// The frames of each card and shot that has any: which ones of this film, not their numbers in the whole. Simulated time never
  /// runs back within one.
  std::vector<FrameInterval> shots() const;

 private:
  /// A card or shot: its frames begin with number `frame` and reach to the next stretch's.
  struct Stretch {
    Moment first;
    double begin = 0;  // [s] of film
    int frame = 0;
  };
  /// Frames that follow one another: from the one numbered `number`, the `at`-th of this film, to the next run's.
  struct Run {
    int at = 0;
    int number = 0;
  };
  double time_of(const Stretch&, int number) const;
  FrameInterval numbers_of(std::size_t stretch) const;
  int below(int number) const;  // how many frames have smaller numbers
  int end_of(std::size_t run) const { return run + 1 < runs_.size() ? runs_[run + 1].at : size_; }

  double fps_ = 1;
  std::vector<Stretch> stretches_;
  int whole_ = 0;  // frames of the whole film
  std::vector<Run> runs_;
  int size_ = 0;
};

/// The first of begin..end-1 without a property that only those before it have; `end` if all have it. By halves.
template <class Property>
int first_without(int begin, int end, Property has) {
  while (begin < end) {
    const int middle = begin + (end - begin) / 2;
    if (has(middle))
      begin = middle + 1;
    else
      end = middle;
  }
  return begin;
}

}  // namespace render
