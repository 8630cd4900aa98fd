// What the answers of runs need beside them: measures that count only so far, because the run ended before the rest, and warnings.
// One run says it in its summary, many are counted.
#pragma once

#include <map>
#include <nlohmann/json_fwd.hpp>
#include <set>
#include <string>
#include <vector>

#include "engine/measure/metrics.h"

namespace cli {

/// Whether it is a way to rest of who does not rest yet: a longer run gives another number. A roll that ends on the wheels is over.
bool is_so_far(const engine::Metric&, const std::vector<engine::Metric>& all, const std::vector<engine::AbsentMetric>&);

/// Of one run.
struct RunNotes {
  std::vector<std::string> so_far;    // measures by the names of their columns
  std::vector<std::string> warnings;  // as `simulate` tells them
};
/// "still moving at the end: throw_distance_m so far; warning: ..."; empty where there is nothing to say.
std::string as_field(const RunNotes&);

/// Of many runs.
struct Notices {
  std::size_t runs = 0, unfinished = 0, warned = 0;
  std::set<std::string> so_far;  // measures that some run has only so far
  /// Runs whose warnings differ by their numbers alone; the text is that of the first.
  struct Counted {
    std::string text;
    std::size_t runs = 0;
    bool alike = true;  // in their numbers too
  };
  std::map<std::string, Counted> warnings;  // by what they warn of
  void add(const RunNotes&);
};
/// A sentence each, none where nothing is to be told.
std::vector<std::string> in_words(const Notices&);
/// Adds `unfinished` and `warnings`.
void add_notices(const Notices&, nlohmann::ordered_json&);

}  // namespace cli
