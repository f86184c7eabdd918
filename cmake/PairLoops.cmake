# Pair loops of each instruction set: one source file each, compiled for that set whatever the rest is compiled
# for, chosen at run time. (Scheduling interleaves the independent targets of the loop body: 3 % faster.)
string(TOLOWER "${CMAKE_SYSTEM_PROCESSOR}" processor)
# A device compiler does not take vector registers of the host; there the device does the sums.
if(processor MATCHES "x86_64|amd64" AND CMAKE_CXX_COMPILER_ID MATCHES "GNU|Clang" AND NOT Kokkos_DEVICES MATCHES "CUDA|HIP|SYCL")
  set(pair_loop_flags -O3 -ffp-contract=fast $<$<CXX_COMPILER_ID:GNU>:-fschedule-insns;-fsched-pressure>)
  target_sources(asterflow_backends PRIVATE backends/pair_sums_avx2.cpp backends/pair_sums_avx512.cpp)
  set_source_files_properties(backends/pair_sums_avx2.cpp PROPERTIES COMPILE_OPTIONS
    "${pair_loop_flags};-march=x86-64;-mavx2;-mfma")
  set_source_files_properties(backends/pair_sums_avx512.cpp PROPERTIES COMPILE_OPTIONS
    "${pair_loop_flags};-march=x86-64;-mavx512f;-mavx512dq;-mavx512vl;-mfma;-mprefer-vector-width=512")
  target_compile_definitions(asterflow_backends PRIVATE ASTERFLOW_HAS_X86_SIMD)
endif()
