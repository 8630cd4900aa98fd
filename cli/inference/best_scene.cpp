#include "cli/inference/best_scene.h"

#include <fmt/format.h>

#include <algorithm>

#include "scenes/loader/key_path.h"

namespace cli::inference {
namespace {

struct Edit {
  std::size_t at = 0, length = 0;
  std::string text;
};

std::size_t offset_of(const std::string& text, const scenes::Place& place) {
  std::size_t at = 0;
  for (int line = 1; line < place.line && at < text.size(); ++line) at = std::min(text.find('\n', at), text.size() - 1) + 1;
  return std::min(at + static_cast<std::size_t>(std::max(0, place.column - 1)), text.size());
}

/// How long the value is that begins there: a text in quotes, a list in brackets, or a word.
std::size_t length_of_value(const std::string& text, std::size_t at) {
  std::size_t end = at;
  int depth = 0;
  char quote = 0;
  for (; end < text.size(); ++end) {
    const char c = text[end];
    if (quote) {
      if (c == '\\' && quote == '"')
        ++end;
      else if (c == quote)
        quote = 0;
      if (!quote && depth == 0) return end + 1 - at;
      continue;
    }
    if (c == '"' || c == '\'') quote = c;
    if (c == '[') ++depth;
    if (c == ']' && --depth == 0) return end + 1 - at;
    if (depth == 0 && end > at && (c == ' ' || c == '\t' || c == '\n' || c == '\r' || c == '#' || c == ',' || c == '}')) break;
  }
  return end - at;
}

/// Numbers stand as they are, texts in quotes.
std::string toml_of(const std::string& value) {
  const bool bare = value == "true" || value == "false" || value.starts_with('[') || value.starts_with('"') ||
                    value.find_first_not_of("0123456789.eE+-") == std::string::npos;
  return bare ? value : '"' + value + '"';
}

/// The nearest table that is written in the file, and the rest of the path below it.
Edit below_header(const scenes::Value& root, const std::string& text, const std::string& path, const std::string& value) {
  const std::vector<std::string> parts = scenes::split_path(path);
  const scenes::Value* at = &root;
  const scenes::Value* table = nullptr;
  std::size_t rest = 0;
  for (std::size_t i = 0; i + 1 < parts.size() && at; ++i) {
    if (at->kind == scenes::Value::Kind::array) {
      at = scenes::element_of(*const_cast<scenes::Value*>(at), parts[i]);
    } else {
      const scenes::Value* child = at->find(parts[i]);
      at = child ? child : at->find(scenes::singular(parts[i]));
    }
    if (at && at->kind == scenes::Value::Kind::table && at->place.line > 0) table = at, rest = i + 1;
  }
  const std::vector<std::string> left(parts.begin() + static_cast<std::ptrdiff_t>(rest), parts.end());
  const std::string line = fmt::format("{} = {}\n", fmt::join(left, "."), toml_of(value));
  if (!table) return {0, 0, line};
  const std::size_t end = text.find('\n', offset_of(text, table->place));
  return {end == std::string::npos ? text.size() : end + 1, 0, line};
}

/// Paths relative to the scene's folder become whole ones.
void find_paths(const scenes::Value& table, const scenes::Section& section, const std::string& text,
                const std::filesystem::path& folder, std::vector<Edit>& edits) {
  for (const scenes::Entry& entry : table.entries) {
    const scenes::Key* key = section.find(entry.key);
    if (!key) continue;
    if (key->type == scenes::Type::table) find_paths(entry.value, *key->section, text, folder, edits);
    if (key->type == scenes::Type::tables)
      for (const scenes::Value& item : entry.value.items) find_paths(item, *key->section, text, folder, edits);
    if (key->type == scenes::Type::map)
      for (const scenes::Entry& named : entry.value.entries) find_paths(named.value, *key->section, text, folder, edits);
    std::error_code ignored;
    if (key->type != scenes::Type::path || entry.value.kind != scenes::Value::Kind::text) continue;
    const std::filesystem::path whole = std::filesystem::absolute(folder / entry.value.text, ignored);
    if (!std::filesystem::exists(whole, ignored)) continue;
    const std::size_t at = offset_of(text, entry.value.place);
    edits.push_back({at, length_of_value(text, at), '"' + whole.lexically_normal().string() + '"'});
  }
}

}  // namespace

std::string with_overrides(const scenes::Scene& scene, const std::vector<std::string>& overrides, const std::string& remark) {
  std::string text = scene.file.text;
  const scenes::Value root = scenes::parse_text(text, scene.path.string());
  std::vector<Edit> edits;
  find_paths(root, scenes::scene_section(), text, scene.path.parent_path(), edits);
  std::string head = remark;
  if (!edits.empty())
    head += fmt::format("# Meshes and pictures lie elsewhere: --allow {}\n",
                        std::filesystem::absolute(scene.path).parent_path().string());
  for (const std::string& assignment : overrides) {
    const std::size_t equals = assignment.find('=');
    const std::string path = assignment.substr(0, equals), value = assignment.substr(equals + 1);
    const scenes::KeyOfPath found = scenes::key_of_path(root, path);
    Edit edit = below_header(root, text, path, value);
    if (found.value) {
      const std::size_t at = offset_of(text, found.value->place);
      edit = {at, length_of_value(text, at), toml_of(value)};
    }
    // a later override of the same value counts
    std::erase_if(edits, [&](const Edit& e) { return e.length > 0 && e.at == edit.at; });
    edits.push_back(std::move(edit));
  }
  std::stable_sort(edits.begin(), edits.end(), [](const Edit& a, const Edit& b) { return a.at > b.at; });
  for (const Edit& e : edits) text.replace(e.at, e.length, e.text);
  return head + text;
}

}  // namespace cli::inference
