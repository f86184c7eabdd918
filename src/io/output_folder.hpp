#pragma once
// The folder that a command writes into.

#include <filesystem>

namespace asterflow {

// Makes it where it is not yet. Throws SceneError, with the reason, where nothing can be written into it.
void make_output_folder(std::filesystem::path const& folder);

}  // namespace asterflow
