# Warnings and optimisation for our own targets only.
# (Off for g++: 12 reports its own AVX-512 header, through Eigen, and its own strings.)
add_library(asterflow_options INTERFACE)
target_compile_options(asterflow_options INTERFACE
  $<$<COMPILE_LANG_AND_ID:CXX,GNU,Clang>:-Wall -Wextra -Wpedantic -Wno-unknown-pragmas>
  $<$<COMPILE_LANG_AND_ID:CXX,GNU>:-Wno-maybe-uninitialized -Wno-array-bounds -Wno-stringop-overread>
  $<$<AND:$<BOOL:${ASTERFLOW_WARNINGS_AS_ERRORS}>,$<COMPILE_LANG_AND_ID:CXX,GNU,Clang>>:-Werror>)

# Instruction set of the physics code. Pair sums choose theirs at run time and do not depend on this.
if(ASTERFLOW_NATIVE)
  target_compile_options(asterflow_options INTERFACE $<$<COMPILE_LANG_AND_ID:CXX,GNU,Clang>:-march=native>)
endif()

if(ASTERFLOW_SANITIZE)
  set(ASTERFLOW_SANITIZERS -fsanitize=address,undefined -fno-sanitize-recover=undefined -fno-omit-frame-pointer)
  target_compile_options(asterflow_options INTERFACE ${ASTERFLOW_SANITIZERS})
  target_link_options(asterflow_options INTERFACE ${ASTERFLOW_SANITIZERS})
endif()
