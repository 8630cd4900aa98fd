#pragma once

namespace cli {

/// The commit the program was built from, with "+changes" where files differed from it; empty without a repository.
const char* commit();

}  // namespace cli
