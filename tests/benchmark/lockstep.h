#pragma once

/// Prints what runs in lockstep, four to a vector, would gain over one run a core: the joints' elimination both ways, and the share
/// of a run in which all runs do the same.
void runs_in_lockstep();
