// The scene file as a whole: reading order, library, hash.
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>

#include "scenes/loader/builder.h"
#include "scenes/loader/sha256.h"
#include "scenes/loader/uncertain.h"
#include "scenes/loader/variables.h"

#ifndef CRASHREEL_HOME_DEFAULT
#define CRASHREEL_HOME_DEFAULT "."
#endif

namespace scenes {
namespace {

const Key kClosedFormKeys[] = {
    {"*", Type::number, Dimension::none, "", "The value of the metric of this name in summary.json, in the unit of its name."},
};
const Section kClosedFormSection{"closed_form", "[closed_form]",
                                 "Answers known in closed form; `crashreel study` measures errors against them.", kClosedFormKeys};

struct Heading {
  std::string title, description;
};

const Key kSceneKeys[] = {
    bound<&Heading::title>({"title", Type::text, Dimension::none, "'Untitled scene'", "Shown in pictures and files."}),
    bound<&Heading::description>(
        {"description", Type::text, Dimension::none, "''", "What the scene shows and where its numbers come from."}),
    {"variables", Type::table, Dimension::none, "", "Names for quantities.", kAny, {}, &kVariablesSection},
    {"uncertain", Type::tables, Dimension::none, "", "What is not known exactly.", kAny, {}, &kUncertainSection},
    {"evidence", Type::tables, Dimension::none, "", "What was seen.", kAny, {}, &kEvidenceSection},
    {"simulation", Type::table, Dimension::none, "", "How the motion is computed.", kAny, {}, &kSimulationSection},
    {"ground", Type::table, Dimension::none, "", "What everything stands on.", kAny, {}, &kGroundSection},
    {"vehicle", Type::tables, Dimension::none, "", "Vehicles.", kAny, {}, &kVehicleSection},
    {"person", Type::tables, Dimension::none, "", "Persons.", kAny, {}, &kPersonSection},
    {"body", Type::tables, Dimension::none, "", "Free bodies.", kAny, {}, &kBodySection},
    {"joint", Type::tables, Dimension::none, "", "Joints between bodies.", kAny, {}, &kJointSection},
    {"impact", Type::tables, Dimension::none, "", "Kudlich-Slibar impacts settled by hand.", kAny, {}, &kImpactSection},
    {"camera", Type::tables, Dimension::none, "", "Cameras.", kAny, {}, &kCameraSection},
    {"shot", Type::tables, Dimension::none, "", "The film, shot by shot.", kAny, {}, &kShotSection},
    {"card", Type::tables, Dimension::none, "", "Pages of text in the film.", kAny, {}, &kCardSection},
    {"overlays", Type::table, Dimension::none, "", "What is drawn over the picture.", kAny, {}, &kOverlaysSection},
    {"output", Type::table, Dimension::none, "", "Size and rate of pictures.", kAny, {}, &kOutputSection},
    {"road", Type::table, Dimension::none, "", "What the ground looks like.", kAny, {}, &kRoadSection},
    {"sky", Type::table, Dimension::none, "", "Sun and air.", kAny, {}, &kSkySection},
    {"snapshot", Type::table, Dimension::none, "", "How its pictures are tested.", kAny, {}, &kSnapshotSection},
    {"expect", Type::table, Dimension::none, "", "Measures that are tested.", kAny, {}, &kExpectSection},
    {"closed_form", Type::table, Dimension::none, "", "Answers known in closed form.", kAny, {}, &kClosedFormSection},
};

std::string hash_of(std::string all, const std::vector<std::string>& overrides) {
  for (const std::string& text : overrides) all += '\0' + text;
  return sha256(all);
}

/// A scene beside another is no pose, person or vehicle, though it may be called like one (cyclist.toml).
bool is_scene(const Value& root) {
  for (const char* section : {"simulation", "vehicle", "person", "body", "camera", "output"})
    if (root.find(section)) return true;
  return false;
}

/// What is looked for among others is looked for by name, one by one: ten thousand of a kind take a second.
void refuse_crowds(const Value& value, const std::string& key) {
  constexpr std::size_t kMost = 10'000;
  const bool tables = value.kind == Value::Kind::array && !value.items.empty() && value.items[0].kind == Value::Kind::table;
  if (tables && value.items.size() > kMost) {
    const Place& place = value.items[kMost].place;
    const std::string what = fmt::format("{} is there {} times; a scene has at most {}", key, value.items.size(), kMost);
    throw SceneErrors({Finding{place.file, place.line, place.column, "range", what}});
  }
  for (const Entry& entry : value.entries) refuse_crowds(entry.value, entry.key);
  if (tables)
    for (const Value& item : value.items) refuse_crowds(item, key);
}

void collect_names(Builder& builder, const Value& root) {
  std::map<std::string, std::string> taken;  // by what
  for (const char* list : {"vehicle", "person", "body"}) {
    const Value* found = root.find(list);
    if (!found) continue;
    for (const Value& item : found->items) {
      const Value* name = item.find("name");
      if (!name || name->kind != Value::Kind::text) continue;
      builder.declared.push_back(name->text);
      // two of one kind are told of by its reader
      const auto [first, fresh] = taken.try_emplace(name->text, list);
      if (fresh || first->second == list) continue;
      builder.errors.add(name->place, fmt::format("{}.name \"{}\" is already used by a {}; every vehicle, person and body needs a "
                                                  "name of its own",
                                                  list, name->text, first->second));
    }
  }
}

std::vector<std::string> texts_of(const std::vector<Finding>& findings) {
  std::vector<std::string> out;
  for (const Finding& finding : findings) out.push_back(finding.text());
  return out;
}

void read_closed_form(Builder& builder, std::optional<Reader> reader) {
  if (!reader) return;
  for (const Entry& entry : reader->value().entries) builder.scene.closed_form[entry.key] = reader->number(entry.key);
}

}  // namespace

std::string Finding::text() const {
  if (line == 0) return fmt::format("{}: {}", file, what);
  return column == 0 ? fmt::format("{}:{}: {}", file, line, what) : fmt::format("{}:{}:{}: {}", file, line, column, what);
}

SceneErrors::SceneErrors(std::vector<Finding> found)
    : std::runtime_error(fmt::format("{}", fmt::join(texts_of(found), "\n"))),
      findings(std::move(found)),
      lines(texts_of(findings)) {}

bool Builder::is_declared(const std::string& name) const {
  return std::find(declared.begin(), declared.end(), name.substr(0, name.find('/'))) != declared.end();
}

const Section& scene_section() {
  static const std::vector<Key> keys = [] {
    std::vector<Key> out(std::begin(kSceneKeys), std::end(kSceneKeys));
    const auto after = std::find_if(out.begin(), out.end(), [](const Key& key) { return key.name == "ground"; }) + 1;
    const std::vector<Key> more = keys_of_effects();
    out.insert(after, more.begin(), more.end());
    return out;
  }();
  static const Section section{"", "(top of the file)", "A scene.", keys};
  return section;
}

std::filesystem::path home_folder() {
  const char* home = std::getenv("CRASHREEL_HOME");
  if (home && *home) return home;
  std::error_code problem;
  const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", problem);
  const std::filesystem::path installed = program.parent_path().parent_path() / "share/crashreel";
  if (!problem && std::filesystem::is_directory(installed / "scenes/library", problem)) return installed;
  return CRASHREEL_HOME_DEFAULT;
}

std::string not_in_library(const Builder& builder, const std::string& kind, const std::string& word, const std::string& name) {
  const std::vector<std::string> names = library_names(builder, kind);
  if (names.empty())
    return fmt::format("there is no such {}, and no library in {}; set CRASHREEL_HOME to the folder that holds scenes/library",
                       word, home_folder().string());
  const std::string guess = nearest(name, names);
  return fmt::format("there is no such {}{} available: {}", word,
                     guess.empty() ? ";" : fmt::format("; did you mean \"{}\"?", guess), fmt::join(names, ", "));
}

std::optional<Value> library_entry(Builder& builder, const std::string& kind, const std::string& name) {
  if (name.empty() || name.find('/') != std::string::npos) return std::nullopt;
  std::error_code ignored;
  for (const auto& folder : {builder.folder, builder.folder / kind, home_folder() / "scenes/library" / kind}) {
    const auto file = folder / (name + ".toml");
    if (!std::filesystem::is_regular_file(file, ignored)) continue;
    const std::string text = read_text(file);
    Value entry = parse_text(text, file.string());
    if (folder == builder.folder && is_scene(entry)) continue;
    builder.assets += sha256(text);
    return entry;
  }
  return std::nullopt;
}

std::vector<std::string> library_names(const Builder& builder, const std::string& kind) {
  std::vector<std::string> out;
  std::error_code ignored;
  for (const auto& folder : {builder.folder / kind, home_folder() / "scenes/library" / kind}) {
    for (const auto& entry : std::filesystem::directory_iterator(folder, ignored))
      if (entry.path().extension() == ".toml") out.push_back(entry.path().stem().string());
  }
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

SceneFile read_scene_file(const std::filesystem::path& file, std::vector<std::filesystem::path> allowed) {
  return {file, read_text(file), std::move(allowed)};
}

Scene load(const std::filesystem::path& file, const std::vector<std::string>& overrides) {
  return load(read_scene_file(file), overrides);
}

Scene variant(const Scene& scene, const std::vector<std::string>& overrides) {
  std::vector<std::string> all = scene.overrides;
  all.insert(all.end(), overrides.begin(), overrides.end());
  return load(scene.file, all, scene.meshes);
}

Scene load(const SceneFile& file, const std::vector<std::string>& overrides, std::shared_ptr<MeshShelf> meshes) {
  Value root = parse_text(file.text, file.path.string());
  for (const std::string& text : overrides) apply_override(root, text);
  refuse_crowds(root, "");

  Builder builder;
  const Value written_root = root;  // with its expressions: what an uncertain key may name
  resolve_variables(root, builder.errors);
  builder.folder = file.path.parent_path();
  builder.scene.file = file;
  builder.scene.meshes = meshes ? std::move(meshes) : std::make_shared<MeshShelf>();
  Reader r(root, scene_section(), "", builder.errors);
  Heading heading;
  r.fill(heading);
  builder.scene.title = heading.title;
  builder.scene.path = file.path;
  builder.scene.overrides = overrides;
  builder.scene.sha256 = hash_of(file.text, overrides);

  collect_names(builder, root);
  // joints and cameras name bodies, so those come first
  read_settings(builder, r.table("simulation"));
  read_ground(builder, r.table("ground"));
  read_inputs_of_effects(builder, r);
  for (Reader& vehicle : r.tables("vehicle")) read_vehicle(builder, vehicle);
  for (Reader& person : r.tables("person")) read_person(builder, person);
  // without persons nobody yields
  engine::Settings& settings = builder.scene.model.settings;
  if (builder.scene.model.persons.empty() && settings.contact_law == engine::ContactLaw::persons_yield)
    settings.contact_law = engine::ContactLaw::default_auto;
  for (Reader& body : r.tables("body")) read_body(builder, body);
  for (Reader& joint : r.tables("joint")) read_joint(builder, joint);
  for (Reader& impact : r.tables("impact")) read_impact(builder, impact);
  read_film(builder, r);
  read_snapshot(builder, r.table("snapshot"), r.table("expect"));
  read_closed_form(builder, r.table("closed_form"));
  r.table("variables");
  read_uncertain(builder, written_root, r.tables("uncertain"));
  read_evidence(builder, r.tables("evidence"));

  if (builder.errors.empty() && builder.scene.model.bodies.empty())
    builder.errors.add({file.path.string()}, "the scene is empty; add a [[vehicle]], a [[person]] or a [[body]]");
  if (!builder.errors.empty()) throw SceneErrors(builder.errors.findings());
  builder.scene.assets_sha256 = sha256(builder.assets);
  builder.scene.warnings = builder.errors.warnings();
  builder.scene.assumed = builder.assumed.warnings();
  builder.scene.stage.title = builder.scene.title;
  builder.scene.stage.provenance = fmt::format("scene {}", builder.scene.sha256.substr(0, 12));
  return std::move(builder.scene);
}

}  // namespace scenes
