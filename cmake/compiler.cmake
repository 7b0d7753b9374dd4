# Warnings are errors; compilation goes through ccache when it is there.
add_library(kingpin_options INTERFACE)
target_compile_options(kingpin_options INTERFACE -Wall -Wextra -Werror)
if(CMAKE_CXX_COMPILER_ID STREQUAL GNU)
  # GCC 12 warns about copies inside std::string that cannot happen (its bugs 105329 and 105651).
  target_compile_options(kingpin_options INTERFACE
    -Wno-restrict -Wno-stringop-overflow -Wno-stringop-overread -Wno-array-bounds)
endif()
# The kernels have their own -O3; elsewhere -O2 builds a third faster and runs as fast.
set(CMAKE_CXX_FLAGS_RELEASE "-O2 -DNDEBUG")
target_include_directories(kingpin_options INTERFACE ${PROJECT_SOURCE_DIR})

if(KINGPIN_SANITIZE)
  # Instrumented code confuses GCC's data flow warnings; the plain build is the one that must be free of them.
  target_compile_options(kingpin_options INTERFACE -Wno-error)
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
