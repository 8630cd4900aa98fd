// crashreel compare A.png B.png: are they the same picture? Says no with exit code 1.
#include "render/image/compare.h"

#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>

#include "cli/command.h"
#include "cli/exit.h"
#include "cli/output/whole_file.h"
#include "render/image/png.h"

namespace cli {
namespace {

struct CompareWish {
  std::string a;
  std::string b;
  std::string diff;
  bool overwrite = false;
  bool json = false;
};

int compare(const CompareWish& wish) {
  if (!wish.diff.empty()) refuse_existing(wish.diff, wish.overwrite);
  const render::Image a = render::read_png(wish.a);
  const render::Image b = render::read_png(wish.b);
  if (a.width != b.width || a.height != b.height) {
    fmt::print(stderr, "crashreel: {} is {}x{}, {} is {}x{}: pictures of different size are different\n", wish.a, a.width, a.height,
               wish.b, b.width, b.height);
    return kComparisonSaysNo;
  }
  const render::Difference found = render::difference_of(a, b);
  const render::Limits limits;
  const bool same = render::within(found, limits);
  if (!wish.diff.empty()) render::write_png(wish.diff, render::difference_picture(a, b));
  if (wish.json) {
    const nlohmann::ordered_json out = {
        {"same", same},
        {"share_above_2", found.share_above_2},
        {"pixels_above_32", found.above_32},
        {"largest", found.largest},
        {"rms", found.rms},
        {"psnr_dB", std::isfinite(found.psnr_dB) ? nlohmann::ordered_json(found.psnr_dB) : nullptr}};
    fmt::print("{}\n", out.dump(2));
  } else {
    fmt::print(
        "{}: {:.4f} % of pixels off by more than 2 (limit {} %), {} by more than 32 (limit {}), rms {:.4f} (limit {}), "
        "PSNR {:.1f} dB (limit {}){}\n",
        same ? "same" : "different", 100 * found.share_above_2, 100 * limits.share_above_2, found.above_32, limits.above_32,
        found.rms, limits.rms, found.psnr_dB, limits.psnr_dB, wish.diff.empty() ? "" : "; see " + wish.diff);
  }
  return same ? kDone : kComparisonSaysNo;
}

}  // namespace

std::function<int()> declare_compare(Arguments& arguments) {
  const auto wish = std::make_shared<CompareWish>();
  arguments.positional("A", wish->a, "a PNG");
  arguments.positional("B", wish->b, "the PNG it should look like");
  arguments.option("--diff", wish->diff, "OUT.png", "write a picture of where they differ");
  arguments.flag("--overwrite", wish->overwrite, "replace the difference picture if it exists");
  arguments.flag("--json", wish->json, "print the figures as JSON");
  return [wish] { return compare(*wish); };
}

}  // namespace cli
