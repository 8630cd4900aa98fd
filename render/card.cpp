#include "render/card.h"

#include <algorithm>
#include <cmath>

#include "render/text/labels.h"

namespace render {
namespace {

constexpr float kTitle = 58, kLineGap = 26, kText = 30, kFooter = 17;  // pixels at 1080 lines
constexpr double kTextLeft = 0.10, kTextRight = 0.95;                  // [-] of the picture, between which is written
constexpr double kPageTop = 0.03, kPageMiddle = 0.44;  // [-] a full page begins at the one, a short one has its middle at the other
constexpr double kLeastText = 16;                      // [pixels at 1080 lines], and
constexpr double kLeastPixels = 8;                     // [pixels] of the writing: smaller letters cannot be told apart
constexpr double kStep = 0.93;                         // [-] from one size to the next smaller
constexpr std::size_t kMostLines = 400;                // more than any page has room for

LabelItem bare_label() {
  LabelItem label;
  label.plate = false;
  return label;
}

/// The title and the first `count` lines, in `size` of their full size.
LabelItem writing(const Card& card, std::size_t count, double size, int width, int height) {
  LabelItem label = bare_label();
  const double scale = height / 1080.0;
  const auto write = [&](const std::string& text, float full, const Float4& colour) {
    const double pixels = full * size;
    for (const std::string& piece : broken_at_words(text, pixels * scale, (kTextRight - kTextLeft) * width)) {
      label.lines.push_back(piece);
      label.sizes.push_back(static_cast<float>(pixels));
      label.colours.push_back(colour);
    }
  };
  write(card.title, kTitle, kWhiteText);
  if (!card.lines.empty()) write(" ", kLineGap, kWhiteText);
  for (std::size_t i = 0; i < count; ++i) write(card.lines[i], kText, kPaleText);
  if (count < card.lines.size()) write("\u2026", kText, kPaleText);
  return label;
}

bool fits(const LabelItem& label, int width, int height) {
  DrawList alone;
  alone.labels = {label};
  return place_labels(alone, width, height).front().shrink >= 1;
}

LabelItem foot_of(const Stage& stage) {
  LabelItem foot = bare_label();
  foot.lines = {"Simulation, not footage"};
  if (!stage.provenance.empty()) foot.lines.push_back(stage.provenance);
  foot.sizes.assign(foot.lines.size(), kFooter);
  foot.colours.assign(foot.lines.size(), kPaleText);
  foot.anchor = {0.988f, 0.985f};
  foot.pivot = {1, 1};
  return foot;
}

}  // namespace

CardPage card_page(const Stage& stage, const Card& card, int width, int height) {
  const double least = std::min(1.0, std::max(kLeastText, kLeastPixels * 1080 / height) / static_cast<double>(kText));
  CardPage page;
  page.fitting = std::min(card.lines.size(), kMostLines);
  double size = 1;
  LabelItem label = writing(card, page.fitting, size, width, height);
  while (!fits(label, width, height) && size > least) {
    size = std::max(least, kStep * size);
    label = writing(card, page.fitting, size, width, height);
  }
  if (page.fitting > 0 && !fits(label, width, height)) {
    // the most lines that fit, by halving: [fitting, over)
    std::size_t over = page.fitting;
    for (page.fitting = 0; page.fitting + 1 < over;) {
      const std::size_t middle = (page.fitting + over) / 2;
      (fits(writing(card, middle, size, width, height), width, height) ? page.fitting : over) = middle;
    }
    label = writing(card, page.fitting, size, width, height);
  }
  page.list.labels = {label};
  const double tall = place_labels(page.list, width, height).front().height / height;
  page.list.labels.front().anchor = {static_cast<float>(kTextLeft), static_cast<float>(std::max(kPageMiddle, kPageTop + tall / 2))};
  page.list.labels.front().pivot = {0, 0.5f};
  page.list.labels.push_back(foot_of(stage));
  return page;
}

}  // namespace render
