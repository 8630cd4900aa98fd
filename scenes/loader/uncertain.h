// [[uncertain]] and [[evidence]]: what is not known, and what was seen.
#pragma once

#include "scenes/loader/builder.h"

namespace scenes {

extern const Section kUncertainSection, kEvidenceSection;

/// `root` as written: paths may name variables and expressions.
void read_uncertain(Builder&, const Value& root, std::vector<Reader> uncertain);
void read_evidence(Builder&, std::vector<Reader> evidence);

/// The SI unit ("m/s") a number needs to stand for a value of this key; empty for plain numbers and for texts. `problem` says after
/// the path what is wrong with it.
struct KeyUnit {
  std::string si_unit;
  std::string problem;
};
KeyUnit unit_of_key(const Value& root, const std::string& path);

/// The number that stands at a path, in SI, with formulas worked out; nothing where none is written, as where the default or a
/// library has it, or where it is several.
std::optional<double> number_at(const Value& root, const std::string& path);

/// All numbers of a value: one quantity, several with one unit ("38 46 km/h"), or a list. `unit` is the one written first.
struct ReadValues {
  std::vector<double> numbers;  // SI
  WrittenUnit unit;
  std::string problem;
};
ReadValues read_values(const Value&, Dimension);

}  // namespace scenes
