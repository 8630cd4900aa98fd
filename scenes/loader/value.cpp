#include "scenes/loader/value.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "scenes/error.h"

namespace scenes {

std::string Place::text() const {
  return line > 0 ? fmt::format("{}:{}:{}", file, line, column) : file;
}

const Value* Value::find(std::string_view key) const {
  for (const Entry& entry : entries)
    if (entry.key == key) return &entry.value;
  return nullptr;
}

Value* Value::find(std::string_view key) {
  return const_cast<Value*>(std::as_const(*this).find(key));
}

const Value& empty_table() {
  static const Value empty = [] {
    Value table;
    table.kind = Value::Kind::table;
    return table;
  }();
  return empty;
}

std::string written(const Value& value) {
  constexpr std::size_t kLongest = 60;
  switch (value.kind) {
    case Value::Kind::boolean:
      return value.boolean ? "true" : "false";
    case Value::Kind::integer:
    case Value::Kind::real:
      return fmt::format("{}", value.number);
    case Value::Kind::text:
      return '"' + (value.text.size() > kLongest ? value.text.substr(0, kLongest) + "..." : value.text) + '"';
    case Value::Kind::array: {
      std::string out = "[";
      for (const Value& item : value.items) {
        if (out.size() > kLongest) return out + ", ...]";
        out += (out.size() > 1 ? ", " : "") + written(item);
      }
      return out + "]";
    }
    case Value::Kind::table:
      return "a table";
    case Value::Kind::other:
      break;
  }
  return "a date or time";
}

Value overlaid(const Value& under, const Value& over) {
  if (under.kind != Value::Kind::table || over.kind != Value::Kind::table) return over;
  Value out = under;
  out.place = over.place;
  for (const Entry& entry : over.entries) {
    if (Value* old = out.find(entry.key)) {
      *old = overlaid(*old, entry.value);
    } else {
      out.entries.push_back(entry);
    }
  }
  return out;
}

std::string nearest(std::string_view word, const std::vector<std::string>& candidates) {
  std::string best;
  std::size_t best_distance = std::max<std::size_t>(2, word.size() / 3) + 1;
  std::vector<std::size_t> row;
  for (const std::string& candidate : candidates) {
    // Levenshtein distance, one row at a time
    row.resize(candidate.size() + 1);
    for (std::size_t j = 0; j < row.size(); ++j) row[j] = j;
    for (std::size_t i = 1; i <= word.size(); ++i) {
      std::size_t diagonal = row[0];
      row[0] = i;
      for (std::size_t j = 1; j < row.size(); ++j) {
        const std::size_t substitution = diagonal + (word[i - 1] == candidate[j - 1] ? 0 : 1);
        diagonal = row[j];
        row[j] = std::min({row[j] + 1, row[j - 1] + 1, substitution});
      }
    }
    if (row.back() < best_distance) {
      best_distance = row.back();
      best = candidate;
    }
  }
  return best;
}

}  // namespace scenes
