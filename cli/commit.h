// The commit the program was built from. The build writes it into the program alone, so that a new commit links nothing else anew.
#pragma once

namespace cli {

/// "1a2b3c4d5e6f", with "+changes" where files differed from it; empty without a repository. Written by cli/commit.cmake.
const char* commit_of_build();

/// What main() was built from, for `crashreel version`.
void set_commit(const char*);

}  // namespace cli
