// report.html: everything in one file, to be mailed, kept as a CI artefact and opened without a network.
#include <fmt/format.h>

#include <fstream>
#include <sstream>

#include "cli/snapshot/report.h"
#include "cli/snapshot/xml.h"
#include "render/image/compare.h"

namespace cli {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr const char* kStyle = R"(
body { font: 15px/1.45 system-ui, "DejaVu Sans", sans-serif; margin: 0; color: #1b1f24; background: #f3f4f6; }
header { background: #1f2933; color: #fff; padding: 18px 28px; }
header h1 { font-size: 20px; margin: 0 0 4px; }
header p { margin: 0; color: #cbd5e1; }
main { padding: 8px 28px 40px; max-width: 1240px; }
section { background: #fff; border: 1px solid #d8dde3; border-radius: 6px; padding: 14px 18px; margin: 16px 0; }
h2 { font-size: 16px; margin: 0 0 4px; }
h3 { font-size: 15px; margin: 14px 0 6px; }
a { color: #1d5fa8; }
.verdict { display: inline-block; border-radius: 3px; padding: 0 7px; font-size: 13px; color: #fff; background: #b3261e; }
.verdict.same, .verdict.updated { background: #2e7d32; }
.verdict.new { background: #1d5fa8; }
.verdict.missing, .verdict.orphaned { background: #9a6700; }
.pictures { display: flex; flex-wrap: wrap; gap: 12px; }
figure { margin: 0; width: 384px; }
figure img { display: block; width: 100%; border: 1px solid #9aa5b1; box-sizing: border-box; }
figcaption { font-size: 13px; color: #52606d; padding-top: 3px; }
.stack { position: relative; }
.stack .over { position: absolute; left: 0; top: 0; }
.controls { display: flex; gap: 8px; align-items: center; font-size: 13px; color: #52606d; margin-top: 4px; }
.controls input { flex: 1; }
table { border-collapse: collapse; margin: 8px 0; font-size: 13px; }
td, th { border-bottom: 1px solid #e2e6ea; padding: 2px 14px 2px 0; text-align: left; }
td.number { text-align: right; font-variant-numeric: tabular-nums; }
tr.beyond td { color: #b3261e; font-weight: 600; }
pre { background: #fdf0ef; padding: 8px; white-space: pre-wrap; }
)";

// the slider fades the actual picture over the expected one; blinking takes one, then the other, twice a second
constexpr const char* kScript = R"(
for (const box of document.querySelectorAll('.compare')) {
  const over = box.querySelector('.over'), slider = box.querySelector('input'), button = box.querySelector('button');
  let timer = 0;
  const show = value => { over.style.opacity = value / 100; };
  const stop = () => { clearInterval(timer); timer = 0; button.textContent = 'blink'; };
  slider.addEventListener('input', () => { stop(); show(slider.value); });
  button.addEventListener('click', () => {
    if (timer) { stop(); show(slider.value); return; }
    let on = false;
    button.textContent = 'stop';
    timer = setInterval(() => { on = !on; show(on ? 100 : 0); }, 250);
  });
  show(slider.value);
}
)";

std::string base64(const std::string& bytes) {
  constexpr const char* kLetters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    unsigned group = 0;
    for (std::size_t k = 0; k < 3; ++k) group = group << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    for (std::size_t k = 0; k < 4; ++k) out += i + k > bytes.size() ? '=' : kLetters[group >> (18 - 6 * k) & 63];
  }
  return out;
}

std::string image(const fs::path& folder, const Json& picture, const char* kind, const char* style) {
  std::ostringstream bytes;
  bytes << std::ifstream(folder / picture[kind].get<std::string>(), std::ios::binary).rdbuf();
  return fmt::format("<img class=\"{}\" alt=\"{}\" src=\"data:image/png;base64,{}\">", style, kind, base64(bytes.str()));
}

std::string badge(const std::string& verdict) {
  return fmt::format("<span class=\"verdict {0}\">{0}</span>", in_xml(verdict));
}

std::string pictures_of(const Json& picture, const fs::path& folder) {
  if (!picture.contains("actual")) return "";
  const auto figure = [](const std::string& inside, const std::string& caption) {
    return fmt::format("<figure>{}<figcaption>{}</figcaption></figure>\n", inside, caption);
  };
  std::string out = "<div class=\"pictures\">\n";
  if (picture.contains("expected")) out += figure(image(folder, picture, "expected", ""), "expected");
  out += figure(image(folder, picture, "actual", ""), "actual");
  if (picture.contains("difference")) {
    out += figure(image(folder, picture, "difference", ""), "difference: yellow by one of 255, red by 32 and more, blue masked");
    out += figure(fmt::format("<div class=\"compare\"><div class=\"stack\">{}{}</div><div class=\"controls\">expected <input "
                              "type=\"range\" min=\"0\" max=\"100\" value=\"50\" aria-label=\"fade\"> actual "
                              "<button type=\"button\">blink</button></div></div>",
                              image(folder, picture, "expected", ""), image(folder, picture, "actual", "over")),
                  "one over the other");
  }
  return out + "</div>\n";
}

std::string figures_of(const Json& picture) {
  if (!picture.contains("figures") || picture["verdict"] == "same") return "";
  std::string out = "<table><tr><th>figure</th><th>value</th><th>limit</th><th></th></tr>\n";
  for (const render::Measure& measure : render::measures()) {
    const Json& value = picture["figures"][measure.name];
    const Json limit = measure.limit ? picture["limits"][measure.name] : Json();
    const bool above = measure.same == render::Measure::Same::above;
    const bool beyond = !limit.is_null() && value.is_number() && (above ? value < limit : value > limit);
    out += fmt::format("<tr{}><td>{}</td><td class=\"number\">{}</td><td class=\"number\">{}</td><td>{}</td></tr>\n",
                       beyond ? " class=\"beyond\"" : "", measure.name,
                       value.is_number() ? fmt::format("{:.5g}", value.get<double>()) : "",
                       limit.is_null() ? "" : fmt::format("{} {:g}", above ? "&ge;" : "&le;", limit.get<double>()), measure.says);
  }
  return out + "</table>\n";
}

std::string measures_of(const Json& scene) {
  if (scene["measures"].empty()) return "";
  std::string out = "<table><tr><th>measure</th><th>expected</th><th>found</th><th></th></tr>\n";
  for (const Json& m : scene["measures"]) {
    out += fmt::format("<tr{}><td>{}</td><td>{}</td><td class=\"number\">{}</td><td>{} {}</td></tr>\n",
                       m["verdict"] == "same" ? "" : " class=\"beyond\"", in_xml(m["metric"].get<std::string>()),
                       in_xml(m["expected"].get<std::string>()),
                       m.contains("found") ? fmt::format("{:.6g}", m["found"].get<double>()) : "", badge(m["verdict"]),
                       in_xml(m["why"].get<std::string>()));
  }
  return out + "</table>\n";
}

/// A way from the report to the scene's file.
std::string link_to(const fs::path& file, const fs::path& folder) {
  std::string out;
  for (const char c : fs::absolute(file).lexically_normal().lexically_relative(fs::absolute(folder).lexically_normal()).string()) {
    const bool plain = std::isalnum(static_cast<unsigned char>(c)) || std::string_view("/._-~").find(c) != std::string_view::npos;
    out += plain ? std::string(1, c) : fmt::format("%{:02X}", static_cast<unsigned char>(c));
  }
  return out;
}

std::string section_of(const Json& scene, const fs::path& root, const fs::path& folder) {
  const std::string name = scene["scene"];
  std::string out = fmt::format("<section>\n<h2><a href=\"{}\">{}</a></h2>\n", link_to(root / name, folder), in_xml(name));
  if (const std::string title = scene["title"]; !title.empty()) out += in_xml(title) + "\n";
  for (const Json& error : scene["errors"]) out += fmt::format("<pre>{}</pre>\n", in_xml(error.get<std::string>()));
  if (const std::string cause = cause_of(scene); !cause.empty()) out += fmt::format("<p><b>{}</b></p>\n", in_xml(cause));
  out += measures_of(scene);
  for (const Json& picture : scene["pictures"]) {
    out += fmt::format("<h3>{} {}</h3>\n", badge(picture["verdict"]), in_xml(picture["name"].get<std::string>()));
    if (const std::string why = picture["why"]; !why.empty()) out += in_xml(why) + "\n";
    out += pictures_of(picture, folder) + figures_of(picture);
  }
  return out + "</section>\n";
}

bool needs_a_look(const Json& scene) {
  if (!scene["errors"].empty()) return true;
  for (const char* list : {"pictures", "measures"})
    for (const Json& item : scene[list])
      if (item["verdict"] != "same") return true;
  return false;
}

}  // namespace

std::string report_html(const SnapshotReport& report, const fs::path& folder) {
  const fs::path root = report["folder"].get<std::string>();
  std::string counts;
  for (const auto& [verdict, count] : report["counts"].items())
    if (count != 0)
      counts += fmt::format("{}{} {}", counts.empty() ? "" : ", ", count.get<int>(),
                            verdict == "measures_same"  ? "measures hold"
                            : verdict == "measures_off" ? "measures off"
                                                        : verdict);
  // what needs a look comes first
  std::string look, rest;
  for (const Json& scene : report["scenes"]) (needs_a_look(scene) ? look : rest) += section_of(scene, root, folder);
  if (!report["orphans"].empty()) {
    look += "<section>\n<h2>Baselines no scene names</h2>\n";
    for (const Json& orphan : report["orphans"])
      look += fmt::format("<h3>{} {}</h3>\n", badge("orphaned"), in_xml(orphan["file"].get<std::string>()));
    look += "</section>\n";
  }
  return fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<meta name=\"viewport\" "
      "content=\"width=device-width\">\n"
      "<title>Snapshots: {0}</title>\n<style>{1}</style>\n</head>\n<body>\n<header><h1>{2} {3}</h1><p>{4}; crashreel {5}, "
      "{6:.1f} s</p></header>\n<main>\n{7}{8}</main>\n<script>{9}</script>\n</body>\n</html>\n",
      in_xml(root.string()), kStyle, badge(report["same"] ? "same" : "different"), in_xml(root.string()), in_xml(counts),
      CRASHREEL_VERSION, report.value("wall_s", 0.0), look, rest, kScript);
}

}  // namespace cli
