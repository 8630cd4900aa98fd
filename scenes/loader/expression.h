// "-0.432 s * speed": arithmetic with units over the names of [variables].
#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>

#include "scenes/loader/quantity.h"
#include "scenes/loader/value.h"

namespace scenes {

/// A number with the powers of its unit.
struct Measured {
  double value = 0;  // SI
  Powers powers;
};

/// The names of [variables]. Their values are texts of the same kind and may name one another, in any order.
class Variables {
 public:
  explicit Variables(const Value& table);
  bool empty() const { return table_->entries.empty(); }
  /// A name of a unit stays one: such variables are refused.
  bool has(std::string_view name) const;

  /// Value of an expression. Sums need equal units; a root needs even powers; sin, cos and tan need an angle. `g` is the
  /// acceleration of gravity. `problem` is filled and the result without meaning where something is wrong.
  Measured evaluate(std::string_view expression, std::string& problem);
  Measured value_of(const std::string& name, std::string& problem);
  const std::set<std::string>& used() const { return used_; }
  std::vector<std::string> names() const;

 private:
  const Value* table_;
  std::map<std::string, Measured> known_;
  std::set<std::string> open_;  // being worked out: meeting one again is a circle
  std::set<std::string> used_;
};

/// Whether a text names a variable or is arithmetic, so that it is no plain quantity.
bool is_expression(std::string_view text, const Variables&);

/// The words for powers: "a speed", "m^2/s".
std::string in_words(const Powers&);

}  // namespace scenes
