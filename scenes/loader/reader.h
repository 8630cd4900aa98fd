// Reads one table of a scene file by its value table, collecting what is wrong.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/math/types.h"
#include "engine/model/schedule.h"
#include "scenes/error.h"
#include "scenes/loader/table.h"
#include "scenes/loader/value.h"

namespace scenes {

/// What was found so far. Loading goes on after an error so that several are told at once.
class Errors {
 public:
  /// `code` tells scripts of what kind the error is (scenes/error.h).
  void add(const Place& place, const std::string& what, const std::string& code = "value");
  /// The same of the value of a key; the second error of one value is not told, the first one explains it.
  void add_of(const std::string& path, const Place& place, const std::string& what, const std::string& code);
  void warn(const Place& place, const std::string& what);
  std::size_t count() const { return found_.size(); }
  bool empty() const { return found_.empty(); }
  /// In the order of the file, each once.
  std::vector<Finding> findings() const { return sorted(found_); }
  std::vector<std::string> warnings() const;

 private:
  static std::vector<Finding> sorted(std::vector<Finding>);
  std::vector<Finding> found_;
  std::vector<Finding> odd_;
  std::vector<std::string> told_;  // values with an error: path and place
};

/// Every getter returns a usable value: after an error, the key's default or a harmless one. The key must be in the section's
/// table.
class Reader {
 public:
  /// Reports keys the section does not know and required ones that are missing.
  Reader(const Value& table, const Section& section, std::string path, Errors& errors);

  bool has(std::string_view key) const { return table_->find(key) != nullptr; }
  bool boolean(std::string_view key);
  int integer(std::string_view key);
  double number(std::string_view key);
  std::string text(std::string_view key);
  /// Index of the chosen word in the key's list of choices.
  int choice(std::string_view key);
  engine::Vec3 vector(std::string_view key);  // of a vector2 the third is zero
  std::vector<double> numbers(std::string_view key);
  std::array<double, 2> range(std::string_view key);
  std::vector<std::string> texts(std::string_view key);
  engine::Schedule schedule(std::string_view key);
  engine::Mat3 inertia(std::string_view key);
  std::array<float, 3> colour(std::string_view key);  // linear RGB

  /// Sets the fields of the object that keys of the section are bound to (bound.h); those with neither value nor default stay.
  template <class T>
  void fill(T& object);
  /// One of them; false where it has neither. Of a choice an enumeration takes its place in the list, a text the word, a truth
  /// whether it is the second.
  template <class T>
  bool read(std::string_view key, T& out);

  std::optional<Reader> table(std::string_view key);
  std::vector<Reader> tables(std::string_view key);
  /// Tables or values of a map, by name.
  std::vector<std::pair<std::string, Reader>> map(std::string_view key);

  /// "path.key is VALUE: what" at the value's place, or at the
  /// table's when the key is not there.
  void fail(std::string_view key, const std::string& what);
  void fail_here(const std::string& what);
  void warn(std::string_view key, const std::string& what);
  const Place& place() const { return table_->place; }
  const Place& place(std::string_view key) const;
  const std::string& path() const { return path_; }
  std::string path(std::string_view key) const { return path_.empty() ? std::string(key) : path_ + "." + std::string(key); }
  const Value& value() const { return *table_; }
  const Section& section() const { return *section_; }
  Errors& errors() const { return *errors_; }

 private:
  const Value* get(std::string_view key, const Key*& line) const;
  double read_number(const Value&, const Key&, const std::string& path);
  bool read_numbers(const Value&, const Key&, const std::string& path, std::vector<double>& out);
  void bad(const Value&, const std::string& path, const std::string& what, const std::string& code = "value");

  const Value* table_;
  const Section* section_;
  std::string path_;
  Errors* errors_;
};

/// The path of an element of a list of tables: its name when it has one, else its number.
std::string element_path(const std::string& list_path, const Value& element, std::size_t number);

}  // namespace scenes
