// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// VTK XML PolyData: points, polygons, triangle strips and one-component point data.
#include "io/attribute_types.hpp"
#include "io/cursors.hpp"
#include "io/formats.hpp"
#include "io/vtp_arrays.hpp"

#include <fmt/core.h>

#include <cstdint>

namespace rhizodont {
namespace {

struct Document {
  pugi::xml_document xml;
  VtkStorage storage;
};

// Raw appended bytes are not XML: they are cut out before the text is parsed.
std::string without_appended_data(std::string_view bytes, std::string_view& appended) {
  const std::size_t tag = bytes.find("<AppendedData");
  if (tag == std::string_view::npos) return std::string(bytes);
  const std::size_t open = bytes.find('>', tag);
  const std::size_t start = open == std::string_view::npos ? open : bytes.find('_', open);
  if (start == std::string_view::npos) throw InputError("the file is cut off: its appended data are missing");
  const std::size_t end = bytes.rfind("</AppendedData");
  if (end == std::string_view::npos || end <= start)
    throw InputError("the file is cut off: its appended data do not end");
  appended = bytes.substr(start + 1, end - start - 1);
  return std::string(bytes.substr(0, start)).append(bytes.substr(end));
}

void open_document(std::string_view bytes, Document& document) {
  const std::string text = without_appended_data(bytes, document.storage.appended);
  const pugi::xml_parse_result parsed = document.xml.load_buffer(text.data(), text.size());
  if (!parsed) {
    const auto line =
        1 + std::count(text.begin(),
                       text.begin() + std::min<std::ptrdiff_t>(parsed.offset, static_cast<std::ptrdiff_t>(text.size())),
                       '\n');
    throw InputError(fmt::format("line {}: the file is no proper XML ({})", line, parsed.description()), {line});
  }
  const pugi::xml_node root = document.xml.child("VTKFile");
  if (std::string_view(root.attribute("type").as_string()) != "PolyData")
    throw InputError("this is no VTK file with surface data (PolyData)");
  const std::string_view compressor = root.attribute("compressor").as_string();
  if (!compressor.empty() && compressor != "vtkZLibDataCompressor")
    throw InputError(
        fmt::format("the file is compressed with '{:.40}', which is not read; save it with zlib or without compression",
                    compressor));
  VtkStorage& storage = document.storage;
  storage.compressed = !compressor.empty();
  storage.wide_header = std::string_view(root.attribute("header_type").as_string()) == "UInt64";
  storage.byte_order = std::string_view(root.attribute("byte_order").as_string()) == "BigEndian" ? std::endian::big
                                                                                                 : std::endian::little;
  storage.appended_raw = std::string_view(root.child("AppendedData").attribute("encoding").as_string()) == "raw";
}

class PieceReader {
 public:
  PieceReader(const VtkStorage& storage, MeshFile& file) : storage_(storage), file_(file) {}

  void read(const pugi::xml_node& piece, bool with_attributes) {
    const std::size_t first = file_.mesh.vertices.size();
    read_points(piece);
    added_ = file_.mesh.vertices.size() - first;
    first_ = static_cast<std::int64_t>(first);
    read_cells(piece.child("Polys"), false);
    read_cells(piece.child("Strips"), true);
    if (with_attributes) read_attributes(piece.child("PointData"));
  }

 private:
  void read_points(const pugi::xml_node& piece) {
    const VtkArray points = read_vtk_array(piece.child("Points").child("DataArray"), storage_);
    const std::uint64_t announced = piece.attribute("NumberOfPoints").as_ullong();
    if (points.components != 3 || points.values.size() % 3 != 0)
      throw InputError("the file's points have no three coordinates");
    if (points.values.size() / 3 != announced)
      throw InputError(fmt::format("the file announces {} points and holds {}", announced, points.values.size() / 3));
    for (std::size_t k = 0; k < points.values.size(); k += 3)
      file_.mesh.vertices.emplace_back(points.values[k], points.values[k + 1], points.values[k + 2]);
  }

  std::vector<double> named_array(const pugi::xml_node& cells, const char* name) const {
    const pugi::xml_node node = cells.find_child_by_attribute("DataArray", "Name", name);
    return node ? read_vtk_array(node, storage_).values : std::vector<double>{};
  }

  void read_cells(const pugi::xml_node& cells, bool strips) {
    const std::vector<double> connectivity = named_array(cells, "connectivity"),
                              offsets = named_array(cells, "offsets");
    std::size_t begin = 0;
    std::vector<std::int32_t> corners;
    for (std::size_t cell = 0; cell < offsets.size(); ++cell) {
      const double end = offsets[cell];
      if (!(end >= static_cast<double>(begin)) || end > static_cast<double>(connectivity.size()))
        throw InputError(fmt::format("polygon {} (counted from 0) lies outside the file's list of corners", cell),
                         {static_cast<std::int64_t>(cell)});
      corners.clear();
      for (; begin < static_cast<std::size_t>(end); ++begin) {
        const double v = connectivity[begin];
        if (!(v >= 0 && v < static_cast<double>(added_)))
          throw InputError(
              fmt::format("polygon {} (counted from 0) refers to vertex {}, which does not exist", cell, v),
              {static_cast<std::int64_t>(cell)});
        corners.push_back(to_index(first_ + static_cast<std::int64_t>(v)));
      }
      strips ? append_strip(corners) : append_fan(file_.mesh.triangles, corners);
    }
  }

  // Every second triangle of a strip is turned around.
  void append_strip(const std::vector<std::int32_t>& corners) {
    for (std::size_t k = 2; k < corners.size(); ++k) {
      const std::size_t odd = k % 2;
      file_.mesh.triangles.push_back({corners[k - 2 + odd], corners[k - 1 - odd], corners[k]});
    }
  }

  void read_attributes(const pugi::xml_node& data) {
    for (const pugi::xml_node& node : data.children("DataArray")) {
      const std::string name = node.attribute("Name").as_string();
      const std::string_view type = node.attribute("type").as_string();
      if (name.empty() || node.attribute("NumberOfComponents").as_int(1) != 1 || type == "String") continue;
      VtkArray array = read_vtk_array(node, storage_);
      if (array.values.size() != added_)
        throw InputError(fmt::format("the array '{}' has {} values for {} points", name, array.values.size(), added_));
      file_.vertex_attributes[name] = {array.type, std::move(array.values)};
    }
  }

  const VtkStorage& storage_;
  MeshFile& file_;
  std::size_t added_ = 0;
  std::int64_t first_ = 0;
};

}  // namespace

MeshFile read_vtp(std::string_view bytes) {
  Document document;
  open_document(bytes, document);
  const auto pieces = document.xml.child("VTKFile").child("PolyData").children("Piece");
  const bool one_piece = std::distance(pieces.begin(), pieces.end()) == 1;
  MeshFile file;
  PieceReader reader(document.storage, file);
  for (const pugi::xml_node& piece : pieces)
    if (piece.attribute("NumberOfPoints").as_ullong() > 0) reader.read(piece, one_piece);
  return file;
}

}  // namespace rhizodont
