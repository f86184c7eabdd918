# Inner loops of each instruction set: one source file each, compiled for that set whatever the rest is compiled
# for, chosen at run time. They see no header of Kokkos (backends/host_only), so the host's compiler takes them also in
# a build for a device, whose compiler knows no vector registers of the host.
# (Scheduling interleaves the independent targets of a pair loop: 3 % faster. Vectors made of the few scalars around vector
# operations, and additions to a zero that might be negative, made near fields up to 15 % slower.)
string(TOLOWER "${CMAKE_SYSTEM_PROCESSOR}" processor)
set(loop_flags -O3 -ffp-contract=fast)
if(CMAKE_CXX_COMPILER MATCHES "nvcc_wrapper")
  list(APPEND loop_flags --host-only)
endif()
if(ASTERFLOW_SANITIZE)
  list(APPEND loop_flags -fno-sanitize=undefined)  # a check around each operation on vectors: minutes a file
endif()
add_library(asterflow_loops OBJECT backends/fast_loops_portable.cpp)
target_include_directories(asterflow_loops PRIVATE ${PROJECT_SOURCE_DIR}/backends/host_only ${PROJECT_SOURCE_DIR}
  ${PROJECT_SOURCE_DIR}/src)
target_compile_features(asterflow_loops PRIVATE cxx_std_20)
target_link_libraries(asterflow_loops PRIVATE asterflow_options)
set_target_properties(asterflow_loops PROPERTIES POSITION_INDEPENDENT_CODE "${BUILD_SHARED_LIBS}")
target_sources(asterflow_backends PRIVATE $<TARGET_OBJECTS:asterflow_loops>)

set(portable_flags ${loop_flags})
if(processor MATCHES "x86_64|amd64" AND CMAKE_CXX_COMPILER_ID MATCHES "GNU|Clang")
  list(APPEND portable_flags -march=x86-64)
  set(avx2_flags -march=x86-64 -mavx2 -mfma)
  set(avx512_flags -march=x86-64 -mavx512f -mavx512dq -mavx512vl -mfma -mprefer-vector-width=512)
  set(pair_loop_flags ${loop_flags} $<$<CXX_COMPILER_ID:GNU>:-fschedule-insns;-fsched-pressure>)
  set(fast_loop_flags ${pair_loop_flags} -fno-signed-zeros $<$<CXX_COMPILER_ID:GNU>:-fno-tree-slp-vectorize>)
  foreach(set avx2 avx512)
    target_sources(asterflow_loops PRIVATE backends/pair_sums_${set}.cpp backends/fast_loops_${set}.cpp)
    set_source_files_properties(backends/pair_sums_${set}.cpp PROPERTIES COMPILE_OPTIONS "${pair_loop_flags};${${set}_flags}")
    set_source_files_properties(backends/fast_loops_${set}.cpp PROPERTIES COMPILE_OPTIONS "${fast_loop_flags};${${set}_flags}")
  endforeach()
  target_compile_definitions(asterflow_backends PRIVATE ASTERFLOW_HAS_X86_SIMD)
endif()
set_source_files_properties(backends/fast_loops_portable.cpp PROPERTIES COMPILE_OPTIONS "${portable_flags}")
