#pragma once
// Counter-based random numbers: a value is a pure function of (seed, object, event, draw), so the
// history of a fiber does not depend on the time step, the number of threads or a restart.
// Mixing function: SplitMix64 finaliser [Steele, Lea & Flood 2014], applied once per key word.

#include <cmath>
#include <cstdint>

namespace asterflow {

inline std::uint64_t mix_bits(std::uint64_t z) {
  z += 0x9e3779b97f4a7c15ull;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
  return z ^ (z >> 31);
}

// Uniform in the open interval (0, 1).
inline double uniform_random(std::uint64_t seed, std::uint64_t object, std::uint64_t event, std::uint64_t draw) {
  std::uint64_t h = mix_bits(seed);
  h = mix_bits(h ^ object);
  h = mix_bits(h ^ event);
  h = mix_bits(h ^ draw);
  return (static_cast<double>(h >> 11) + 0.5) * 0x1.0p-53;
}

// Exponential with mean 1: the integrated hazard at which the event happens.
inline double exponential_random(std::uint64_t seed, std::uint64_t object, std::uint64_t event, std::uint64_t draw) {
  return -std::log(uniform_random(seed, object, event, draw));
}

}  // namespace asterflow
