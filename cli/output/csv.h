// trajectory.csv and contacts.csv: one row per body or contact and recorded instant. impacts.csv: one row a collision phase. The
// columns are a contract with other people's scripts: grow them, never rename them. Numbers are the shortest text that reads back
// as the same double, with a point.
#pragma once

#include "cli/output/whole_file.h"
#include "engine/measure/impacts.h"
#include "engine/recording.h"

namespace cli {

void write_trajectory(const engine::Recording&, WholeFile&);
void write_contacts(const engine::Recording&, WholeFile&);
/// What a row cannot say is an empty field.
void write_impacts(const std::vector<engine::Impact>&, WholeFile&);

/// The name of a body in every output; the ground for -1.
std::string body_name(const engine::Recording&, int body);

}  // namespace cli
