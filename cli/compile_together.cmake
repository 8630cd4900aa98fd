# Several sources of a target compiled as one: most of a source's time goes into headers and templates that its neighbours need too.
# Sources far apart in the list go together, whose unnamed namespaces seldom share names. A name that clashes all the same wants to be
# a better one; where that is not so, the source is compiled alone.
set(compiled_alone "/(effects|overlays)/table.cpp|/solver/wide_products.cpp|/sliding_joint_test.cpp|/generate/(truck|van).cpp|/render/(gl_painter|gl_picture|mark_picture)_test.cpp|/scenes/(person|joint|skin)_test.cpp")
# Dense algebra of any size takes the longest, wherever it is: once.
set(dense_algebra "/inference/(prior|proposal|sensitivity).cpp")
# The more in one, the less is compiled twice: of sixteen, the program takes a tenth less processor time than of eight. What only
# arranges is compiled briefly and may have more. Tests of pictures and loader have many constants of one name.
function(compile_together target)
  set(most 16)
  if(target STREQUAL cli)
    set(most 32)
  elseif(target MATCHES "^test_(render|scenes)$|^generate_assets$")
    set(most 8)
  endif()
  get_target_property(sources ${target} SOURCES)
  list(LENGTH sources count)
  if(NOT CRASHREEL_TOGETHER OR count LESS 2)
    return()
  endif()
  math(EXPR units "(${count} + ${most} - 1) / ${most}")
  set(i 0)
  foreach(source IN LISTS sources)
    math(EXPR unit "${i} % ${units}")
    math(EXPR i "${i} + 1")
    if(source MATCHES "${dense_algebra}")
      set(unit 0)
    endif()
    if(NOT source MATCHES "${compiled_alone}")
      set_source_files_properties(${source} PROPERTIES UNITY_GROUP ${unit})
    endif()
  endforeach()
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
  if(CMAKE_CXX_COMPILER_ID STREQUAL GNU)
    # a source that is included looks like a header, whose classes had better hold nothing of an unnamed namespace
    target_compile_options(${target} PRIVATE -Wno-subobject-linkage)
  else()
    # a local name is no mistake because another source has a constant of that name; g++ knows them apart and goes on warning
    target_compile_options(${target} PRIVATE -Wno-shadow)
  endif()
endfunction()
