// crashreel compare A.png B.png: are they the same picture? Says no with exit code 1.
#include "render/image/compare.h"
#include "cli/output/json.h"

#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>

#include "cli/command.h"
#include "cli/exit.h"
#include "cli/output/difference.h"
#include "cli/output/whole_file.h"
#include "cli/parse.h"
#include "render/image/png.h"

namespace cli {
namespace {

struct CompareWish {
  std::string a;
  std::string b;
  std::string diff;
  std::vector<std::string> limits;
  std::vector<std::string> masks;
  bool overwrite = false;
  bool json = false;
};

render::Limits limits_of(const CompareWish& wish) {
  render::Limits limits;
  for (const std::string& text : wish.limits) {
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos) throw UsageError(fmt::format("--limit is \"{}\": must be like rms=0.5", text));
    set_limit(limits, text.substr(0, equals), parse_number("--limit " + text.substr(0, equals), text.substr(equals + 1), 0, 1e9));
  }
  return limits;
}

std::vector<render::Mask> masks_of(const CompareWish& wish) {
  std::vector<render::Mask> masks;
  for (const std::string& text : wish.masks) {
    const std::size_t x = text.find('x'), first = text.find('+'), second = text.find('+', first + 1);
    if (x == std::string::npos || first == std::string::npos || second == std::string::npos || x > first)
      throw UsageError(fmt::format("--mask is \"{}\": must be WxH+X+Y in pixels, like 120x40+0+500", text));
    const auto number = [&text](std::size_t from, std::size_t to, int least) {
      return parse_integer("--mask", text.substr(from, to - from), least, 16384);
    };
    masks.push_back({number(first + 1, second, 0), number(second + 1, text.size(), 0), number(0, x, 1), number(x + 1, first, 1)});
  }
  return masks;
}

/// What the comparison cannot see in the file as it is, told so that nobody trusts more than was looked at.
std::vector<std::string> notes_on(const CompareWish& wish) {
  std::vector<std::string> notes;
  const render::PngFormat a = render::png_format(wish.a), b = render::png_format(wish.b);
  for (const auto& [file, format] : {std::pair{wish.a, a}, std::pair{wish.b, b}}) {
    if (format.bit_depth == 16) notes.push_back(fmt::format("{} has 16 bits a channel; compared rounded to 8", file));
  }
  if (a.alpha != b.alpha) notes.push_back(fmt::format("{} has no alpha; taken as opaque", a.alpha ? wish.b : wish.a));
  return notes;
}

int compare(const CompareWish& wish) {
  if (!wish.diff.empty()) refuse_existing(wish.diff, wish.overwrite);
  const render::Limits limits = limits_of(wish);
  const std::vector<render::Mask> masks = masks_of(wish);
  const render::Image a = render::read_png(wish.a);
  const render::Image b = render::read_png(wish.b);
  if (a.width != b.width || a.height != b.height) {
    const std::string why = fmt::format("{} is {}x{}, {} is {}x{}: pictures of different size are different", wish.a, a.width,
                                        a.height, wish.b, b.width, b.height);
    fmt::print(stderr, "crashreel: {}{}\n", why, wish.diff.empty() ? "" : "; no difference picture is written");
    if (wish.json) fmt::print("{}\n", json_text(Json{{"same", false}, {"reason", why}}));
    return kComparisonSaysNo;
  }
  const std::vector<std::string> notes = notes_on(wish);
  const render::Difference found = render::difference_of(a, b, masks);
  const bool same = render::within(found, limits);
  if (!wish.diff.empty()) render::write_png(wish.diff, render::difference_picture(a, b, masks));
  if (wish.json) {
    nlohmann::ordered_json out = {{"same", same}};
    out.update(difference_json(found));
    out["limits"] = limits_json(limits);
    out["notes"] = notes;
    fmt::print("{}\n", json_text(out));
  } else {
    for (const std::string& note : notes) fmt::print(stderr, "crashreel: {}\n", note);
    fmt::print("{}: {}{}\n", same ? "same" : "different", difference_text(found, limits),
               wish.diff.empty() ? "" : "; see " + wish.diff);
  }
  return same ? kDone : kComparisonSaysNo;
}

}  // namespace

std::function<int()> declare_compare(Arguments& arguments) {
  const auto wish = std::make_shared<CompareWish>();
  arguments.positional("A", wish->a, "a PNG");
  arguments.positional("B", wish->b, "the PNG it should look like");
  arguments.option("--diff", wish->diff, "OUT.png", "write a picture of where they differ");
  arguments.repeatable("--limit", wish->limits, "NAME=VALUE", "another limit: rms=0.5, ssim=0.99, perceptual_worst=0.2");
  arguments.repeatable("--mask", wish->masks, "WxH+X+Y", "leave this rectangle of pixels out, X and Y from the upper left corner");
  arguments.flag("--overwrite", wish->overwrite, "replace the difference picture if it exists");
  arguments.flag("--json", wish->json, "print the figures as JSON");
  return [wish] { return compare(*wish); };
}

}  // namespace cli
