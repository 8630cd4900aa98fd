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

/// Whose a body is: "ann" of "ann/hips".
std::string owner(const std::string& body) {
  return body.substr(0, std::min(body.find('/'), body.size()));
}

std::string name_of(const engine::Recording& recording, int body) {
  if (body < 0) return "ground";
  const std::string& name = recording.body_names[static_cast<std::size_t>(body)];
  return name.find('/') == std::string::npos ? readable(name) : owner(name) + "'s " + readable(name);
}

std::string event_text(const engine::Recording& recording, const engine::Event& e) {
  std::string kind = e.kind;
  std::replace(kind.begin(), kind.end(), '_', ' ');
  if (e.body_a < 0) return kind;
  // who rests does so as a whole: the body is that of the trunk
  if (e.kind == "rest") return "rest: " + owner(recording.body_names[static_cast<std::size_t>(e.body_a)]);
  const bool touch = kind.find("contact") != std::string::npos || kind.find("impact") != std::string::npos || kind == "collision";
  std::string text = kind + ": " + name_of(recording, e.body_a);
  if (touch || kind == "joint broken") text += " and " + name_of(recording, e.body_b);
  if (e.kind == "run_over") text += " by " + name_of(recording, e.body_b);
  if (touch && e.value > 0) text += fmt::format(", {}{:.1f} m/s", e.kind == "head_impact" ? "" : "closing at ", e.value);
  return text;
}

/// A person torn off what it held: no joint of the body, and no injury.
bool is_hold(const engine::Recording& recording, const engine::Event& e) {
  return e.kind == "joint_broken" && e.body_a >= 0 && e.body_b >= 0 &&
         recording.body_names[static_cast<std::size_t>(e.body_a)].find('/') != std::string::npos;
}

}  // namespace

std::vector<Told> told(const engine::Recording& recording) {
  constexpr double kTogether = 0.05;  // [s]
  std::vector<Told> out;
  std::vector<bool> said(recording.events.size(), false);
  for (std::size_t i = 0; i < recording.events.size(); ++i) {
    const engine::Event& e = recording.events[i];
    if (e.kind == "release" || said[i]) continue;
    if (!is_hold(recording, e)) {
      out.push_back({e.time, event_text(recording, e)});
      continue;
    }
    const std::string& part = recording.body_names[static_cast<std::size_t>(e.body_a)];
    std::string parts;
    double last = e.time;
    for (std::size_t k = i; k < recording.events.size(); ++k) {
      const engine::Event& also = recording.events[k];
      if (!is_hold(recording, also) || also.body_b != e.body_b || also.time > e.time + kTogether) continue;
      const std::string& name = recording.body_names[static_cast<std::size_t>(also.body_a)];
      if (owner(name) != owner(part)) continue;
      said[k] = true;
      last = also.time;
      parts += (parts.empty() ? "" : ", ") + readable(name);
    }
    out.push_back({e.time, fmt::format("{} loses hold of {}{}: {}", owner(part), name_of(recording, e.body_b),
                                       last > e.time ? fmt::format(" by {:.3f} s", last) : "", parts)});
  }
  return out;
}

Story story_of(const Stage& stage, const engine::Recording& recording, const Film& film, double fps) {
  Story story;
  const std::vector<Told> happened = told(recording);
  for (const auto [first, last] : film.shots()) {
    const Moment opening = film[first];
    story.chapters.push_back({first / fps, (last + 1) / fps, chapter_title(stage, opening)});
    if (opening.card >= 0) continue;
    std::map<int, std::string> texts;  // by the frame that passes the event; several in one are told together
    for (const Told& e : happened) {
      if (e.time <= opening.time || e.time > film[last].time) continue;
      std::string& text = texts[first_without(first, last, [&](int i) { return film[i].time < e.time; })];
      text += fmt::format("{}{:.3f} s  {}", text.empty() ? "" : "\n", e.time, e.text);
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
