#include "io/vtk_file.hpp"

#include "base/error.hpp"

#include <bit>
#include <fmt/format.h>
#include <fstream>

namespace asterflow {

namespace {

static_assert(std::endian::native == std::endian::little, "the byte order that the files declare");

// One VTK file: XML that refers to blocks of raw bytes, which follow it.
class VtkFile {
 public:
  VtkFile(std::filesystem::path path, std::string type) : path_(std::move(path)), type_(std::move(type)) {}

  void add(std::string const& xml) { xml_ += xml; }

  template <class T>
  void add_array(std::string const& name, std::vector<T> const& values, std::size_t n_component) {
    char const* const type = std::is_same_v<T, double> ? "Float64" : "Int64";
    xml_ += fmt::format("<DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\" format=\"appended\" offset=\"{}\"/>\n",
                        type, name, n_component, bytes_.size());
    std::uint64_t const size = values.size() * sizeof(T);
    bytes_.append(reinterpret_cast<char const*>(&size), sizeof(size));
    bytes_.append(reinterpret_cast<char const*>(values.data()), size);
  }

  void add_points(ConstPoints points) {
    xml_ += "<Points>\n";
    add_array("points", std::get<std::vector<double>>(NamedArray::of("", points, "").values), 3);
    xml_ += "</Points>\n";
  }

  void add_point_arrays(std::vector<NamedArray> const& arrays) {
    xml_ += "<PointData>\n";
    for (auto const& array : arrays) {
      std::string const name = array.unit.empty() ? array.name : fmt::format("{} ({})", array.name, array.unit);
      std::size_t const n_component = array.shape.size() == 2 ? array.shape[1] : 1;
      std::visit([&](auto const& values) { add_array(name, values, n_component); }, array.values);
    }
    xml_ += "</PointData>\n";
  }

  void write() const {
    std::ofstream file(path_, std::ios::binary);
    file << "<?xml version=\"1.0\"?>\n<VTKFile type=\"" << type_
         << "\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n"
         << xml_ << "<AppendedData encoding=\"raw\">\n_" << bytes_ << "\n</AppendedData>\n</VTKFile>\n";
    file.close();
    if (!file) throw SceneError(path_.string() + ": cannot be written; is the disk full or the folder protected?");
  }

 private:
  std::filesystem::path path_;
  std::string type_, xml_, bytes_;
};

// Cells of varying size as VTK wants them: all point indices in one list, and where each cell ends.
template <class Cells>
void add_cells(VtkFile& file, std::string const& kind, Cells const& cells) {
  std::vector<std::int64_t> connectivity, offsets;
  for (auto const& cell : cells) {
    connectivity.insert(connectivity.end(), cell.begin(), cell.end());
    offsets.push_back(static_cast<std::int64_t>(connectivity.size()));
  }
  file.add("<" + kind + ">\n");
  file.add_array("connectivity", connectivity, 1);
  file.add_array("offsets", offsets, 1);
  file.add("</" + kind + ">\n");
}

}  // namespace

void write_vtp(std::filesystem::path const& path, PolyMesh const& mesh) {
  VtkFile file(path, "PolyData");
  file.add(fmt::format("<PolyData>\n<Piece NumberOfPoints=\"{}\" NumberOfVerts=\"0\" NumberOfLines=\"{}\" "
                       "NumberOfStrips=\"0\" NumberOfPolys=\"{}\">\n",
                       mesh.points.size(), mesh.lines.size(), mesh.triangles.size()));
  file.add_point_arrays(mesh.point_arrays);
  file.add_points(mesh.points);
  add_cells(file, "Lines", mesh.lines);
  add_cells(file, "Polys", mesh.triangles);
  file.add("</Piece>\n</PolyData>\n");
  file.write();
}

void write_vts(std::filesystem::path const& path, PlaneGrid const& grid) {
  std::string const extent = fmt::format("0 {} 0 {} 0 0", grid.n_first - 1, grid.n_second - 1);
  VtkFile file(path, "StructuredGrid");
  file.add(fmt::format("<StructuredGrid WholeExtent=\"{0}\">\n<Piece Extent=\"{0}\">\n", extent));
  file.add_point_arrays(grid.point_arrays);
  file.add_points(grid.points);
  file.add("</Piece>\n</StructuredGrid>\n");
  file.write();
}

void write_pvd(std::filesystem::path const& path, std::vector<TimedPart> const& parts) {
  std::ofstream file(path);
  file << "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\" byte_order=\"LittleEndian\">\n"
       << "<Collection>\n";
  for (auto const& part : parts)
    file << fmt::format("<DataSet timestep=\"{:.12g}\" part=\"0\" name=\"{}\" file=\"{}\"/>\n", part.time, part.part,
                        part.file);
  file << "</Collection>\n</VTKFile>\n";
  file.close();
  if (!file) throw SceneError(path.string() + ": cannot be written; is the disk full or the folder protected?");
}

}  // namespace asterflow
