// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/write_labels.hpp"

#include "rhizodont/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <iterator>
#include <map>

namespace rhizodont {
namespace {

/// Quadrants 1, 2, 5 and 6 are upper; nothing for what is no quadrant.
std::optional<Jaw> jaw_of_quadrant(int quadrant) {
  if (quadrant < 1 || quadrant > 8) return std::nullopt;
  return (quadrant - 1) % 4 < 2 ? Jaw::upper : Jaw::lower;
}

void require_count(std::size_t labels, std::size_t elements, const char* what) {
  if (labels != elements) throw UsageError(fmt::format("{} labels are given for {} {}", labels, elements, what));
}

/// Per file vertex its label.
std::vector<int> in_file_order(const std::vector<int>& labels, const MeshFile& scan) {
  if (scan.mesh_vertices.empty()) return labels;
  std::vector<int> result;
  result.reserve(scan.mesh_vertices.size());
  for (const int v : scan.mesh_vertices) result.push_back(labels[static_cast<std::size_t>(v)]);
  return result;
}

template <class T>
void append_big_endian(std::string& bytes, T value) {
  auto raw = std::bit_cast<std::array<char, sizeof(T)>>(value);
  std::reverse(raw.begin(), raw.end());
  bytes.append(raw.data(), raw.size());
}

/// The numbers of a legacy VTK file, as text or as bytes.
class VtkBody {
 public:
  explicit VtkBody(VtkEncoding encoding) : encoding_(encoding) {}

  void line(const std::string& text) { text_ += text + "\n"; }

  template <class T>
  void numbers(const T* begin, std::size_t count) {
    for (std::size_t k = 0; k < count; ++k) {
      if (encoding_ == VtkEncoding::binary)
        append_big_endian(text_, begin[k]);
      else
        fmt::format_to(std::back_inserter(text_), "{}{}", k == 0 ? "" : " ", begin[k]);
    }
    if (encoding_ == VtkEncoding::ascii) text_ += '\n';
  }

  /// Bytes need a line end after them, before the next keyword.
  void end_numbers() {
    if (encoding_ == VtkEncoding::binary) text_ += '\n';
  }

  std::string take() { return std::move(text_); }

 private:
  VtkEncoding encoding_;
  std::string text_;
};

template <class T>
void add_points(VtkBody& body, const std::vector<Point>& points) {
  for (const Point& p : points) {
    const std::array<T, 3> numbers{static_cast<T>(p.x()), static_cast<T>(p.y()), static_cast<T>(p.z())};
    body.numbers(numbers.data(), numbers.size());
  }
  body.end_numbers();
}

}  // namespace

std::string teeth3ds_json(const std::vector<int>& fdi, std::optional<Jaw> jaw, const MeshFile& scan) {
  require_count(fdi.size(), scan.mesh.vertices.size(), "vertices");
  std::map<int, int> instances{{0, 0}};
  for (const int number : fdi) {
    const auto of_tooth = jaw_of_quadrant(number / 10);
    if (number != 0 && !of_tooth) throw UsageError(fmt::format("{} is no FDI number", number));
    if (number != 0 && jaw && *of_tooth != *jaw)
      throw UsageError(fmt::format(
          "a label file states one jaw, and tooth {} is not of the {} one; of both jaws together state none", number,
          jaw_name(*jaw)));
    instances.emplace(number, 0);
  }
  int next = 0;
  for (auto& [number, instance] : instances) instance = next++;
  const std::vector<int> labels = in_file_order(fdi, scan);
  std::string text = "{\"id_patient\": \"\", ";
  if (jaw) text += fmt::format("\"jaw\": \"{}\", ", jaw_name(*jaw));
  const auto add = [&](const char* name, const auto& value_of) {
    text += fmt::format("\"{}\": [", name);
    for (std::size_t v = 0; v < labels.size(); ++v)
      fmt::format_to(std::back_inserter(text), "{}{}", v == 0 ? "" : ", ", value_of(labels[v]));
    text += "]";
  };
  add("labels", [](int number) { return number; });
  text += ", ";
  add("instances", [&](int number) { return instances.at(number); });
  return text + "}\n";
}

std::string vtp_with_cell_labels(const TriangleMesh& mesh, const std::vector<int>& per_triangle,
                                 const std::string& array) {
  require_count(per_triangle.size(), mesh.triangles.size(), "triangles");
  const char* real = coordinates_fit_float(mesh) ? "Float32" : "Float64";
  std::string text =
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"0.1\" byte_order=\"LittleEndian\">\n<PolyData>\n";
  const auto out = std::back_inserter(text);
  fmt::format_to(out, "<Piece NumberOfPoints=\"{}\" NumberOfVerts=\"0\" NumberOfLines=\"0\" NumberOfStrips=\"0\" ",
                 mesh.vertices.size());
  fmt::format_to(out, "NumberOfPolys=\"{}\">\n<CellData Scalars=\"{}\">\n", mesh.triangles.size(), array);
  fmt::format_to(out, "<DataArray type=\"Int32\" Name=\"{}\" format=\"ascii\">\n", array);
  for (const int number : per_triangle) fmt::format_to(out, "{}\n", number);
  fmt::format_to(out, "</DataArray>\n</CellData>\n<Points>\n<DataArray type=\"{}\" Name=\"Points\" ", real);
  text += "NumberOfComponents=\"3\" format=\"ascii\">\n";
  for (const Point& p : mesh.vertices) fmt::format_to(out, "{} {} {}\n", p.x(), p.y(), p.z());
  text += "</DataArray>\n</Points>\n<Polys>\n<DataArray type=\"Int32\" Name=\"connectivity\" format=\"ascii\">\n";
  for (const auto& [a, b, c] : mesh.triangles) fmt::format_to(out, "{} {} {}\n", a, b, c);
  text += "</DataArray>\n<DataArray type=\"Int32\" Name=\"offsets\" format=\"ascii\">\n";
  for (std::size_t t = 1; t <= mesh.triangles.size(); ++t) fmt::format_to(out, "{}\n", 3 * t);
  return text + "</DataArray>\n</Polys>\n</Piece>\n</PolyData>\n</VTKFile>\n";
}

std::string vtk_with_point_labels(const TriangleMesh& mesh, const std::vector<int>& per_vertex, VtkEncoding encoding,
                                  const std::string& array) {
  require_count(per_vertex.size(), mesh.vertices.size(), "vertices");
  const bool is_float = coordinates_fit_float(mesh);
  VtkBody body(encoding);
  body.line("# vtk DataFile Version 4.2");
  body.line("scan with numbered teeth");
  body.line(encoding == VtkEncoding::binary ? "BINARY" : "ASCII");
  body.line("DATASET POLYDATA");
  body.line(fmt::format("POINTS {} {}", mesh.vertices.size(), is_float ? "float" : "double"));
  is_float ? add_points<float>(body, mesh.vertices) : add_points<double>(body, mesh.vertices);
  body.line(fmt::format("POLYGONS {} {}", mesh.triangles.size(), 4 * mesh.triangles.size()));
  for (const auto& [a, b, c] : mesh.triangles) {
    const std::array<std::int32_t, 4> cell{3, a, b, c};
    body.numbers(cell.data(), cell.size());
  }
  body.end_numbers();
  body.line(fmt::format("POINT_DATA {}", mesh.vertices.size()));
  body.line(fmt::format("SCALARS {} int 1", array));
  body.line("LOOKUP_TABLE default");
  body.numbers(per_vertex.data(), per_vertex.size());
  body.end_numbers();
  return body.take();
}

}  // namespace rhizodont
