#include "render/video/story.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "render/overlays/overlay.h"

namespace render {
namespace {

constexpr double kReading = 2.5;  // [s] of film that a subtitle stays, unless the next one comes

std::string chapter_title(const Stage& stage, const Moment& moment) {
  if (moment.card >= 0) return stage.cards[static_cast<std::size_t>(moment.card)].title;
  const auto before = std::count_if(stage.cards.begin(), stage.cards.end(), [](const Card& c) { return !c.at_end; });
  const auto shot = static_cast<std::size_t>(moment.shot - before);  // far out of range where it is none
  if (moment.shot >= before && shot < stage.shots.size() && !stage.shots[shot].title.empty()) return stage.shots[shot].title;
  return moment.second.empty() ? moment.camera : moment.camera + " and " + moment.second;
}

std::string event_text(const engine::Recording& recording, const engine::Event& e) {
  auto name = [&](int body) {
    return body < 0 ? std::string("ground") : readable(recording.body_names[static_cast<std::size_t>(body)]);
  };
  std::string kind = e.kind;
  std::replace(kind.begin(), kind.end(), '_', ' ');
  const bool touch = kind.find("contact") != std::string::npos || kind.find("impact") != std::string::npos;
  std::string text = fmt::format("{:.3f} s  {}", e.time, kind);
  if (e.body_a >= 0) text += ": " + name(e.body_a);
  if (touch && e.body_a >= 0) text += " and " + name(e.body_b);
  if (e.kind == "run_over") text += " by " + name(e.body_b);
  if (touch && e.value > 0) text += fmt::format(", {:.1f} m/s", e.value);
  return text;
}

}  // namespace

Story story_of(const Stage& stage, const engine::Recording& recording, const Film& film, double fps) {
  Story story;
  for (const auto [first, last] : film.shots()) {
    const Moment opening = film[first];
    story.chapters.push_back({first / fps, (last + 1) / fps, chapter_title(stage, opening)});
    if (opening.card >= 0) continue;
    std::map<int, std::string> texts;  // by the frame that passes the event; several in one are told together
    for (const engine::Event& e : recording.events) {
      if (e.kind == "release" || e.time <= opening.time || e.time > film[last].time) continue;
      std::string& text = texts[first_without(first, last, [&](int i) { return film[i].time < e.time; })];
      text += (text.empty() ? "" : "\n") + event_text(recording, e);
    }
    for (auto& [frame, text] : texts) {
      const double at = frame / fps;
      if (!story.subtitles.empty()) story.subtitles.back().to = std::min(story.subtitles.back().to, at);
      story.subtitles.push_back({at, at + kReading, std::move(text)});
    }
  }
  if (!story.subtitles.empty()) story.subtitles.back().to = std::min(story.subtitles.back().to, film.size() / fps);
  return story;
}

}  // namespace render
