#pragma once
// CPU time: unlike wall time it does not count what other programs take. Threads that wait by spinning do count.

#include <ctime>

namespace asterflow {

inline double seconds_of(clockid_t clock) {
  timespec t{};
  clock_gettime(clock, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

// All threads of this process together, and the calling thread alone. What other threads that are running have done since the last
// tick of the system (1 to 10 ms) is missing: the least of many differences is too small by that.
inline double cpu_seconds() { return seconds_of(CLOCK_PROCESS_CPUTIME_ID); }
inline double thread_cpu_seconds() { return seconds_of(CLOCK_THREAD_CPUTIME_ID); }

}  // namespace asterflow
