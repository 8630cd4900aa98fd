// Files by which other programs ask for runs: Dakota's parameters and results, or a table with a row a run.
#pragma once

#include <string>
#include <vector>

#include "cli/inference/ensemble.h"
#include "scenes/scene.h"

namespace cli::inference {

/// What was asked for.
struct Request {
  bool dakota = false;                           // else a table
  std::vector<std::string> keys;                 // inputs
  std::vector<std::vector<std::string>> values;  // by run, in the order of the keys, as an override takes them
  std::vector<std::string> measures;             // wanted, in order; empty: all there are
};

/// Dakota's standard parameters file ("2 variables", then "VALUE NAME" lines, "1 functions", "1 ASV_1:NAME"), or CSV with the keys
/// in its first line. A bare number is in SI. Throws UsageError.
Request read_request(const scenes::Scene&, const std::string& text);
/// The overrides of a run.
std::vector<std::string> overrides_of(const Request&, std::size_t run);

/// Results as the caller expects them. Of Dakota's format "VALUE NAME" lines, or "fail" and the reason; of a table
/// row,status,MEASURE...,notes with a row a run, in order.
std::string results(const Request&, const std::vector<Answer>&);
/// How many answers lack what was asked for.
int failed(const Request&, const std::vector<Answer>&);

}  // namespace cli::inference
