# Warnings are errors; compilation goes through ccache when it is there.
add_library(kingpin_options INTERFACE)
target_compile_options(kingpin_options INTERFACE -Wall -Wextra -Werror)
target_include_directories(kingpin_options INTERFACE ${PROJECT_SOURCE_DIR})

if(KINGPIN_SANITIZE)
  target_compile_options(kingpin_options INTERFACE
    -fsanitize=${KINGPIN_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all)
  target_link_options(kingpin_options INTERFACE -fsanitize=${KINGPIN_SANITIZE})
endif()

find_program(KINGPIN_CCACHE ccache)
if(KINGPIN_CCACHE)
  # Sloppiness lets ccache work with precompiled headers; the base directory lets two checkouts share.
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CMAKE_COMMAND} -E env
      CCACHE_SLOPPINESS=pch_defines,time_macros,include_file_mtime,include_file_ctime
      CCACHE_BASEDIR=${PROJECT_SOURCE_DIR} CCACHE_NOHASHDIR=1 ${KINGPIN_CCACHE})
endif()
