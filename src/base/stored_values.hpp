#pragma once
// Arrays of a stored state by name.

#include "base/error.hpp"
#include "base/named_array.hpp"

#include <span>

namespace asterflow {

// Throws SceneError when there is no such array of that many numbers.
template <class Value = double>
std::vector<Value> const& stored_values(std::span<NamedArray const> state, std::string const& name, std::size_t size) {
  for (NamedArray const& array : state)
    if (array.name == name)
      if (auto const* values = std::get_if<std::vector<Value>>(&array.values); values && values->size() == size)
        return *values;
  throw SceneError("the stored state has no array " + name + " of the scene's size");
}

}  // namespace asterflow
