// The runs of a plan as a table: runs.csv, and columns of numbers for statistics.
#pragma once

#include <string>
#include <vector>

#include "cli/inference/ensemble.h"
#include "cli/inference/prior.h"

namespace cli::inference {

/// One row a run.
struct Row {
  std::vector<double> scores;     // independent normal scores of its inputs
  std::vector<double> values;     // of the uncertain inputs, SI, or the number of a choice
  std::vector<std::string> grid;  // values of the grid's keys, as given
  Answer answer;
  std::vector<double> misfits;  // by piece of evidence, in tolerances; empty where the run failed
};

struct Table {
  std::vector<std::string> grid_keys;
  std::vector<Row> rows;
};

/// Fills the misfits of rows that have an answer.
void judge(const std::vector<scenes::Evidence>&, Table&);

/// Every measure that some run has, in alphabetical order.
std::vector<std::string> outputs_of(const Table&);

/// One output over the rows; NaN where a run does not have it.
std::vector<double> column(const Table&, const std::string& output);

/// run,status,in.<key>...,out.<metric>...,misfit.<evidence>...,notes
std::string runs_csv(const Prior&, const std::vector<scenes::Evidence>&, const Table&);

/// What the runs need beside their numbers.
Notices notices_of(const Table&);

/// A number and its unit in the way of the scene's author: "43.2 km/h" of 12 m/s.
std::string told(double si, const scenes::WrittenUnit&, double resolution);
/// A text as a field of a CSV file.
std::string quoted(const std::string&);

}  // namespace cli::inference
