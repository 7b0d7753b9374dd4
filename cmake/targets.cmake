# kingpin_library(NAME LINKS...): a static library of every .cpp below this folder,
# apart from those named *_kernel.cpp, which kingpin_isa_kernels() compiles once per instruction set.
function(kingpin_library name)
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS *.cpp)
  list(FILTER sources EXCLUDE REGEX "_kernel\\.cpp$")
  add_library(${name} STATIC ${sources})
  target_link_libraries(${name} PUBLIC kingpin_options ${ARGN})
  target_precompile_headers(${name} PRIVATE ${PROJECT_SOURCE_DIR}/cmake/precompiled.h)
endfunction()

# kingpin_isa_kernels(TARGET SOURCES...): compiles each source for the portable, the AVX2 and the AVX-512
# instruction set and adds the objects to TARGET. KINGPIN_ISA names the tag type in core/math/isa.h.
# The run-time choice is made in core/math/isa.cpp.
function(kingpin_isa_kernels target)
  set(flags_Portable -march=x86-64)
  set(flags_Avx2 -march=x86-64-v3)
  set(flags_Avx512 -march=x86-64-v4 -mprefer-vector-width=512)
  foreach(isa Portable Avx2 Avx512)
    set(object ${target}_${isa})
    add_library(${object} OBJECT ${ARGN})
    target_link_libraries(${object} PRIVATE kingpin_options)
    target_compile_definitions(${object} PRIVATE KINGPIN_ISA=${isa})
    # Contraction to fused multiply-add is wanted here; it is off by default in ISO mode.
    target_compile_options(${object} PRIVATE
      # GCC 12 takes the undefined source of its own masked AVX-512 intrinsics for an uninitialised variable (PR 105593).
      -Wno-maybe-uninitialized -Wno-uninitialized
      # Neither traps nor the sign of a zero matter; NaN does (it is how a diverging lane is found).
      ${flags_${isa}} -O3 -ffp-contract=fast -fno-math-errno -fno-trapping-math -fno-signed-zeros)
    if(KINGPIN_SANITIZE AND CMAKE_CXX_COMPILER_ID STREQUAL GNU)
      # GCC 12 needs many minutes for checks of every pack on the stack of these large inlined functions. What the
      # kernels get from outside (heap, bounds, arithmetic) stays checked; the same templates on double are checked in full.
      target_compile_options(${object} PRIVATE -O1 -g1 -fno-sanitize=null,alignment,object-size)
      if(KINGPIN_SANITIZE MATCHES address)
        target_compile_options(${object} PRIVATE
          -fno-sanitize-address-use-after-scope "SHELL:--param asan-stack=0")
      endif()
    endif()
    target_sources(${target} PRIVATE $<TARGET_OBJECTS:${object}>)
  endforeach()
endfunction()

# kingpin_test(NAME LINKS...): one test program of every *_test.cpp below this folder.
function(kingpin_test name)
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS *_test.cpp)
  if(NOT sources)
    return()
  endif()
  add_executable(${name} ${sources})
  target_link_libraries(${name} PRIVATE ${ARGN} GTest::gmock GTest::gtest_main)
  target_compile_definitions(${name} PRIVATE
    KINGPIN_SOURCE_DIR="${PROJECT_SOURCE_DIR}" KINGPIN_BINARY_DIR="${CMAKE_BINARY_DIR}")
  target_precompile_headers(${name} PRIVATE ${PROJECT_SOURCE_DIR}/cmake/precompiled_test.h)
  gtest_discover_tests(${name} DISCOVERY_TIMEOUT 60 NO_PRETTY_VALUES PROPERTIES TIMEOUT 900)
endfunction()
