// Whole scenes from end to end: what a user waits for, and how many a study gets through.
#pragma once

namespace benchmark {

/// The flagship, three persons who come to lie on each other, ten who fall on a heap: the quickest of three runs each.
void whole_runs();

/// A thousand variants of the flagship on two cores: speeds within a tenth, the person up to 0.3 m aside.
void throughput();

}  // namespace benchmark
