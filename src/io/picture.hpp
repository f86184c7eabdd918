#pragma once
// Pictures drawn by the Python scripts that come with the program. A picture is a convenience: without Python the
// numbers are there all the same, and one line says what is missing.

#include <filesystem>
#include <string>
#include <vector>

namespace asterflow {

// Runs `script` (a file name such as "plot_flow.py") with the arguments; the Python is that of the environment variable
// ASTERFLOW_PYTHON, else the first of python3 and /usr/bin/python3 that has numpy, h5py and matplotlib.
// Returns true when the script has succeeded; otherwise says on stderr in one line why there is no picture.
bool draw_picture(std::string const& script, std::vector<std::string> const& arguments);

}  // namespace asterflow
