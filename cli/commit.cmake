# Writes OUT, a source that names the commit the tree SOURCE is at: "1a2b3c4d5e6f", with "+changes" where files differ from it, empty
# where there is no repository.
cmake_minimum_required(VERSION 3.25)

execute_process(COMMAND git -C ${SOURCE} rev-parse --short=12 HEAD OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
if(commit)
  execute_process(COMMAND git -C ${SOURCE} status --porcelain --untracked-files=no OUTPUT_VARIABLE changes ERROR_QUIET)
  if(changes)
    string(APPEND commit "+changes")
  endif()
endif()
file(CONFIGURE OUTPUT ${OUT} CONTENT "#include \"cli/commit.h\"\nconst char* cli::commit_of_build() {\n  return \"@commit@\";\n}\n" @ONLY)
