// report.html: everything in one file, to be mailed, kept as a CI artefact and opened without a network.
#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <sstream>

#include "cli/output/json.h"
#include "cli/snapshot/page.h"
#include "cli/snapshot/report.h"
#include "cli/snapshot/xml.h"
#include "render/image/compare.h"

namespace cli {
namespace {

namespace fs = std::filesystem;
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

std::string image(const fs::path& file, const char* kind) {
  std::ostringstream bytes;
  bytes << std::ifstream(file, std::ios::binary).rdbuf();
  return fmt::format("<img class=\"{0}\" alt=\"{0}\" src=\"data:image/png;base64,{1}\">", kind, base64(bytes.str()));
}

std::string figure(const std::string& inside, const std::string& caption) {
  return fmt::format("<figure>{}<figcaption>{}</figcaption></figure>\n", inside, caption);
}

std::string badge(const std::string& verdict) {
  return fmt::format("<span class=\"verdict {0}\">{0}</span>", in_xml(verdict));
}

std::string figures_of(const Json& picture) {
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

/// What there is to see of a picture, and its figures.
std::string look_at(const Json& picture, const fs::path& folder) {
  if (!picture.contains("actual")) return "";
  constexpr std::pair<const char*, const char*> kKinds[] = {
      {"expected", "expected"}, {"actual", "actual"}, {"difference", "difference: yellow by 1 of 255, red by 32 and more"}};
  std::string out = "<div class=\"picture\">\n<div class=\"row\">\n";
  for (const auto& [kind, caption] : kKinds)
    if (picture.contains(kind)) out += figure(image(folder / picture[kind].get<std::string>(), kind), caption);
  out += "</div>\n";
  if (picture.contains("difference"))
    out += "<div class=\"row\">\n" + figure(kFader, "one over the other") + figures_of(picture) + "</div>\n";
  return out + "</div>\n";
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

std::string name_of(const Json& scene, const fs::path& root, const fs::path& folder) {
  const std::string name = scene["scene"];
  return fmt::format("<a href=\"{}\">{}</a>", link_to(root / name, folder), in_xml(name));
}

std::string section_of(const Json& scene, const fs::path& root, const fs::path& folder) {
  std::string out = fmt::format("<section>\n<h2>{}</h2>\n", name_of(scene, root, folder));
  if (const std::string title = scene["title"]; !title.empty()) out += in_xml(title) + "\n";
  for (const Json& error : scene["errors"]) out += fmt::format("<pre>{}</pre>\n", in_xml(error.get<std::string>()));
  if (const std::string cause = cause_of(scene); !cause.empty()) out += fmt::format("<p><b>{}</b></p>\n", in_xml(cause));
  out += measures_of(scene);
  for (const Json& picture : scene["pictures"]) {
    out += fmt::format("<h3>{} {}</h3>\n", badge(picture["verdict"]), in_xml(picture["name"].get<std::string>()));
    // where there are figures their table says why
    if (!picture.contains("figures")) out += in_xml(picture["why"].get<std::string>()) + "\n";
    out += look_at(picture, folder);
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

/// What needs a look, in full; then what is as it was, in a line each.
std::string sections(const SnapshotReport& report, const fs::path& folder) {
  const fs::path root = report["folder"].get<std::string>();
  std::string out, rest;
  for (const Json& scene : report["scenes"]) {
    if (needs_a_look(scene))
      out += section_of(scene, root, folder);
    else
      rest += fmt::format("<li>{} {}</li>\n", name_of(scene, root, folder), in_xml(scene["title"].get<std::string>()));
  }
  if (!report["orphans"].empty()) {
    out += "<section>\n<h2>Baselines no scene names</h2>\n<div class=\"row\">\n";
    for (const Json& orphan : report["orphans"]) {
      const std::string file = orphan["file"];
      out += figure(fs::exists(file) ? image(file, "expected") : "", badge("orphaned") + " " + in_xml(file));
    }
    out += "</div>\n</section>\n";
  }
  if (!rest.empty()) out += "<section>\n<h2>As they were</h2>\n<ul>\n" + rest + "</ul>\n</section>\n";
  return out;
}

std::string counts_of(const SnapshotReport& report) {
  std::string out;
  for (const auto& [verdict, count] : report["counts"].items()) {
    if (count == 0) continue;
    std::string words = verdict;
    std::replace(words.begin(), words.end(), '_', ' ');
    out += fmt::format("{}{} {}", out.empty() ? "" : ", ", count.get<int>(), words);
  }
  return out;
}

}  // namespace

std::string report_html(const SnapshotReport& report, const fs::path& folder) {
  using fmt::arg;
  return fmt::format(kPage, arg("folder", in_xml(report["folder"].get<std::string>())), arg("style", kStyle),
                     arg("verdict", badge(report["same"] ? "same" : "different")), arg("counts", counts_of(report)),
                     arg("version", CRASHREEL_VERSION), arg("seconds", report.value("wall_s", 0.0)),
                     arg("sections", sections(report, folder)), arg("script", kScript));
}

}  // namespace cli
